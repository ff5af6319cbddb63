// The energies of the chosen run over time, and how far its total drifts.
import { byId, element } from "./element.js";
import { GRID, INK, decades, plot, widened } from "./plot.js";
import { keptMotion, report, state } from "./report.js";
import { words } from "./words.js";

const KINDS = { kinetic: "#0072B2", potential: "#B35900", total: INK };
const REFERENCE = { color: "#b5b5b0", width: 4 };

// Both are drawn into again for each run, so that nothing of Plotly's is left behind.
const drawing = (label) => element("div.drawing", { role: "img", "aria-label": label });
const parts = drawing("Kinetic, potential and total energy over time");
const errors = drawing("Relative error of the total energy over time");

const axis = (text) => ({
  title: { text, standoff: 4, font: { size: 12 } },
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

function key() {
  const entry = ([name, color]) => {
    const sign = element("span", { "aria-hidden": "true" }, "━ ");
    sign.style.color = color;
    return element("span", sign, `${name}  `);
  };
  const lines = { ...KINDS, "the reference's total": REFERENCE.color };
  return element("p.about", Object.entries(lines).map(entry));
}

/** Draws them, or nothing where the run's motion was not kept. */
export function drawEnergies() {
  const section = byId("energies");
  section.replaceChildren();
  const run = keptMotion(state.run);
  if (!run?.energy) return;
  const reference = report.motion.runs.find((one) => one.role === "reference" && one.energy);
  const scale = Math.max(0, ...(reference ?? run).energy.kinetic) || 1;
  section.append(
    element("h3", "Its energies"),
    key(),
    element("div.energy-charts", parts, errors),
    element(
      "p.about",
      `Differences of the total are divided by the largest kinetic energy, ${words.number(scale)} J.`,
    ),
  );
  const { t, total } = run.energy;
  const lines = Object.entries(KINDS).map(([kind, color]) =>
    line(t, run.energy[kind], color, "%{y:.4g} J"),
  );
  if (reference) lines.unshift(referenceLine(reference.energy.t, reference.energy.total));
  plot(parts, lines, layout("energy in J"));

  // A logarithmic axis has no place for zero.
  const drift = (values) =>
    values.map((value) => (value === null ? null : Math.abs(value - values[0]) / scale || null));
  const drifts = [line(t, drift(total), INK, "%{y:.2g}")];
  if (reference && reference !== run)
    drifts.unshift(referenceLine(reference.energy.t, drift(reference.energy.total)));
  const all = drifts.flatMap(({ y }) => y).filter((value) => value > 0);
  const range = all.length ? widened(all, 1.5) : [1e-16, 1];
  plot(errors, drifts, layout("|E − E(0)| / largest kinetic", decades(...range)));
}
