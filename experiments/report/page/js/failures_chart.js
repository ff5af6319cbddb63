// The runs that gave no point of the chart: a row for each way to fail, over the knob.
"use strict";
{
  const { byId, report, words, state, plot, isDrawn } = qddotReport;
  const { points, methods } = report;
  const drawing = byId("failures-drawing");
  const ROW = 46;
  const PALE = 0.25;
  const EDGES = { t: 4, b: 46 };

  function failures() {
    const kinds = new Map();
    points.method.forEach((_, point) => {
      if (isDrawn(point, state.column, state.ordinate)) return;
      const ended = points.outcome[point] === "reached_end";
      const kind = ended ? qddotReport.whyNot(point, state.column) : words.plain(points.outcome[point]);
      if (kind !== "no such number") kinds.set(kind, [...(kinds.get(kind) ?? []), point]);
    });
    return kinds;
  }

  function trace(kinds, knob, axis) {
    const marks = { x: [], y: [], customdata: [], mode: "markers", hoverinfo: "none", xaxis: axis };
    const marker = { symbol: "x-thin", size: 8, opacity: [], line: { color: [], width: [] }, color: plot.INK };
    [...kinds.values()].forEach((runs, row) => {
      for (const point of runs.filter((one) => points.knob[one] === knob)) {
        const method = points.method[point];
        const strong = qddotReport.shown.has(method);
        marks.x.push(points.value[point]);
        // Methods that fail at the same knob stand under each other inside the row.
        marks.y.push(row - 0.36 + (0.72 * (method + 0.5)) / methods.length);
        marks.customdata.push(point);
        marker.opacity.push(point === state.run || strong ? 1 : PALE);
        marker.line.color.push(methods[method].color);
        marker.line.width.push(point === state.run ? 4 : strong ? 2 : 1.5);
      }
    });
    return { ...marks, marker };
  }

  function ringTrace(kinds, knobs) {
    const ring = { x: [], y: [], mode: "markers", hoverinfo: "skip", marker: { symbol: "circle-open", size: 19, color: plot.INK, line: { width: 2.2, color: plot.INK } } };
    [...kinds.values()].forEach((runs, row) => {
      if (!runs.includes(state.run)) return;
      const method = points.method[state.run];
      const place = knobs.indexOf(points.knob[state.run]);
      ring.x.push(points.value[state.run]);
      ring.y.push(row - 0.36 + (0.72 * (method + 0.5)) / methods.length);
      ring.xaxis = place ? `x${place + 1}` : "x";
    });
    return ring;
  }

  function layout(kinds, knobs, narrow) {
    const rows = kinds.size;
    const result = {
      ...plot.layout(),
      margin: { l: narrow ? 104 : 132, r: 12, ...EDGES },
      yaxis: {
        range: [rows - 0.5, -0.5],
        tickvals: [...kinds.keys()].map((_, row) => row),
        ticktext: [...kinds].map(([kind, runs]) => plot.plainWords(`${kind} (${runs.length})`)),
        tickfont: { size: narrow ? 11 : 12 },
        showgrid: false,
        zeroline: false,
        fixedrange: true,
      },
      shapes: [...kinds.keys()].slice(1).map((_, row) => ({
        type: "line", xref: "paper", x0: 0, x1: 1, y0: row + 0.5, y1: row + 0.5, line: { color: plot.GRID, width: 1 },
      })),
    };
    const share = 1 / knobs.length;
    knobs.forEach((knob, place) => {
      const values = [...kinds.values()].flat().filter((point) => points.knob[point] === knob).map((point) => points.value[point]);
      const [low, high] = plot.widened(Math.min(...values), Math.max(...values), 2);
      const axis = plot.decades(low, high, plot.powerOfTen);
      const most = narrow ? 4 : 7;
      const every = Math.ceil(axis.tickvals.length / most);
      axis.tickvals = axis.tickvals.filter((_, at) => at % every === 0);
      axis.ticktext = axis.ticktext.filter((_, at) => at % every === 0);
      axis.title = { text: plot.plainWords(words.knobTitle(knob) + (knob === "step_size" ? " in s" : "")), font: { size: 12 }, standoff: 4 };
      axis.domain = [place * share + (place ? 0.03 : 0), (place + 1) * share - (place + 1 < knobs.length ? 0.03 : 0)];
      axis.fixedrange = true;
      axis.showline = false;
      result[place ? `xaxis${place + 1}` : "xaxis"] = axis;
    });
    return result;
  }

  let listening = false;

  /** Draws the strip for the present choice; hides it where no run failed. */
  qddotReport.drawFailures = () => {
    const kinds = failures();
    byId("failures").hidden = kinds.size === 0;
    if (!kinds.size) return;
    const knobs = [...new Set([...kinds.values()].flat().map((point) => points.knob[point]))];
    const narrow = drawing.clientWidth < 560;
    drawing.style.height = `${kinds.size * ROW + EDGES.t + EDGES.b}px`;
    const data = knobs.map((knob, place) => trace(kinds, knob, place ? `x${place + 1}` : "x"));
    Plotly.react(drawing, [...data, ringTrace(kinds, knobs)], layout(kinds, knobs, narrow), plot.config);
    if (!listening) qddotReport.listenToMarks(drawing);
    listening = true;
  };
}
