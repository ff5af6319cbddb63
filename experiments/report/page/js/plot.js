// Plotly's drawings: their style, the ring around the chosen run, and marks that tell their run.
import { byId, definitions, element } from "./element.js";
import { named } from "./marks.js";
import { chosenQuantity, countsOf, knobOf, methods, points, visit } from "./report.js";
import { words } from "./words.js";

export const INK = "#222222";
export const FAINT = "#5f6368";
export const GRID = "#e8e8e4";
/** The width in px below which drawings have fewer words. */
export const NARROW = 560;
const MOST_TICKS = 12;

/** Words that Plotly, which reads some HTML in them, shows as they are. */
export const plainWords = (text) =>
  text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");

/** A power of ten in words: 1, 10, 1e-3. */
export function powerOfTen(value) {
  const power = Math.round(Math.log10(value));
  return power === 0 || power === 1 ? String(10 ** power) : `1e${power}`;
}

/** The title of an axis. */
export const axisTitle = (text, standoff, size) => ({
  text: plainWords(text),
  standoff,
  font: { size },
});

/** A logarithmic axis over a range of positive numbers, with ticks at decades in given words. */
export function decades(low, high, inWords = powerOfTen, most = MOST_TICKS) {
  const [from, to] = [Math.log10(low), Math.log10(high)];
  const every = Math.ceil((to - from) / most);
  const ticks = [];
  for (let power = Math.ceil(from / every) * every; power <= to; power += every)
    ticks.push(Number(`1e${power}`));
  return {
    type: "log",
    range: [from, to],
    tickvals: ticks,
    ticktext: ticks.map((value) => plainWords(inWords(value))),
    gridcolor: GRID,
    linecolor: FAINT,
    showline: true,
    zeroline: false,
    tickfont: { size: 12 },
    minor: { showgrid: false },
  };
}

/** The least and the largest of positive numbers, by a factor wider at both ends and never shorter
    than two decades. */
export function widened(values, factor) {
  const [low, high] = [Math.min(...values), Math.max(...values)];
  const spare = Math.max(factor, Math.sqrt(100 / (high / low)));
  return [low / spare, high * spare];
}

/** A circle around one place, or around none. */
export const ring = (x, y, size, xaxis = "x") => ({
  x: x === null ? [] : [x],
  y: x === null ? [] : [y],
  xaxis,
  mode: "markers",
  hoverinfo: "skip",
  marker: { symbol: "circle-open", size, color: INK, line: { width: 2.2, color: INK } },
});

/** Draws into an element, whose room may have changed: Plotly itself keeps the first. */
export function plot(drawing, traces, layout, config = {}) {
  const isFirst = !drawing.data;
  const font = {
    family: "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif",
    size: 13,
    color: INK,
  };
  const page = {
    font,
    paper_bgcolor: "#ffffff",
    plot_bgcolor: "#ffffff",
    showlegend: false,
    hovermode: "closest",
    hoverdistance: 16,
    dragmode: matchMedia("(pointer: coarse)").matches ? false : "zoom",
    width: drawing.clientWidth,
    height: drawing.clientHeight,
  };
  const buttons = { displayModeBar: false, showTips: false, doubleClick: "reset" };
  Plotly.react(drawing, traces, { ...page, ...layout }, { ...buttons, ...config });
  if (isFirst) listenToMarks(drawing);
}

const MOST_COUNTS = 5;
const box = byId("tooltip");

function content(point) {
  const { axis, column } = chosenQuantity();
  const { line } = methods[points.method[point]];
  return [
    element("p", element("b", named(points.method[point])), ` at ${knobOf(point)}`),
    line ? element("p.quiet", line) : "",
    points.cause[point] ? element("p.bad", points.cause[point]) : "",
    definitions([
      [axis, words.number(points[column]?.[point])],
      ["time of a run", words.seconds(points.time_s[point])],
      ...countsOf(point).slice(0, MOST_COUNTS),
    ]),
  ];
}

// Shows the run beside a place of the window in px.
function show(point, { clientX: x, clientY: y }) {
  box.replaceChildren(...content(point));
  box.dataset.point = point;
  box.hidden = false;
  const { width, height } = box.getBoundingClientRect();
  const left = x + 16 + width > innerWidth ? x - 16 - width : x + 16;
  const top = y + 16 + height > innerHeight ? y - 16 - height : y + 16;
  box.style.transform = `translate(${Math.max(8, Math.min(left, innerWidth - width - 8))}px, ${Math.max(8, top)}px)`;
}

const hide = () => (box.hidden = true);
addEventListener("scroll", hide, { passive: true });

// Lets the marks of a drawing show their run on hover and choose it on a click.
function listenToMarks(drawing) {
  const withRun = (act) => (event) => {
    const point = event.points?.map((mark) => mark.customdata).find(Number.isInteger);
    if (point !== undefined) act(point, event.event);
  };
  drawing.on("plotly_hover", withRun(show));
  drawing.on("plotly_unhover", hide);
  drawing.on("plotly_click", withRun((point) => visit({ run: point })));
}
