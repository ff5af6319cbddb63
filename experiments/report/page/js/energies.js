// The energies of the chosen run over time, and how far its total drifts.
import { byId, element } from "./element.js";
import { GRID, INK, axisTitle, decades, plot, widened } from "./plot.js";
import { keptMotion, report, state } from "./report.js";
import { words } from "./words.js";

const KINDS = { kinetic: "#0072B2", potential: "#B35900", total: INK };
const REFERENCE = { color: "#b5b5b0", width: 4 };

const axis = (text) => ({
  title: axisTitle(text, 4, 12),
  gridcolor: GRID,
  zeroline: false,
  tickfont: { size: 11 },
});

const layout = (title, yaxis = {}) => ({
  uirevision: state.run,
  margin: { l: 66, r: 14, t: 8, b: 42 },
  xaxis: axis("t in s"),
  yaxis: { ...axis(title), exponentformat: "e", ...yaxis },
});

const line = (x, y, color, hover) => ({
  x,
  y,
  mode: "lines",
  line: { color, width: 1.8 },
  hovertemplate: `${hover} at t = %{x:.4g} s<extra></extra>`,
});

const referenceLine = (x, y) => ({ x, y, mode: "lines", line: REFERENCE, hoverinfo: "skip" });

const kinds = { ...KINDS, "the reference's total": REFERENCE.color };
for (const [name, color] of Object.entries(kinds)) {
  const sign = element("span", { "aria-hidden": "true", style: `color: ${color}` }, "━ ");
  byId("energies-key").append(element("span", sign, `${name}  `));
}

/** Draws them, or nothing where the run's motion was not kept. */
export function drawEnergies() {
  const run = keptMotion(state.run);
  byId("energies").hidden = !run?.energy;
  if (!run?.energy) return;
  const reference = report.motion.runs.find((one) => one.role === "reference" && one.energy);
  const scale = Math.max(0, ...(reference ?? run).energy.kinetic) || 1;
  byId("energy-scale").textContent =
    `Differences of the total are divided by the largest kinetic energy, ${words.number(scale)} J.`;
  const { t, total } = run.energy;
  const lines = Object.entries(KINDS).map(([kind, color]) =>
    line(t, run.energy[kind], color, "%{y:.4g} J"),
  );
  if (reference) lines.unshift(referenceLine(reference.energy.t, reference.energy.total));
  plot(byId("energy-parts"), lines, layout("energy in J"));

  // A logarithmic axis has no place for zero.
  const drift = (values) =>
    values.map((value) => (value === null ? null : Math.abs(value - values[0]) / scale || null));
  const drifts = [line(t, drift(total), INK, "%{y:.2g}")];
  if (reference && reference !== run)
    drifts.unshift(referenceLine(reference.energy.t, drift(reference.energy.total)));
  const all = drifts.flatMap(({ y }) => y).filter((value) => value > 0);
  const range = all.length ? widened(all, 1.5) : [1e-16, 1];
  plot(byId("energy-errors"), drifts, layout("|E − E(0)| / largest kinetic", decades(...range)));
}
