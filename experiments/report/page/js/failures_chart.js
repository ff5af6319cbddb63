// The runs that gave no point of the chart: a row for each way to fail, over the knob.
"use strict";
{
  const { byId, report, words, state, plot } = qddotReport;
  const { points, methods } = report;
  const drawing = byId("failures-drawing");
  const PALE = 0.25;
  const GAP = 0.03;
  const EDGES = { t: 4, b: 46 };

  const axisName = (place, name) => (place ? `${name}${place + 1}` : name);

  function trace(rows, knob, place) {
    const marks = {
      x: [],
      y: [],
      customdata: [],
      mode: "markers",
      hoverinfo: "none",
      xaxis: axisName(place, "x"),
    };
    const marker = {
      symbol: "x-thin",
      size: 7,
      opacity: [],
      line: { color: [], width: [] },
      color: plot.INK,
    };
    for (const { runs, ys } of rows) {
      runs.forEach((point, at) => {
        if (points.knob[point] !== knob) return;
        const strong = qddotReport.shown.has(points.method[point]) || point === state.run;
        marks.x.push(points.value[point]);
        marks.y.push(ys[at]);
        marks.customdata.push(point);
        marker.opacity.push(strong ? 1 : PALE);
        marker.line.color.push(methods[points.method[point]].color);
        marker.line.width.push(strong ? 2 : 1.5);
      });
    }
    return { ...marks, marker };
  }

  /** A ring around the chosen run, where it is one of these. */
  function ringTrace(rows, knobs) {
    const row = rows.find(({ runs }) => runs.includes(state.run));
    const place = row ? knobs.indexOf(points.knob[state.run]) : 0;
    return {
      x: row ? [points.value[state.run]] : [],
      y: row ? [row.ys[row.runs.indexOf(state.run)]] : [],
      xaxis: axisName(place, "x"),
      mode: "markers",
      hoverinfo: "skip",
      marker: {
        symbol: "circle-open",
        size: 17,
        color: plot.INK,
        line: { width: 2.2, color: plot.INK },
      },
    };
  }

  function knobAxis(rows, knob, place, knobs, narrow) {
    const values = rows
      .flatMap(({ runs }) => runs)
      .filter((point) => points.knob[point] === knob)
      .map((point) => points.value[point]);
    const axis = plot.decades(
      ...plot.widened(Math.min(...values), Math.max(...values), 2),
      plot.powerOfTen,
    );
    const every = Math.ceil(axis.tickvals.length / (narrow ? 3 : 7));
    axis.tickvals = axis.tickvals.filter((_, at) => at % every === 0);
    axis.ticktext = axis.ticktext.filter((_, at) => at % every === 0);
    const title = words.knobTitle(knob) + (knob === "step_size" ? " in s" : "");
    axis.title = { text: plot.plainWords(title), font: { size: 12 }, standoff: 4 };
    const share = 1 / knobs.length;
    axis.domain = [
      place * share + (place ? GAP : 0),
      (place + 1) * share - (place + 1 < knobs.length ? GAP : 0),
    ];
    return { ...axis, fixedrange: true, showline: false };
  }

  function layout(rows, height, knobs, narrow) {
    const across = {
      type: "line",
      xref: "paper",
      x0: 0,
      x1: 1,
      line: { color: plot.GRID, width: 1 },
    };
    const axes = knobs.map((knob, place) => [
      axisName(place, "xaxis"),
      knobAxis(rows, knob, place, knobs, narrow),
    ]);
    return {
      ...plot.layout(),
      ...plot.sizeOf(drawing),
      ...Object.fromEntries(axes),
      margin: { l: narrow ? 104 : 132, r: 12, ...EDGES },
      yaxis: {
        range: [height, 0],
        tickvals: rows.map(({ top, bottom }) => (top + bottom) / 2),
        ticktext: rows.map(({ kind, runs }) => plot.plainWords(`${kind} (${runs.length})`)),
        tickfont: { size: narrow ? 11 : 12 },
        showgrid: false,
        zeroline: false,
        fixedrange: true,
      },
      shapes: rows.slice(1).map(({ top }) => ({ ...across, y0: top, y1: top })),
    };
  }

  let listening = false;

  /** Draws the strip for the present choice; hides it where no run failed. */
  qddotReport.drawFailures = () => {
    const { rows, height } = qddotReport.failureRows();
    byId("failures").hidden = rows.length === 0;
    if (!rows.length) return;
    const knobs = [...new Set(rows.flatMap(({ runs }) => runs).map((point) => points.knob[point]))];
    drawing.style.height = `${height + EDGES.t + EDGES.b}px`;
    const data = knobs.map((knob, place) => trace(rows, knob, place));
    const narrow = drawing.clientWidth < plot.NARROW;
    Plotly.react(
      drawing,
      [...data, ringTrace(rows, knobs)],
      layout(rows, height, knobs, narrow),
      plot.config,
    );
    if (!listening) qddotReport.listenToMarks(drawing);
    listening = true;
  };
}
