// The report's data, which the packer wrote as JSON, and the reader's choice of it: the run and those
// beside it, the kind of error, the ordinate, and the methods that are drawn strongly.
import { byId } from "./element.js";
import { isKnown, words } from "./words.js";

export const report = JSON.parse(byId("report").textContent);
export const points = report.points;
/** Whether the page is of a study, with a chart and answers, and not of motions alone. */
export const isStudy = report.answers !== null;
export const methods = report.methods;

/** All runs, as places in the columns of `points`. */
export const allRuns = [...points.method.keys()];

/** The runs of each method, from the largest knob to the least. */
export const runsOf = methods.map((_, method) =>
  allRuns
    .filter((point) => points.method[point] === method)
    .sort((a, b) => points.value[b] - points.value[a]),
);

/** The families that have methods, as {title, members}. */
export const familiesWithMethods = report.families
  .map(({ title }, family) => ({
    title,
    members: [...methods.keys()].filter((method) => methods[method].family === family),
  }))
  .filter(({ members }) => members.length);

// The kind of error in a column.
const quantityOf = (column) => report.quantities.find((one) => one.column === column);

/** Whether a run is a mark among the errors of a quantity over an ordinate. */
export const isDrawn = (point, column, ordinate) =>
  quantityOf(column)?.failures[point] === null && points[ordinate]?.[point] > 0;

/** Why a run is no such mark, in words; null where its error or cost was not measured. */
export function whyNot(point, column) {
  if (points.outcome[point] !== "reached_end") return words.plain(points.outcome[point]);
  if (points.cause[point]) return points.cause[point];
  return isKnown(points[column]?.[point]) ? quantityOf(column).failures[point] : null;
}

/** The knob of a run with its value: "h = 0.0005 s". */
export const knobOf = (point) => points.knob_words[point];

const motions = report.motion?.runs ?? [];
// The page tells of energies only what does not follow from the rest.
for (const { energy, times } of motions.filter((run) => run.energy)) {
  energy.t ??= times;
  energy.potential = energy.total.map((total, at) =>
    total === null || energy.kinetic[at] === null ? null : total - energy.kinetic[at],
  );
  // An exact motion keeps the total, with what damping has taken and broken springs held, and less
  // what driving has given.
  energy.kept = energy.total.map((total, at) => {
    const taken = energy.dissipated ? energy.dissipated[at] : 0;
    const given = energy.driven ? energy.driven[at] : 0;
    const held = energy.released ? energy.released[at] : 0;
    return [total, taken, given, held].includes(null) ? null : total + taken - given + held;
  });
}

/** The motions that were kept of runs, the most telling first. */
export const keptRuns = motions.filter((run) => run.role === "run" && run.point !== null);

/** The kept motion of a point, or null: where the point stands for the reference too, the one
    that was compared with it. */
export function keptMotion(point) {
  const kept = motions.filter((run) => run.point === point);
  return kept.find((run) => run.role === "run") ?? kept[0] ?? null;
}

/** The counts of a run that are not zero, as pairs of words. */
export const countsOf = (point) =>
  report.counts
    .filter((column) => points[column]?.[point] > 0)
    .map((column) => [words.plain(column), words.count(points[column][point])]);

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
  const answers = (report.answers ?? []).map(({ point }) => point).filter((point) => point !== null);
  const kept = keptRuns.map(({ point }) => point);
  const known = answers.find((point) => kept.includes(point));
  return known ?? kept[0] ?? answers[0] ?? allRuns[0] ?? null;
}

// The run that an address names as METHOD@VALUE; undefined for another text.
function runNamed(text) {
  const [, name, value] = /^(.*)@(.*)$/s.exec(text) ?? [];
  const method = methods.findIndex((one) => one.name === name);
  return runsOf[method]?.find((point) => String(points.value[point]) === value);
}

const nameOf = (point) => `${methods[points.method[point]].name}@${points.value[point]}`;

function addressed(hash) {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const found = {};
  const run = runNamed(given.get("run") ?? "");
  if (run !== undefined) found.run = run;
  if (run !== undefined) {
    const others = given.getAll("with").map(runNamed);
    found.compared = others.filter((point) => point !== undefined);
    found.together = given.get("views") === "one";
  }
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
  // Few motions are best seen together.
  compared: isStudy ? [] : keptRuns.slice(1, 5).map(({ point }) => point),
  together: !isStudy,
  ...addressed(location.hash),
};

/** The choice now; `compared`: the runs beside the chosen one; `together`: whether their motions are
    in one view; `shown`: the methods that are drawn strongly. */
export const state = {
  ...opening,
  shown: new Set([...methods.keys()].filter((method) => methods[method].strong)),
};

/** The kind of error that the chart stands over. */
export const chosenQuantity = () => quantityOf(state.column);

// A browser may refuse a page on disk to change its address; the choice stands all the same.
function write(how) {
  const address = new URLSearchParams();
  if (state.run !== null) address.set("run", nameOf(state.run));
  address.set("error", state.column);
  address.set("against", state.ordinate);
  for (const point of state.compared) address.append("with", nameOf(point));
  if (state.together) address.set("views", "one");
  try {
    history[how](null, "", `#${address}`);
  } catch {
    return;
  }
}

// Whether a part of the choice stays what it is.
const isSame = (a, b) => (Array.isArray(a) ? String(a) === String(b) : a === b);

function change(changes, how) {
  const changed = Object.keys(changes).filter((key) => !isSame(state[key], changes[key]));
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
