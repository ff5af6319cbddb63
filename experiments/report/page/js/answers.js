// The head of the page and the table of answers: what to take at each accuracy.
"use strict";
{
  const { element, byId, report, words, named, state, visit } = qddotReport;
  const { points, methods } = report;
  const rows = [];
  const HEADS = {
    accuracy: "Accuracy",
    take: "Take",
    at: "At",
    error: "Error",
    time: "Time of a run",
    next: "The next method takes",
    others: "Best of other families takes",
  };
  // Times that are nearer to each other are not told apart.
  const AS_FAST = 1.02;

  const cell = (label, ...children) =>
    element("td", { "data-label": label }, element("div", {}, ...children));

  function beside(point, ratio) {
    return [
      named(points.method[point]),
      " ",
      element("span", { class: "ratio" }, ratio < AS_FAST ? "as fast" : words.ratio(ratio)),
    ];
  }

  function others(answer) {
    if (!answer.others?.length) return ["–"];
    return answer.others.map((other) => element("div", {}, ...beside(other.point, other.ratio)));
  }

  // The address keeps the choice, so the link is not followed.
  function seeRun(event) {
    event.preventDefault();
    const smooth = !matchMedia("(prefers-reduced-motion: reduce)").matches;
    byId("run").scrollIntoView({ behavior: smooth ? "smooth" : "auto" });
  }

  function row(answer) {
    const accuracy = cell(
      HEADS.accuracy,
      element("span", { class: "number take" }, words.number(answer.accuracy)),
    );
    if (answer.point === null) {
      const why = element(
        "td",
        { "data-label": HEADS.take, colspan: 6 },
        element("div", { class: "quiet" }, answer.why ?? "no answer"),
      );
      return element("tr", {}, accuracy, why);
    }
    const { point, next, warning } = answer;
    const method = points.method[point];
    const error =
      points[report.judged_by === "energy" ? "error_energy_max" : "error_position"]?.[point];
    // The whole row may be clicked on; the button is for keys and for those who hear the page.
    const pick = element("button", { type: "button", class: "pick" }, named(method));
    const line = element(
      "tr",
      { "data-point": point, click: () => visit({ run: point }) },
      accuracy,
      cell(
        HEADS.take,
        element("span", { class: "take" }, pick),
        methods[method].line && element("span", { class: "line" }, methods[method].line),
        warning && element("span", { class: "warning" }, warning),
        element("a", { class: "see-run", href: "#run", click: seeRun }, "see its run ↓"),
      ),
      cell(
        HEADS.at,
        element("span", { class: "number" }, words.knob(points.knob[point], points.value[point])),
      ),
      cell(HEADS.error, element("span", { class: "number" }, words.number(error))),
      cell(HEADS.time, element("span", { class: "number" }, words.seconds(points.time_s[point]))),
      cell(HEADS.next, ...(next ? beside(next.point, next.ratio) : ["–"])),
      cell(HEADS.others, ...others(answer)),
    );
    rows.push({ line, pick, point });
    return line;
  }

  function table() {
    const heads = Object.values(HEADS);
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
    for (const { line, pick, point } of rows) {
      line.classList.toggle("chosen", point === state.run);
      pick.setAttribute("aria-pressed", String(point === state.run));
    }
  }

  /** Writes the head and the table. */
  qddotReport.drawAnswers = () => {
    // The scene's name alone would not say what it is among the tabs of a browser.
    document.title = `${report.title} – qddot report`;
    const runs = points.method.length;
    const span = report.until === null ? "" : ` over ${words.exact(report.until)} s of motion`;
    byId("lead").append(
      `${words.things(methods.length, "method")}, ${words.things(runs, "run")}${span}: which reaches an accuracy in the least time?`,
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
    if (report.answers_note)
      byId("answers-table").append(element("p", { class: "about" }, report.answers_note));
    byId("answers").hidden = false;
    mark();
    qddotReport.onChoice(mark);
  };

  qddotReport.drawAnswers();
}
