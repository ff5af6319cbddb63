// The runs whose motion was kept: the most telling as buttons, all of many in a menu.
"use strict";
{
  const { element, report, state, choose, visit } = qddotReport;
  const MOST_BUTTONS = 6;

  function button(run) {
    const chosen = String(run.point === state.run);
    return element(
      "button",
      {
        type: "button",
        "aria-pressed": chosen,
        title: run.why,
        click: () => visit({ run: run.point }),
      },
      run.label,
    );
  }

  function menu(runs) {
    const kept = runs.some((run) => run.point === state.run);
    const options = runs.map((run) =>
      element("option", { value: run.point }, run.why ? `${run.label}: ${run.why}` : run.label),
    );
    const first = element("option", { value: "", disabled: true }, `all ${runs.length}`);
    const select = element(
      "select",
      {
        "aria-label": "All runs whose motion was kept",
        change: () => choose({ run: Number(select.value) }),
      },
      first,
      ...options,
    );
    select.value = kept ? state.run : "";
    return select;
  }

  /** Buttons and menu that choose among them, or null where no run's motion was kept. */
  qddotReport.keptMotions = () => {
    const runs = report.motion.runs.filter((run) => run.role === "run" && run.point !== null);
    if (!runs.length) return null;
    const parts = runs.slice(0, MOST_BUTTONS).map(button);
    if (runs.length > MOST_BUTTONS) parts.push(menu(runs));
    return element(
      "div",
      { class: "kept", role: "group", "aria-label": "Runs whose motion was kept" },
      "Kept motions:",
      ...parts,
    );
  };
}
