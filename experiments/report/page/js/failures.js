// The runs that gave no point of the chart, over the knob: a row for each way to fail, and in a row
// those at about the same knob under each other.
import { byId } from "./element.js";
import {
  GRID,
  INK,
  NARROW,
  axisTitle,
  decades,
  plainWords,
  plot,
  powerOfTen,
  ring,
  widened,
} from "./plot.js";
import { allRuns, isDrawn, methods, points, state, whyNot } from "./report.js";
import { words } from "./words.js";

const drawing = byId("failures-drawing");
// Marks in px: how far apart they are, in a row that is no higher than this.
const PITCH = 9;
const HIGHEST = 150;
const SPARE = 28;
const BINS_A_DECADE = 12;
const PALE = 0.25;
const KNOBS = { step_size: "step size h in s", rtol: "tolerance rtol" };
const EDGES = { t: 4, b: 46 };

// The number of earlier runs at about the same knob, for each of the runs.
function levelsOf(runs) {
  const filled = {};
  return runs.map((point) => {
    const bin = `${points.knob[point]} ${Math.round(BINS_A_DECADE * Math.log10(points.value[point]))}`;
    filled[bin] = (filled[bin] ?? -1) + 1;
    return filled[bin];
  });
}

/** The rows as {kind, top, bottom, marks}, their marks as {point, y}, all in px from the top. */
function failureRows() {
  const failed = allRuns.filter((point) => !isDrawn(point, state.column, state.ordinate));
  const why = failed.map((point) => whyNot(point, state.column));
  const kinds = [...new Set(why)].filter((kind) => kind !== null);
  let top = 0;
  return kinds.map((kind) => {
    const runs = failed.filter((_, at) => why[at] === kind);
    const levels = levelsOf(runs);
    const most = Math.max(...levels);
    const pitch = Math.min(PITCH, HIGHEST / Math.max(most, 1));
    const marks = runs.map((point, at) => ({ point, y: top + SPARE / 2 + pitch * levels[at] }));
    const row = { kind, marks, top, bottom: top + SPARE + pitch * most };
    top = row.bottom;
    return row;
  });
}

const axisOf = (place, name = "x") => (place ? `${name}${place + 1}` : name);

function trace(marks, place) {
  const runs = marks.map(({ point }) => point);
  const strong = runs.map((run) => state.shown.has(points.method[run]) || run === state.run);
  return {
    x: runs.map((run) => points.value[run]),
    y: marks.map(({ y }) => y),
    xaxis: axisOf(place),
    customdata: runs,
    mode: "markers",
    hoverinfo: "none",
    marker: {
      symbol: "x-thin",
      size: 7,
      opacity: strong.map((is) => (is ? 1 : PALE)),
      line: {
        color: runs.map((run) => methods[points.method[run]].color),
        width: strong.map((is) => (is ? 2 : 1.5)),
      },
      color: INK,
    },
  };
}

function knobAxis(marks, knob, narrow) {
  const values = marks.map(({ point }) => points.value[point]);
  return {
    ...decades(...widened(values, 2), powerOfTen, narrow ? 3 : 7),
    title: axisTitle(KNOBS[knob] ?? words.plain(knob), 4, 12),
    fixedrange: true,
    showline: false,
  };
}

function rowAxis(rows, narrow) {
  return {
    range: [rows.at(-1).bottom, 0],
    tickvals: rows.map(({ top, bottom }) => (top + bottom) / 2),
    ticktext: rows.map(({ kind, marks }) => plainWords(`${kind} (${marks.length})`)),
    tickfont: { size: narrow ? 11 : 12 },
    showgrid: false,
    zeroline: false,
    fixedrange: true,
  };
}

/** Draws the strip for the present choice; hides it where no run failed. */
export function drawFailures() {
  const rows = failureRows();
  byId("failures").hidden = rows.length === 0;
  if (!rows.length) return;
  const all = rows.flatMap(({ marks }) => marks);
  const knobs = [...new Set(all.map(({ point }) => points.knob[point]))];
  const over = knobs.map((knob) => all.filter(({ point }) => points.knob[point] === knob));
  const chosen = all.find(({ point }) => point === state.run);
  const place = chosen ? knobs.indexOf(points.knob[state.run]) : 0;
  const narrow = drawing.clientWidth < NARROW;
  drawing.style.height = `${rows.at(-1).bottom + EDGES.t + EDGES.b}px`;
  plot(
    drawing,
    [
      ...over.map(trace),
      ring(chosen ? points.value[state.run] : null, chosen?.y, 17, axisOf(place)),
    ],
    {
      ...Object.fromEntries(
        knobs.map((knob, at) => [axisOf(at, "xaxis"), knobAxis(over[at], knob, narrow)]),
      ),
      yaxis: rowAxis(rows, narrow),
      // The knobs stand beside each other.
      grid: { rows: 1, columns: knobs.length, xgap: 0.06 },
      margin: { l: narrow ? 104 : 132, r: 12, ...EDGES },
      shapes: rows
        .slice(1)
        .map(({ top }) => ({
          type: "line",
          xref: "paper",
          x0: 0,
          x1: 1,
          y0: top,
          y1: top,
          line: { color: GRID, width: 1 },
        })),
    },
  );
}
