// The menus that choose a run, its head, and its figures.
import { byId, commandLine, definitions, element, options } from "./element.js";
import { swatch } from "./marks.js";
import {
  choose,
  chosenQuantity,
  countsOf,
  familiesWithMethods,
  keptMotion,
  knobOf,
  methods,
  points,
  report,
  runsOf,
  state,
  visit,
} from "./report.js";
import { isKnown, words } from "./words.js";

const PHASES = {
  force: "forces",
  stiffness: "stiffness matrices",
  factorization: "factorizations",
  solve: "solves",
};
const TIMES = { time_s: "time of a run, median", time_min_s: "fastest of them", setup_s: "set-up" };

const methodMenu = byId("run-method");
const runMenu = byId("run-knob");

methodMenu.append(
  ...familiesWithMethods.map(({ title: label, members }) =>
    element("optgroup", { label }, options(members.map((one) => [one, methods[one].name]))),
  ),
);
methodMenu.addEventListener("change", () => choose({ run: middleRun(Number(methodMenu.value)) }));
runMenu.addEventListener("change", () => choose({ run: Number(runMenu.value) }));
byId("coarser").addEventListener("click", () => step(-1));
byId("finer").addEventListener("click", () => step(1));

// The middle of a method's runs that gave a point.
function middleRun(method) {
  const good = runsOf[method].filter((point) => !points.cause[point]);
  const runs = good.length ? good : runsOf[method];
  return runs[Math.floor(runs.length / 2)];
}

function step(by) {
  const runs = runsOf[points.method[state.run]];
  const next = runs[runs.indexOf(state.run) + by];
  if (next !== undefined) visit({ run: next });
}

// The menu tells of the error that the chart stands over.
function showChoice() {
  const { axis, column } = chosenQuantity();
  const result = (point) => {
    if (points.cause[point]) return "failed";
    const error = points[column]?.[point];
    return isKnown(error) ? `${axis} ${words.number(error)}` : "error not known";
  };
  const method = points.method[state.run];
  methodMenu.value = method;
  runMenu.replaceChildren(
    ...options(runsOf[method].map((point) => [point, `${knobOf(point)} · ${result(point)}`])),
  );
  runMenu.value = state.run;
}

const fact = (label, value) => element("li", element("b", value), element("span", label));

function facts(point) {
  const growth = points.energy_growth?.[point];
  return [
    ...report.quantities
      .filter(({ column }) => isKnown(points[column]?.[point]))
      .map(({ axis, column }) => fact(axis, words.number(points[column][point]))),
    ...Object.entries(TIMES)
      .filter(([column]) => isKnown(points[column]?.[point]))
      .map(([column, label]) => fact(label, words.seconds(points[column][point]))),
    // The growth of an energy that stays says nothing.
    isKnown(growth) &&
      Math.abs(growth - 1) >= 0.01 &&
      fact("largest energy / energy at the start", words.number(growth)),
  ];
}

function ending(point) {
  const t = points.t_reached[point];
  if (points.outcome[point] === "reached_end") return "No point of the chart";
  const how = words.plain(points.outcome[point]);
  return t === null ? how : `${how} at t = ${words.seconds(t)}`;
}

// The range of a position error, where the reference leaves it open.
function openRange(point) {
  const least = points.error_position_at_least?.[point];
  const most = points.error_position_at_most?.[point];
  if (!isKnown(most) || least >= 0.95 * most) return null;
  const range = `between ${words.number(least)} and ${words.number(most)}`;
  return `Its position error lies ${range}: the reference leaves that open.`;
}

// The error at which a run counts whose own is small by luck.
function luck(point) {
  const { lucky } = chosenQuantity();
  if (!(point in lucky)) return null;
  const counts = lucky[point] === null ? "not at all" : `at ${words.number(lucky[point])}`;
  return `Its error is small by luck, as a finer run shows: it counts ${counts}.`;
}

function head(point) {
  const { name, line } = methods[points.method[point]];
  const warnings = (report.answers ?? []).filter((answer) => answer.point === point && answer.warning);
  const notes = [openRange(point), luck(point)].filter((note) => note);
  return element(
    "div",
    element(
      "div.run-name",
      swatch(points.method[point]),
      name,
      element("span.knob", knobOf(point)),
    ),
    line && element("p.quiet", line),
    points.cause[point] && element("p.bad", `${ending(point)}: ${points.cause[point]}`),
    element("ul.run-facts", facts(point)),
    [...new Set(warnings.map(({ warning }) => warning))].map((text) => element("p.warning", text)),
    notes.map((note) => element("p.about", note)),
    element("p.about", "This command repeats it:"),
    commandLine(points.command[point]),
  );
}

// The seconds of another run by phase, with their shares.
function phases({ all, ...seconds }) {
  const share = (value) => `${words.seconds(value)}, ${Math.round((100 * value) / all)} %`;
  const known = Object.keys(PHASES).filter((phase) => seconds[phase] > 0);
  return [
    ["another run, timed by phase", words.seconds(all)],
    ...known.map((phase) => [PHASES[phase], share(seconds[phase])]),
  ];
}

function figures(title, pairs) {
  const list = definitions(pairs);
  list.className = "figures";
  return [element("h3", title), list];
}

/** Shows the chosen run in words. */
export function drawRun() {
  showChoice();
  const seconds = keptMotion(state.run)?.seconds;
  byId("run-head").replaceChildren(head(state.run));
  byId("run-figures").replaceChildren(
    ...(report.counts.length ? figures("Its counts", countsOf(state.run)) : []),
    ...(seconds?.all > 0 ? figures("Where its time goes", phases(seconds)) : []),
  );
}
