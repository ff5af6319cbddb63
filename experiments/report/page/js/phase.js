// The phase plane of a scene of one mass: its velocity against its position, for each axis.
import { shownMotions } from "./compare.js";
import { byId, element } from "./element.js";
import { GRID, axisTitle, plot } from "./plot.js";
import { keptMotion, report, state } from "./report.js";

const axes = ["x", "y", "z"].slice(0, report.motion?.dimension ?? 0);
// A drawing for each axis, made once, as Plotly keeps listeners for each.
const drawings = axes.map((name) =>
  element("div.drawing", { role: "img", "aria-label": `Velocity against position along ${name}` }),
);
const START = 8;
// A run that blows up would leave the others no room.
const FARTHEST = 1.6;

// An axis over what the first run shows, and somewhat more.
function axis(title, values) {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const [middle, reach] = [(low + high) / 2, (FARTHEST * (high - low)) / 2 || 1];
  return {
    range: [middle - reach, middle + reach],
    title: axisTitle(title, 4, 12),
    gridcolor: GRID,
    zerolinecolor: "#cfcfca",
    tickfont: { size: 11 },
  };
}

// The curve of a run along an axis, with a dot at its start.
function curve({ run, color }, along) {
  const isReference = run.role === "reference";
  return {
    x: run.phase.position[along],
    y: run.phase.velocity[along],
    mode: "lines+markers",
    line: { color, width: isReference ? 4 : 1.8, shape: "spline" },
    marker: { color, opacity: 1, size: run.times.map((_, frame) => (frame === 0 ? START : 0)) },
    text: run.times.map((t) => t.toPrecision(4)),
    hovertemplate: "x = %{x:.4g} m, v = %{y:.4g} m/s at t = %{text} s<extra></extra>",
  };
}

/** Draws it, or nothing where several nodes move or the run's motion was not kept. */
export function drawPhase() {
  const shown = shownMotions().filter(({ run }) => run.phase);
  byId("phase").hidden = !keptMotion(state.run)?.phase;
  if (byId("phase").hidden) return;
  if (!drawings[0].isConnected) byId("phase-charts").append(...drawings);
  const { position, velocity } = shown[0].run.phase;
  axes.forEach((name, along) =>
    plot(
      drawings[along],
      shown.map((one) => curve(one, along)),
      {
        uirevision: state.run,
        margin: { l: 66, r: 14, t: 8, b: 42 },
        xaxis: axis(`${name} in m`, position[along]),
        yaxis: axis(`velocity along ${name} in m/s`, velocity[along]),
      },
    ),
  );
}
