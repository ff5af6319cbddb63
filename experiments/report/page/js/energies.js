// The energies of the chosen run over time, and how far its total drifts.
"use strict";
{
  const { element, byId, report, state, plot, words, keptMotion } = qddotReport;
  const KINDS = [
    ["kinetic", "#0072B2"],
    ["potential", "#B35900"],
    ["total", plot.INK],
  ];
  const FAINT_LINE = { color: "#b5b5b0", width: 4 };
  const section = byId("energies");

  const drawing = (label) => element("div", { class: "drawing", role: "img", "aria-label": label });
  // Both are drawn into again for each run, so that nothing of Plotly's is left behind.
  const parts = drawing("Kinetic, potential and total energy over time");
  const errors = drawing("Relative error of the total energy over time");

  const layout = (node, title, yaxis) => ({
    ...plot.layout(),
    ...plot.sizeOf(node),
    uirevision: state.run,
    margin: { l: 66, r: 14, t: 8, b: 42 },
    xaxis: {
      title: { text: "t in s", standoff: 4, font: { size: 12 } },
      gridcolor: plot.GRID,
      zeroline: false,
      tickfont: { size: 11 },
    },
    yaxis: {
      title: { text: title, standoff: 4, font: { size: 12 } },
      gridcolor: plot.GRID,
      zeroline: false,
      tickfont: { size: 11 },
      exponentformat: "e",
      ...yaxis,
    },
  });

  // What a difference of energies is measured by: the largest kinetic energy on the way.
  const largest = (values) => values.reduce((most, value) => (value > most ? value : most), 0);

  function drift({ total }, scale) {
    return total.map((value) =>
      value === null ? null : Math.abs(value - total[0]) / scale || null,
    );
  }

  function key() {
    const entry = ([name, color]) => {
      const line = element("span", { "aria-hidden": "true" }, "━ ");
      line.style.color = color;
      return element("span", {}, line, `${name}  `);
    };
    return element(
      "p",
      { class: "about" },
      ...[...KINDS, ["the reference's total", FAINT_LINE.color]].map(entry),
    );
  }

  /** Draws them, or nothing where the run's motion was not kept. */
  qddotReport.drawEnergies = () => {
    section.replaceChildren();
    const run = keptMotion(state.run);
    if (!run?.energy) return;
    const reference = report.motion.runs.find((one) => one.role === "reference" && one.energy);
    section.append(
      element("h3", {}, "Its energies"),
      key(),
      element("div", { class: "energy-charts" }, parts, errors),
    );
    const hover = { hovertemplate: "%{y:.4g} J at t = %{x:.4g} s<extra></extra>" };
    const lines = KINDS.map(([kind, color]) => ({
      x: run.energy.t,
      y: run.energy[kind],
      mode: "lines",
      line: { color, width: 1.8 },
      ...hover,
    }));
    if (reference)
      lines.unshift({
        x: reference.energy.t,
        y: reference.energy.total,
        mode: "lines",
        line: FAINT_LINE,
        hoverinfo: "skip",
      });
    Plotly.react(parts, lines, layout(parts, "energy in J", {}), plot.config);
    const scale = largest((reference ?? run).energy.kinetic) || 1;
    const relative = (energy) => ({ x: energy.t, y: drift(energy, scale), mode: "lines" });
    const drifts = [
      {
        ...relative(run.energy),
        line: { color: plot.INK, width: 1.8 },
        hovertemplate: "%{y:.2g} at t = %{x:.4g} s<extra></extra>",
      },
    ];
    if (reference && reference !== run)
      drifts.unshift({ ...relative(reference.energy), line: FAINT_LINE, hoverinfo: "skip" });
    const all = drifts.flatMap((one) => one.y).filter((value) => value > 0);
    const range = all.length
      ? plot.widened(
          all.reduce((a, b) => Math.min(a, b)),
          largest(all),
          1.5,
        )
      : [1e-16, 1];
    const title = "|E − E(0)| / largest kinetic";
    Plotly.react(
      errors,
      drifts,
      layout(errors, title, plot.decades(...range, plot.powerOfTen)),
      plot.config,
    );
    section.append(
      element(
        "p",
        { class: "about" },
        `Differences of the total are divided by the largest kinetic energy, ${words.number(scale)} J.`,
      ),
    );
  };
}
