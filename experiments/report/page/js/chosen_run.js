// The head of the chosen run, the menus that choose one, and its figures.
"use strict";
{
  const {
    element,
    byId,
    report,
    runsOf,
    words,
    swatch,
    state,
    choose,
    visit,
    onChoice,
    keptMotion,
  } = qddotReport;
  const { points, methods, families } = report;
  const PHASES = [
    ["force", "forces"],
    ["stiffness", "stiffness matrices"],
    ["factorization", "factorizations"],
    ["solve", "solves"],
  ];
  const TIMES = [
    ["time_s", "time of a run, median"],
    ["time_min_s", "fastest of them"],
    ["setup_s", "set-up"],
  ];
  const methodMenu = element("select", {
    change: () => choose({ run: firstRun(Number(methodMenu.value)) }),
  });
  const runMenu = element("select", { change: () => choose({ run: Number(runMenu.value) }) });

  // The middle of a method's runs that gave a point.
  function firstRun(method) {
    const good = runsOf[method].filter((point) => !points.cause[point]);
    const runs = good.length ? good : runsOf[method];
    return runs[Math.floor(runs.length / 2)];
  }

  function step(by) {
    const runs = runsOf[points.method[state.run]];
    const at = runs.indexOf(state.run) + by;
    if (runs[at] !== undefined) visit({ run: runs[at] });
  }

  /** Builds the menus. */
  qddotReport.drawRunChoice = () => {
    families.forEach((family, index) => {
      const members = methods
        .map((_, method) => method)
        .filter((method) => methods[method].family === index && runsOf[method].length);
      if (!members.length) return;
      methodMenu.append(
        element(
          "optgroup",
          { label: family.title },
          ...members.map((method) => element("option", { value: method }, methods[method].name)),
        ),
      );
    });
    const button = (text, label, by) =>
      element(
        "button",
        { type: "button", "aria-label": label, title: label, click: () => step(by) },
        text,
      );
    byId("run-choice").append(
      element("label", {}, "Method ", methodMenu),
      element("label", {}, "Run ", runMenu),
      button("◀", "Coarser run", -1),
      button("▶", "Finer run", 1),
    );
    onChoice((changed) => changed.includes("column") && showChoice());
  };

  // The menu tells of the error that the chart stands over.
  function showChoice() {
    if (state.run === null) return;
    const quantity = report.quantities.find(({ column }) => column === state.column);
    const method = points.method[state.run];
    methodMenu.value = method;
    const text = (point) => {
      const error = points[state.column]?.[point];
      const known = typeof error === "number";
      const result = points.cause[point]
        ? "failed"
        : known
          ? `${quantity.axis} ${words.number(error)}`
          : "error not known";
      return `${words.knob(points.knob[point], points.value[point])} · ${result}`;
    };
    runMenu.replaceChildren(
      ...runsOf[method].map((point) => element("option", { value: point }, text(point))),
    );
    runMenu.value = state.run;
  }

  const fact = (label, value) =>
    element("li", {}, element("b", {}, value), element("span", {}, label));

  function head() {
    const point = state.run;
    const method = methods[points.method[point]];
    const errors = report.quantities.filter(
      (one) => typeof points[one.column]?.[point] === "number",
    );
    const [least, most] = [
      points.error_position_at_least?.[point],
      points.error_position_at_most?.[point],
    ];
    const open =
      typeof most === "number" && least < 0.95 * most
        ? `between ${words.number(least)} and ${words.number(most)}: the reference leaves that open`
        : null;
    return [
      element(
        "div",
        { class: "run-name" },
        swatch(points.method[point]),
        method.name,
        element("span", { class: "knob" }, words.knob(points.knob[point], points.value[point])),
      ),
      method.line && element("p", { class: "quiet" }, method.line),
      points.cause[point] &&
        element("p", { class: "bad" }, `${ending(point)}: ${points.cause[point]}`),
      element(
        "ul",
        { class: "run-facts" },
        ...errors.map((one) => fact(one.axis, words.number(points[one.column][point]))),
        ...TIMES.filter(([column]) => typeof points[column]?.[point] === "number").map(
          ([column, label]) => fact(label, words.seconds(points[column][point])),
        ),
        growth(point),
      ),
      ...[...new Set(warnings(point))].map((text) => element("p", { class: "warning" }, text)),
      open && element("p", { class: "about" }, `Its position error lies ${open}.`),
      element("p", { class: "about" }, "This command repeats it:"),
      qddotReport.commandLine(points.command[point]),
    ].filter(Boolean);
  }

  function ending(point) {
    const t = points.t_reached[point];
    if (points.outcome[point] === "reached_end") return "No point of the chart";
    const how = words.plain(points.outcome[point]);
    return t === null ? how : `${how} at t = ${words.seconds(t)}`;
  }

  // Where the energy stays, its growth says nothing.
  function growth(point) {
    const times = points.energy_growth?.[point];
    if (typeof times !== "number" || Math.abs(times - 1) < 0.01) return null;
    return fact("largest energy / energy at the start", words.number(times));
  }

  const warnings = (point) =>
    report.answers
      .filter((answer) => answer.point === point && answer.warning)
      .map((answer) => answer.warning);

  function figureList(pairs) {
    return element(
      "dl",
      { class: "figures" },
      ...pairs.map(([label, value]) =>
        element("div", {}, element("dt", {}, label), element("dd", {}, value)),
      ),
    );
  }

  function phases() {
    const { seconds } = keptMotion(state.run) ?? {};
    if (!seconds || !(seconds.all > 0)) return [];
    const share = (value) =>
      `${words.seconds(value)}, ${Math.round((100 * value) / seconds.all)} %`;
    const known = PHASES.filter(([phase]) => seconds[phase] > 0).map(([phase, label]) => [
      label,
      share(seconds[phase]),
    ]);
    return [
      element("h3", {}, "Where its time goes"),
      figureList([["another run, timed by phase", words.seconds(seconds.all)], ...known]),
    ];
  }

  function figures() {
    const counted = report.counts.filter((column) => points[column]?.[state.run] > 0);
    const pairs = counted.map((column) => [
      words.plain(column),
      words.count(points[column][state.run]),
    ]);
    return [element("h3", {}, "Its counts"), figureList(pairs), ...phases()];
  }

  /** Shows the chosen run in words. */
  qddotReport.drawRun = () => {
    showChoice();
    if (state.run === null) return;
    byId("run-head").replaceChildren(...head());
    byId("run-figures").replaceChildren(...figures());
  };
}
