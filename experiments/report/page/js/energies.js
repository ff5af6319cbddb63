// The energies of the chosen run over time, and how far its total drifts.
import { REFERENCE, comparedMotions, keySign, reference } from "./compare.js";
import { byId, element } from "./element.js";
import { GRID, INK, axisTitle, decades, plot, widened } from "./plot.js";
import { keptMotion, state } from "./report.js";
import { words } from "./words.js";

const KINDS = { kinetic: "#0072B2", potential: "#B35900", total: INK };
const WORK = { dissipated: "#009E73", driven: "#7B3FA0", released: "#A02040" };
// The terms beside the energy in the total of damped, driven and breaking motions, in words and in
// symbols.
const KEPT = {
  dissipated: ["with what damping has taken", "+ W"],
  driven: ["less what driving has given", "− W driven"],
  released: ["with what broken springs held", "+ W released"],
};
const REFERENCE_LINE = { color: REFERENCE, width: 4 };

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

const referenceLine = (x, y) => ({ x, y, mode: "lines", line: REFERENCE_LINE, hoverinfo: "skip" });

// The colours in words: of the run's energies, and of the totals of others.
function drawKey(kinds, others) {
  const key = [
    ...Object.entries(kinds),
    ...(energyOf(reference) ? [["the reference's total", REFERENCE]] : []),
    ...others.map(({ run, color }) => [`total of ${run.label}`, color]),
  ];
  byId("energies-key").replaceChildren(
    ...key.map(([name, color]) => element("span.key", keySign(color), name)),
  );
}

const energyOf = (run) => run?.energy ?? null;

/** Draws them, with the totals of the runs that it is compared with; nothing where the run's motion
    was not kept. */
export function drawEnergies() {
  const run = keptMotion(state.run);
  byId("energies").hidden = !run?.energy;
  if (!run?.energy) return;
  const exact = energyOf(reference);
  const others = comparedMotions().filter((other) => energyOf(other.run));
  const works = Object.keys(WORK).filter((name) => run.energy[name]);
  const kinds = { ...KINDS, ...Object.fromEntries(works.map((name) => [name, WORK[name]])) };
  drawKey(kinds, others);
  const scaled = exact ?? run.energy;
  const largest = scaled.driven ? [...scaled.kinetic, ...scaled.driven.map(Math.abs)] : scaled.kinetic;
  const scale = Math.max(0, ...largest) || 1;
  const scaleInWords = scaled.driven
    ? "the largest kinetic energy or work of driving"
    : "the largest kinetic energy";
  const parts = works.map((name) => KEPT[name][0]).join(" and ");
  byId("energy-scale").textContent =
    `Differences of the total${parts ? `, ${parts},` : ""} are divided by ` +
    `${scaleInWords}, ${words.number(scale)} J.`;
  const { t, kept } = run.energy;
  const lines = Object.entries(kinds).map(([kind, color]) =>
    line(t, run.energy[kind], color, "%{y:.4g} J"),
  );
  for (const { run: other, color } of others)
    lines.unshift(line(other.energy.t, other.energy.total, color, `${other.label}: %{y:.4g} J`));
  if (exact) lines.unshift(referenceLine(exact.t, exact.total));
  plot(byId("energy-parts"), lines, layout("energy in J"));

  // A logarithmic axis has no place for zero.
  const drift = (values) =>
    values.map((value) => (value === null ? null : Math.abs(value - values[0]) / scale || null));
  const drifts = [line(t, drift(kept), INK, "%{y:.2g}")];
  for (const { run: other, color } of others)
    drifts.unshift(
      line(other.energy.t, drift(other.energy.kept), color, `${other.label}: %{y:.2g}`),
    );
  if (exact && exact !== run.energy) drifts.unshift(referenceLine(exact.t, drift(exact.kept)));
  const all = drifts.flatMap(({ y }) => y).filter((value) => value > 0);
  const range = all.length ? widened(all, 1.5) : [1e-16, 1];
  const symbols = works.map((name) => `${KEPT[name][1]} `).join("");
  const title = `|E ${symbols}− E(0)| / ${scaled.driven ? "largest" : "largest kinetic"}`;
  plot(byId("energy-errors"), drifts, layout(title, decades(...range)));
}
