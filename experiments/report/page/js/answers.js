// The head of the page and the table of answers: what to take at each accuracy.
"use strict";
{
  const { element, byId, report, words, named, state, choose } = qddotReport;
  const { points, methods } = report;
  const rows = [];

  const cell = (label, ...children) =>
    element("td", { "data-label": label }, element("div", {}, ...children));

  function beside(point, ratio) {
    return [
      named(points.method[point]),
      " ",
      element("span", { class: "ratio" }, words.ratio(ratio)),
    ];
  }

  function others(answer) {
    if (!answer.others?.length) return ["–"];
    return answer.others.map((other) => element("div", {}, ...beside(other.point, other.ratio)));
  }

  function row(answer) {
    const accuracy = cell(
      "Accuracy",
      element("span", { class: "number take" }, words.number(answer.accuracy)),
    );
    if (answer.point === null) {
      const why = element(
        "td",
        { "data-label": "Take", colspan: 6 },
        element("div", { class: "quiet" }, answer.why ?? "no answer"),
      );
      return element("tr", {}, accuracy, why);
    }
    const { point, next, warning } = answer;
    const method = points.method[point];
    const error =
      points[report.judged_by === "energy" ? "error_energy_max" : "error_position"]?.[point];
    const pick = () => choose({ run: point });
    const line = element(
      "tr",
      {
        tabindex: 0,
        "aria-selected": "false",
        "data-point": point,
        click: pick,
        keydown: (event) => {
          if (event.key !== "Enter" && event.key !== " ") return;
          event.preventDefault();
          pick();
        },
      },
      accuracy,
      cell(
        "Take",
        element("span", { class: "take" }, named(method)),
        methods[method].line && element("span", { class: "line" }, methods[method].line),
        warning && element("span", { class: "warning" }, warning),
      ),
      cell(
        "At",
        element("span", { class: "number" }, words.knob(points.knob[point], points.value[point])),
      ),
      cell("Error", element("span", { class: "number" }, words.number(error))),
      cell("Time", element("span", { class: "number" }, words.seconds(points.time_s[point]))),
      cell("Next method", ...(next ? beside(next.point, next.ratio) : ["–"])),
      cell("Best of the others", ...others(answer)),
    );
    rows.push(line);
    return line;
  }

  function table() {
    const heads = [
      "Accuracy",
      "Take",
      "At",
      "Error",
      "Time of a run",
      "The next method takes",
      "Best of other families takes",
    ];
    return element(
      "table",
      { class: "answers" },
      element(
        "thead",
        {},
        element("tr", {}, ...heads.map((head) => element("th", { scope: "col" }, head))),
      ),
      element("tbody", {}, ...report.answers.map(row)),
    );
  }

  /** Shows which rows are of the chosen run. */
  function mark() {
    for (const line of rows)
      line.setAttribute("aria-selected", String(Number(line.dataset.point) === state.run));
  }

  /** Writes the head and the table. */
  qddotReport.drawAnswers = () => {
    const runs = points.method.length;
    const span = report.until === null ? "" : ` over ${words.exact(report.until)} s of motion`;
    byId("lead").append(
      `${methods.length} methods, ${words.count(runs)} runs${span}: which reaches an accuracy in the least time?`,
    );
    byId("notes").append(...report.notes.map((note) => element("p", { class: "note" }, note)));
    const kind =
      report.judged_by === "energy"
        ? "energy error on the way"
        : "relative position error at the end";
    byId("answers-about").append(
      `The fastest run of all whose ${kind} is at most the accuracy. Choose a row to see its run.`,
    );
    byId("answers-table").append(
      report.answers.length ? table() : element("p", { class: "quiet" }, "No run gave an answer."),
    );
    byId("answers").hidden = false;
    mark();
    qddotReport.onChoice(mark);
  };

  qddotReport.drawAnswers();
}
