// The head of the page and the table of answers: which run to take at each accuracy.
import { byId, element } from "./element.js";
import { named } from "./marks.js";
import { allRuns, isStudy, knobOf, methods, onChoice, points, report, state, visit } from "./report.js";
import { words } from "./words.js";

const table = byId("answers-table").querySelector("table");
const heads = [...table.tHead.rows[0].cells].map((head) => head.textContent);
// Times that are nearer to each other are not told apart.
const AS_FAST = 1.02;
const judged = report.quantities[0].column;

const number = (text) => element("span.number", text);

const beside = ({ point, ratio }) =>
  element(
    "div",
    named(points.method[point]),
    " ",
    element("span.ratio", ratio < AS_FAST ? "as fast" : words.ratio(ratio)),
  );

// The address keeps the choice, so the link is not followed.
function seeRun(event) {
  event.preventDefault();
  byId("run").scrollIntoView();
}

// The answers in lists: one for each run that is the fastest at several accuracies in turn, or
// reason that there is none.
function grouped(answers) {
  const groups = [];
  for (const answer of answers) {
    const last = groups.at(-1);
    const isSame = last?.[0].point === answer.point && last[0].why === answer.why;
    if (isSame) last.push(answer);
    else groups.push([answer]);
  }
  return groups;
}

const ends = (group) => [...new Set([group[0], group.at(-1)])];
const accuracies = (group) =>
  ends(group)
    .map(({ accuracy }) => words.number(accuracy))
    .join(" to ");

// What `entry` makes of the first and the last answer, each with its accuracy where they differ.
function atEnds(group, entry) {
  const cells = ends(group).map((answer) => ({ answer, made: entry(answer) }));
  const [first, last] = [cells[0].made, cells.at(-1).made];
  if (cells.length === 1 || (first.textContent === last.textContent)) return first;
  return cells.map(({ answer, made }) =>
    element("div", made, element("span.ratio", ` at ${words.number(answer.accuracy)}`)),
  );
}

const nextOf = ({ next }) => (next ? beside(next) : element("div", "–"));
const othersOf = ({ others }) =>
  element("div", others.length ? others.map(beside) : "–");

function cellsOf(group) {
  const { point, warning } = group[0];
  const method = points.method[point];
  return [
    [
      // The whole row may be clicked on; the button is for keys and for those who hear the page.
      element("span.take", element("button.pick", { type: "button" }, named(method))),
      methods[method].line && element("span.line", methods[method].line),
      warning && element("span.warning", warning),
      element("a.see-run", { href: "#run", click: seeRun }, "see its run ↓"),
    ],
    number(knobOf(point)),
    number(words.number(points[judged]?.[point])),
    number(words.seconds(points.time_s[point])),
    atEnds(group, nextOf),
    atEnds(group, othersOf),
  ];
}

function row(group) {
  const { point, why: reason } = group[0];
  const cell = (content, at) =>
    element("td", { "data-label": heads[at] }, element("div", ...[content].flat()));
  const first = element("span.number.take", accuracies(group));
  if (point !== null) {
    const cells = [first, ...cellsOf(group)].map(cell);
    return element("tr", { "data-point": point, click: () => visit({ run: point }) }, cells);
  }
  const why = element("div.quiet", reason ?? "no answer");
  return element("tr", cell(first, 0), element("td", { "data-label": heads[1], colspan: 6 }, why));
}

// Shows which rows are of the chosen run.
function mark() {
  for (const line of table.querySelectorAll("[data-point]")) {
    const chosen = Number(line.dataset.point) === state.run;
    line.classList.toggle("chosen", chosen);
    line.querySelector(".pick").setAttribute("aria-pressed", String(chosen));
  }
}

// The scene's name alone would not say what it is among the tabs of a browser.
document.title = `${report.title} – qddot report`;
const many = `${words.things(methods.length, "method")}, ${words.things(allRuns.length, "run")}`;
const span = report.until === null ? "" : ` over ${words.exact(report.until)} s of motion`;
const question = isStudy ? "which reaches an accuracy in the least time" : "how do they move";
byId("lead").append(`${many}${span}: ${question}?`);
byId("notes").append(...report.notes.map((note) => element("p.note", note)));
const kind =
  report.judged_by === "energy" ? "energy error on the way" : "relative position error at the end";
byId("answers-about").append(
  `The fastest run of all whose ${kind} is at most the accuracy. Choose a row to see its run.`,
);
const groups = grouped(report.answers ?? []);
byId("answers-rows").append(...groups.map(row));
table.hidden = !groups.length;
byId("no-answers").hidden = !table.hidden;
if (report.answers_note) byId("answers-table").append(element("p.about", report.answers_note));
byId("answers").hidden = !isStudy;
mark();
onChoice(mark);
