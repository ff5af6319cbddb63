// The reader's choice of the run, the kind of error and the ordinate. It is in the address after
// "#", so that a link leads to a run, and "back" to the run before. Other text there is ignored.
"use strict";
{
  const { report, runsOf, isDrawn } = qddotReport;
  const { points, methods } = report;
  const listeners = [];
  const ordinates = [
    "time_s",
    ...report.counts.filter((ordinate) =>
      report.quantities.some(({ column }) =>
        points.method.some((_, point) => isDrawn(point, column, ordinate)),
      ),
    ),
  ];
  const state = {
    run: openingRun(),
    column:
      (report.quantities.find((one) => one.column === judgedColumn()) ?? report.quantities[0])
        ?.column ?? null,
    ordinate: "time_s",
  };

  function judgedColumn() {
    return report.judged_by === "energy" ? "error_energy_max" : "error_position";
  }

  // The first answer whose motion was kept; else the first run with a motion, the first answer, any
  // run.
  function openingRun() {
    const answers = report.answers.filter((answer) => answer.point !== null);
    const kept = (report.motion?.runs ?? []).filter(
      (run) => run.role === "run" && run.point !== null,
    );
    const keptAnswer = answers.find((answer) => kept.some((run) => run.point === answer.point));
    return (
      keptAnswer?.point ?? kept[0]?.point ?? answers[0]?.point ?? (points.method.length ? 0 : null)
    );
  }

  function addressed(hash) {
    const words = new URLSearchParams(hash.replace(/^#/, ""));
    const found = {};
    const wanted = words.get("run") ?? "";
    const [name, value] = [
      wanted.slice(0, wanted.lastIndexOf("@")),
      wanted.slice(wanted.lastIndexOf("@") + 1),
    ];
    const method = methods.findIndex((one) => one.name === name);
    const run =
      method < 0
        ? undefined
        : runsOf[method].find((point) => String(points.value[point]) === value);
    if (run !== undefined) found.run = run;
    if (report.quantities.some((one) => one.column === words.get("error")))
      found.column = words.get("error");
    if (ordinates.includes(words.get("against"))) found.ordinate = words.get("against");
    return found;
  }

  function address() {
    const words = new URLSearchParams();
    if (state.run !== null)
      words.set("run", `${methods[points.method[state.run]].name}@${points.value[state.run]}`);
    if (state.column) words.set("error", state.column);
    words.set("against", state.ordinate);
    return `#${words}`;
  }

  // A browser may refuse a page on disk to change its address; the choice stands all the same.
  function write(method) {
    try {
      history[method](null, "", address());
    } catch {
      return;
    }
  }

  function change(changes, method) {
    const changed = Object.keys(changes).filter((key) => state[key] !== changes[key]);
    if (!changed.length) return;
    Object.assign(state, changes);
    write(method);
    for (const listener of listeners) listener(changed);
  }

  /** Changes some of the choices and tells all who listen what changed. */
  const choose = (changes) => change(changes, "replaceState");

  /** The same as a step that the browser's way back undoes. */
  const visit = (changes) => change(changes, "pushState");

  Object.assign(state, addressed(location.hash));
  const opening = { ...state };
  addEventListener("popstate", () => {
    choose(location.hash ? addressed(location.hash) : opening);
    // A link within the page, such as "#answers", leaves the choice in the address.
    if (location.hash && !location.hash.includes("=")) write("replaceState");
  });
  Object.assign(qddotReport, {
    state,
    choose,
    visit,
    ordinates,
    onChoice: (listener) => listeners.push(listener),
  });
}
