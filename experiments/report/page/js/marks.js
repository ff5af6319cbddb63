// A method's line and mark: in small, as an SVG, and as Plotly draws them in the chart.
import { element } from "./element.js";
import { methods, report } from "./report.js";

// Triangles look smaller than squares of the same size, and matplotlib's are larger too.
const MARKS = {
  o: { symbol: "circle", size: 7, path: "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z" },
  s: { symbol: "square", size: 6.5, path: "M-3.6-3.6h7.2v7.2h-7.2z" },
  "^": { symbol: "triangle-up", size: 8.5, path: "M0-4.4L4.2 3.2H-4.2z" },
  v: { symbol: "triangle-down", size: 8.5, path: "M0 4.4L4.2-3.2H-4.2z" },
  D: { symbol: "diamond", size: 7, path: "M0-4.8L4.8 0L0 4.8L-4.8 0z" },
  P: { symbol: "cross", size: 8, path: "M-1.6-4.6h3.2v3h3v3.2h-3v3h-3.2v-3h-3v-3.2h3z" },
  X: {
    symbol: "x",
    size: 7.5,
    path: "M-4.4-2.2L-2.2-4.4L0-2.2L2.2-4.4L4.4-2.2L2.2 0L4.4 2.2L2.2 4.4L0 2.2L-2.2 4.4L-4.4 2.2L-2.2 0z",
  },
};

function lookOf(method) {
  const { color, marker, family } = methods[method];
  return { color, ...(MARKS[marker] ?? MARKS.o), ...report.families[family] };
}

/** An SVG of 28 by 14 px that shows how a method is drawn. */
export function swatch(method) {
  const { color, path, dash, filled, width } = lookOf(method);
  return element(
    "svg.swatch",
    { width: 28, height: 14, viewBox: "0 0 28 14", "aria-hidden": "true", fill: "none" },
    element("path", {
      d: "M1 7h26",
      stroke: color,
      "stroke-width": width,
      "stroke-dasharray": dash.length ? dash.join(" ") : null,
    }),
    element("path", {
      d: path,
      transform: "translate(14 7)",
      fill: filled ? color : "#fff",
      stroke: color,
      "stroke-width": 1.2,
    }),
  );
}

/** The swatch with the method's name. */
export const named = (method) => element("span.named", swatch(method), methods[method].name);

/** A method's mark for Plotly, whose size is in px. */
export function markOf(method) {
  const { color, symbol, size, filled } = lookOf(method);
  return { symbol, size, fill: filled ? color : "#ffffff", edge: color };
}

/** A method's line for Plotly. */
export function lineOf(method) {
  const { color, dash, width } = lookOf(method);
  const dashes = dash.map((part) => `${part.toFixed(1)}px`).join(",");
  return { color, width, dash: dashes || "solid" };
}
