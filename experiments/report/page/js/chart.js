// The chart of all runs: error against time or a count.
import { byId } from "./element.js";
import { lineOf, markOf } from "./marks.js";
import {
  FAINT,
  NARROW,
  axisTitle,
  decades,
  plainWords,
  plot,
  powerOfTen,
  ring,
  widened,
} from "./plot.js";
import { allRuns, chosenQuantity, isDrawn, methods, points, runsOf, state } from "./report.js";
import { words } from "./words.js";

const drawing = byId("chart-drawing");
const FRONT = "#f5e663";
const PALE = "#efefec";

// The axes of the present choice, as they were drawn last; null where no run is a mark of them.
let view = null;

/** The axes of the present choice: where a run stands, x(point) and y(point), and the ends. A run
    whose error is below the floor, the least that means anything, stands on it. */
function currentView() {
  const quantity = chosenQuantity();
  const { column, floor } = quantity;
  const { ordinate } = state;
  const drawn = allRuns.filter((point) => isDrawn(point, column, ordinate));
  if (!drawn.length) return null;
  const positive = drawn.map((point) => points[column][point]).filter((error) => error > 0);
  const least = floor ?? (positive.length ? Math.min(...positive) : 1e-16);
  const x = (point) => Math.max(points[column][point], least);
  const y = (point) => points[ordinate][point];
  // The error at which a run counts: that of a finer one, or none, where its own is small by luck.
  const counted = (point) =>
    point in quantity.lucky ? (quantity.lucky[point] ?? Infinity) : x(point);
  const xs = drawn.map(x);
  const shown = floor !== null && Math.min(...xs) < 1e3 * floor ? floor : null;
  const [left, right] = widened([shown === null ? Math.min(...xs) : shown / 2, ...xs], 2.5);
  const [bottom, top] = widened(drawn.map(y), 2);
  const ends = { left, right, bottom, top };
  return { quantity, column, ordinate, drawn, floor: shown, x, y, counted, ...ends };
}

// The runs on the front, from the least error to the largest.
function frontOf({ quantity, drawn, counted, y }) {
  const sorted = drawn
    .filter((point) => quantity.counts?.[point] !== false && counted(point) < Infinity)
    .sort((a, b) => counted(a) - counted(b) || y(a) - y(b));
  let least = Infinity;
  return sorted.filter((point) => {
    const isLess = y(point) < least;
    if (isLess) least = y(point);
    return isLess;
  });
}

const drawnRuns = (method) =>
  runsOf[method].filter((point) => isDrawn(point, view.column, view.ordinate));

// The front as a staircase from the upper end of the axes to the right one.
function frontTrace(front) {
  const xs = front.map(view.counted);
  const ys = front.map(view.y);
  return {
    x: front.length ? [xs[0], ...xs, view.right] : [],
    y: front.length ? [view.top, ...ys, ys.at(-1)] : [],
    mode: "lines",
    line: { color: FRONT, width: 9, shape: "hv" },
    hoverinfo: "skip",
  };
}

// The methods that are not strong: one line with gaps, marks in their colours.
function cloudTrace(cloud) {
  const places = cloud.flatMap((method) =>
    [...drawnRuns(method), null].map((point) => ({ point, ...markOf(method) })),
  );
  const along = (value) => places.map(({ point }) => (point === null ? null : value(point)));
  return {
    x: along(view.x),
    y: along(view.y),
    customdata: along((point) => point),
    mode: "lines+markers",
    hoverinfo: "none",
    connectgaps: false,
    line: { color: PALE, width: 1 },
    marker: {
      symbol: places.map(({ symbol }) => symbol),
      size: places.map(({ size }) => size - 1),
      color: places.map(({ fill }) => fill),
      opacity: 0.2,
      line: { color: places.map(({ edge }) => edge), width: 1 },
    },
  };
}

function methodTrace(method) {
  const runs = drawnRuns(method);
  const { symbol, size, fill, edge } = markOf(method);
  return {
    x: runs.map(view.x),
    y: runs.map(view.y),
    error_x: view.column === "error_position" ? uncertainty(runs, edge) : undefined,
    customdata: runs,
    name: plainWords(methods[method].name),
    mode: "lines+markers",
    hoverinfo: "none",
    line: lineOf(method),
    marker: {
      symbol: runs.map((point) => (point in view.quantity.lucky ? "x-thin-open" : symbol)),
      size,
      color: fill,
      line: { color: edge, width: 1.2 },
      opacity: 1,
    },
  };
}

// Bars where the reference leaves errors open.
function uncertainty(runs, color) {
  const { error_position_at_least: least, error_position_at_most: most } = points;
  const above = runs.map((point) => Math.max(0, (most?.[point] ?? 0) - view.x(point)));
  return {
    type: "data",
    symmetric: false,
    array: above,
    arrayminus: runs.map((point) =>
      Math.max(0, view.x(point) - Math.max(least?.[point] ?? 0, view.left)),
    ),
    color,
    thickness: 0.8,
    width: 0,
    visible: runs.some((point, at) => above[at] > 0.1 * view.x(point)),
  };
}

function ringTrace() {
  const shown = view.drawn.includes(state.run);
  return ring(shown ? view.x(state.run) : null, shown ? view.y(state.run) : null, 19);
}

// A narrow chart has no words on directions below it.
function axes(narrow) {
  const { quantity, ordinate } = view;
  const inTime = ordinate === "time_s";
  const better = (how, what) => `◀ ${how}          ${what}`;
  const across = narrow ? quantity.axis : better("more accurate", quantity.axis);
  const up = inTime
    ? better("faster", "time of one run, median")
    : better("less work", words.plain(ordinate));
  return {
    xaxis: { ...decades(view.left, view.right), title: axisTitle(across, 8, 13) },
    yaxis: {
      ...decades(view.bottom, view.top, inTime ? words.seconds : powerOfTen),
      title: axisTitle(up, 6, 13),
    },
  };
}

// The region of errors that mean nothing.
function floorShapes() {
  const edges = { xref: "x", yref: "paper", y0: 0, y1: 1, layer: "below", x1: view.floor };
  return [
    { ...edges, type: "rect", x0: view.left / 1e3, fillcolor: PALE, line: { width: 0 } },
    { ...edges, type: "line", x0: view.floor, line: { color: FAINT, width: 1 } },
  ];
}

const floorWords = () => ({
  text: plainWords(view.quantity.floor_words || "no smaller error means anything"),
  x: Math.log10(view.floor),
  y: 0.01,
  yref: "paper",
  xanchor: "left",
  yanchor: "bottom",
  textangle: -90,
  showarrow: false,
  font: { size: 11.5, color: FAINT },
  bgcolor: "rgba(255,255,255,0.85)",
});

// Labels in px: a character's width, a line's height, how far they are from their mark.
const CHARACTER = 6.7;
const HEIGHT = 15;
const AWAY = 9;
const SIDES = [
  [1, -1],
  [-1, 1],
  [1, 1],
  [-1, -1],
  [1, 0],
  [-1, 0],
];
// A label costs one for each mark that it hides, and a part of one for each mark away from an end.
const A_MARK_INWARDS = 0.3;
const MOST_COST = 4;

function boxBeside({ x, y }, [across, down], width) {
  const left = across > 0 ? x + AWAY : x - AWAY - width;
  const top = y - HEIGHT / 2 + down * (AWAY + 3);
  return { left, top, right: left + width, bottom: top + HEIGHT };
}

const overlap = (a, b, spare = 0) =>
  a.left < b.right + spare &&
  b.left < a.right + spare &&
  a.top < b.bottom + spare &&
  b.top < a.bottom + spare;

// The names of methods beside their lines, those on the front first, where they hide neither each
// other nor many marks. A method for which there is no room gets none.
function labels(strong, front, margin) {
  const width = drawing.clientWidth - margin.l - margin.r;
  const height = drawing.clientHeight - margin.t - margin.b;
  const share = (value, low, high) => Math.log(value / low) / Math.log(high / low);
  const across = (value) => width * share(value, view.left, view.right);
  // The region of errors that mean nothing has words of its own.
  const leftEnd = view.floor === null ? 0 : across(view.floor);
  const onFront = new Set(front.map((point) => points.method[point]));
  const lines = strong
    .map((method) => ({
      method,
      places: drawnRuns(method).map((point) => ({
        point,
        x: across(view.x(point)),
        y: height * (1 - share(view.y(point), view.bottom, view.top)),
      })),
    }))
    .sort((a, b) => onFront.has(b.method) - onFront.has(a.method));
  const marks = lines
    .flatMap(({ places }) => places)
    .map(({ x, y }) => ({ left: x, right: x, top: y, bottom: y }));
  const taken = [];
  return lines.flatMap(({ method, places }) => {
    const { name, text_color: color } = methods[method];
    let best = { cost: Infinity };
    const inwards = (at) => Math.min(at, places.length - 1 - at);
    for (const at of [...places.keys()].sort((a, b) => inwards(a) - inwards(b))) {
      for (const side of SIDES) {
        const box = boxBeside(places[at], side, name.length * CHARACTER);
        if (box.left < leftEnd || box.right > width || box.top < 0 || box.bottom > height) continue;
        if (taken.some((other) => overlap(box, other))) continue;
        const hidden = marks.filter((mark) => overlap(box, mark, 3)).length;
        const cost = hidden + A_MARK_INWARDS * inwards(at);
        if (cost < best.cost) best = { cost, box, point: places[at].point, side };
      }
    }
    if (best.cost > MOST_COST) return [];
    taken.push(best.box);
    return {
      text: plainWords(name),
      x: Math.log10(view.x(best.point)),
      y: Math.log10(view.y(best.point)),
      xanchor: best.side[0] > 0 ? "left" : "right",
      yanchor: "middle",
      xshift: best.side[0] * 7,
      yshift: -best.side[1] * 11,
      showarrow: false,
      font: { size: 12, color },
      bgcolor: "rgba(255,255,255,0.6)",
      borderpad: 0,
    };
  });
}

/** Draws the chart for the present choice; a zoom stays while its axes do. */
export function drawChart() {
  view = currentView();
  byId("quantity-about").textContent = chosenQuantity().subtitle ?? "";
  byId("no-marks").hidden = view !== null;
  drawing.hidden = view === null;
  byId("whole").hidden = true;
  if (!view) return;
  const narrow = drawing.clientWidth < NARROW;
  const isStrong = (method) => state.shown.has(method);
  const strong = [...methods.keys()].filter(isStrong);
  const rest = [...methods.keys()].filter((method) => !isStrong(method));
  const front = frontOf(view);
  const margin = { l: narrow ? 62 : 84, r: 12, t: 10, b: 52 };
  const hasFloor = view.floor !== null;
  const isFirst = !drawing.data;
  plot(
    drawing,
    [
      frontTrace(front),
      cloudTrace(byId("cloud").checked ? rest : []),
      ...strong.map(methodTrace),
      ringTrace(),
    ],
    {
      ...axes(narrow),
      uirevision: `${view.column} ${view.ordinate}`,
      margin,
      shapes: hasFloor ? floorShapes() : [],
      annotations: [...(hasFloor ? [floorWords()] : []), ...labels(strong, front, margin)],
    },
    { doubleClick: false },
  );
  if (isFirst) {
    drawing.on("plotly_relayout", offerWhole);
    drawing.on("plotly_doubleclick", showWhole);
  }
  offerWhole();
}

const ranges = () => ({
  "xaxis.range": [view.left, view.right].map(Math.log10),
  "yaxis.range": [view.bottom, view.top].map(Math.log10),
});

function offerWhole() {
  const { xaxis, yaxis } = drawing.layout;
  const [across, up] = Object.values(ranges());
  const differs = (ends, range) => range.some((end, at) => Math.abs(end - ends[at]) > 1e-6);
  byId("whole").hidden = !differs(across, xaxis.range) && !differs(up, yaxis.range);
}

// Undoes the zoom.
const showWhole = () => Plotly.relayout(drawing, ranges());
byId("whole").addEventListener("click", showWhole);
byId("cloud").addEventListener("change", drawChart);

/** Moves the ring to the chosen run. */
export function moveRing() {
  if (!view) return;
  const { x, y } = ringTrace();
  Plotly.restyle(drawing, { x: [x], y: [y] }, [drawing.data.length - 1]);
}
