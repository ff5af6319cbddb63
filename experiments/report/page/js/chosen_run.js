// The head of the chosen run, the menus that choose one, and its figures.
"use strict";
{
  const { element, byId, report, runsOf, words, swatch, state, choose } = qddotReport;
  const { points, methods, families, motion } = report;
  const PHASES = [
    ["force", "forces"],
    ["stiffness", "stiffness matrices"],
    ["factorization", "factorizations"],
    ["solve", "solves"],
  ];
  const TIMES = [
    ["time_s", "time of a run, median"],
    ["time_min_s", "least"],
    ["setup_s", "set-up before it"],
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
    if (runs[at] !== undefined) choose({ run: runs[at] });
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
  };

  function showChoice() {
    const method = points.method[state.run];
    methodMenu.value = method;
    const text = (point) => {
      const result = points.cause[point]
        ? "failed"
        : `error ${words.number(points.error_position[point])}`;
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
        element(
          "p",
          { class: "bad" },
          `No point of the chart: ${points.cause[point]}`,
          reached(point),
        ),
      element(
        "ul",
        { class: "run-facts" },
        ...errors.map((one) => fact(one.axis, words.number(points[one.column][point]))),
        ...TIMES.filter(([column]) => typeof points[column]?.[point] === "number").map(
          ([column, label]) => fact(label, words.seconds(points[column][point])),
        ),
      ),
      open && element("p", { class: "about" }, `Its position error lies ${open}.`),
      element("p", { class: "about" }, "This command repeats it:"),
      qddotReport.commandLine(points.command[point]),
    ].filter(Boolean);
  }

  function reached(point) {
    const t = points.t_reached[point];
    return points.outcome[point] === "reached_end" || t === null
      ? ""
      : `, at t = ${words.seconds(t)}`;
  }

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
    const { seconds } = motion?.runs.find((run) => run.point === state.run) ?? {};
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
    const growth = points.energy_growth?.[state.run];
    if (typeof growth === "number") pairs.push(["energy growth", words.number(growth)]);
    return [element("h3", {}, "Its counts"), figureList(pairs), ...phases()];
  }

  /** Shows the chosen run in words. */
  qddotReport.drawRun = () => {
    if (state.run === null) return;
    showChoice();
    byId("run-head").replaceChildren(...head());
    byId("run-figures").replaceChildren(...figures());
  };
}
