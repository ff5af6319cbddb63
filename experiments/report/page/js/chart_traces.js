// What the chart consists of, for Plotly: the front, the pale cloud, the lines of the strong
// methods.
"use strict";
{
  const { report, runsOf, isDrawn, plot } = qddotReport;
  const { points } = report;
  const FRONT = "#f5e663";
  const PALE = 0.2;

  /** The places of a method's runs in the chart, from the largest knob to the least. */
  const drawnRuns = (method, column, ordinate) =>
    runsOf[method].filter((point) => isDrawn(point, column, ordinate));

  /** The front as a staircase up to the right end of the axes. */
  function frontTrace(front, view) {
    const xs = front.map(view.x);
    const ys = front.map(view.y);
    if (front.length) {
      xs.push(view.right);
      ys.push(ys.at(-1));
      xs.unshift(xs[0]);
      ys.unshift(view.top);
    }
    return {
      x: xs,
      y: ys,
      mode: "lines",
      line: { color: FRONT, width: 9, shape: "hv" },
      hoverinfo: "skip",
    };
  }

  /** The methods that are not strong: one line with gaps, marks in their colours. */
  function cloudTrace(methods, view) {
    const trace = {
      x: [],
      y: [],
      customdata: [],
      mode: "lines+markers",
      hoverinfo: "none",
      connectgaps: false,
    };
    const marker = {
      symbol: [],
      size: [],
      color: [],
      opacity: PALE,
      line: { color: [], width: 1 },
    };
    for (const method of methods) {
      const look = plot.markerOf(method);
      for (const point of [...drawnRuns(method, view.column, view.ordinate), null]) {
        trace.x.push(point === null ? null : view.x(point));
        trace.y.push(point === null ? null : view.y(point));
        trace.customdata.push(point);
        marker.symbol.push(look.symbol);
        marker.size.push(look.size - 1);
        marker.color.push(look.fill);
        marker.line.color.push(look.edge);
      }
    }
    return { ...trace, marker, line: { color: "#efefec", width: 1 } };
  }

  /** One strong method; bars where the reference leaves its errors open. */
  function methodTrace(method, view) {
    const runs = drawnRuns(method, view.column, view.ordinate);
    const look = plot.markerOf(method);
    const trace = {
      x: runs.map(view.x),
      y: runs.map(view.y),
      customdata: runs,
      name: plot.plainWords(report.methods[method].name),
      mode: "lines+markers",
      hoverinfo: "none",
      line: plot.lineOf(method),
      marker: {
        symbol: look.symbol,
        size: look.size,
        color: look.fill,
        line: { color: look.edge, width: 1.2 },
        opacity: 1,
      },
    };
    if (view.column === "error_position") trace.error_x = uncertainty(runs, view, look.edge);
    return trace;
  }

  function uncertainty(runs, view, color) {
    const most = runs.map((point) => points.error_position_at_most?.[point] ?? 0);
    const least = runs.map((point) => points.error_position_at_least?.[point] ?? 0);
    const above = runs.map((point, at) => Math.max(0, most[at] - view.x(point)));
    const below = runs.map((point, at) =>
      Math.max(0, view.x(point) - Math.max(least[at], view.left)),
    );
    const visible = runs.some((point, at) => above[at] > 0.1 * view.x(point));
    return {
      type: "data",
      symmetric: false,
      array: above,
      arrayminus: below,
      color,
      thickness: 0.8,
      width: 0,
      visible,
    };
  }

  /** A ring around the chosen run. */
  function ringTrace(point, view) {
    const shown = point !== null && isDrawn(point, view.column, view.ordinate);
    return {
      x: shown ? [view.x(point)] : [],
      y: shown ? [view.y(point)] : [],
      mode: "markers",
      hoverinfo: "skip",
      marker: {
        symbol: "circle-open",
        size: 19,
        color: plot.INK,
        line: { width: 2.2, color: plot.INK },
      },
    };
  }

  qddotReport.traces = { drawnRuns, frontTrace, cloudTrace, methodTrace, ringTrace };
}
