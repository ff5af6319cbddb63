// The reader's choice: the run, the kind of error, the ordinate, the methods drawn strongly. The
// first three are in the address after "#", so that a link leads to a run, and "back" to the run
// before. Other text there is ignored.
import { allRuns, isDrawn, keptRuns, methods, points, report, runsOf } from "./report.js";

const listeners = [];

/** The time, and the counts that a run of the chart has. */
export const ordinates = [
  "time_s",
  ...report.counts.filter((count) =>
    report.quantities.some(({ column }) => allRuns.some((point) => isDrawn(point, column, count))),
  ),
];

// The first answer whose motion was kept; else the first run with a motion, the first answer, any.
function openingRun() {
  const answers = report.answers.map(({ point }) => point).filter((point) => point !== null);
  const kept = keptRuns.map(({ point }) => point);
  return (
    [answers.find((point) => kept.includes(point)), kept[0], answers[0], allRuns[0]].find(
      (point) => point !== undefined,
    ) ?? null
  );
}

function addressed(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const found = {};
  const [, name, value] = /^(.*)@(.*)$/s.exec(given.get("run") ?? "") ?? [];
  const method = methods.findIndex((one) => one.name === name);
  const run = runsOf[method]?.find((point) => String(points.value[point]) === value);
  if (run !== undefined) found.run = run;
  if (report.quantities.some(({ column }) => column === given.get("error")))
    found.column = given.get("error");
  if (ordinates.includes(given.get("against"))) found.ordinate = given.get("against");
  return found;
}

// The first quantity is the one that answers are judged by.
const opening = {
  run: openingRun(),
  column: report.quantities[0].column,
  ordinate: "time_s",
  ...addressed(location.hash),
};

/** The choice now; `shown`: the methods that are drawn strongly. */
export const state = {
  ...opening,
  shown: new Set([...methods.keys()].filter((method) => methods[method].strong)),
};

/** The kind of error that the chart stands over. */
export const chosenQuantity = () => report.quantities.find(({ column }) => column === state.column);

// A browser may refuse a page on disk to change its address; the choice stands all the same.
function write(how) {
  const address = new URLSearchParams();
  if (state.run !== null)
    address.set("run", `${methods[points.method[state.run]].name}@${points.value[state.run]}`);
  address.set("error", state.column);
  address.set("against", state.ordinate);
  try {
    history[how](null, "", `#${address}`);
  } catch {
    return;
  }
}

function change(changes, how) {
  const changed = Object.keys(changes).filter((key) => state[key] !== changes[key]);
  if (!changed.length) return;
  Object.assign(state, changes);
  write(how);
  for (const listener of listeners) listener(changed);
}

/** Tells a function the names of what changed, at each change. */
export const onChoice = (listener) => listeners.push(listener);

/** Changes some of the choices and tells all who listen what changed. */
export const choose = (changes) => change(changes, "replaceState");

/** The same as a step that the browser's way back undoes. */
export const visit = (changes) => change(changes, "pushState");

addEventListener("popstate", () => {
  choose(location.hash ? addressed(location.hash) : opening);
  // A link within the page, such as "#answers", leaves the choice in the address.
  if (location.hash && !location.hash.includes("=")) write("replaceState");
});
