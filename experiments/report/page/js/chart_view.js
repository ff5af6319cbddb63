// The axes of the chart for the present choice: where a run stands in them, their ends and their
// words.
"use strict";
{
  const { report, words, state, plot, isDrawn } = qddotReport;
  const { points } = report;

  /** The axes of the present choice: the errors' quantity, the runs that are marks, their places
      x(point) and y(point), and the ends left, right, bottom, top. */
  function currentView() {
    const { column, ordinate } = state;
    const quantity = report.quantities.find((one) => one.column === column);
    const drawn = points.method
      .map((_, point) => point)
      .filter((point) => quantity && isDrawn(point, column, ordinate));
    const positive = drawn.map((point) => points[column][point]).filter((error) => error > 0);
    const least = positive.reduce((a, b) => Math.min(a, b), Infinity);
    const floor = quantity?.floor ?? null;
    const stand = floor ?? (positive.length ? least : 1e-16);
    const x = (point) => Math.max(points[column][point], stand);
    const y = (point) => points[ordinate][point];
    const xs = drawn.map(x);
    const ys = drawn.map(y);
    const floorShown = floor !== null && (!xs.length || Math.min(...xs) < 1e3 * floor);
    const [left, right] = xs.length
      ? plot.widened(floorShown ? floor / 2 : Math.min(...xs), Math.max(...xs), 2.5)
      : [1e-9, 1];
    const [bottom, top] = ys.length ? plot.widened(Math.min(...ys), Math.max(...ys), 2) : [1e-3, 1];
    return {
      column,
      ordinate,
      quantity,
      drawn,
      floor: floorShown ? floor : null,
      stand,
      x,
      y,
      left,
      right,
      bottom,
      top,
    };
  }

  const ordinateTitle = (ordinate) =>
    ordinate === "time_s" ? "time of one run, median" : words.plain(ordinate);

  /** Plotly's axes of a view; a narrow one has no words on directions below it. */
  function axes(view, narrow) {
    const inTime = view.ordinate === "time_s";
    const across = plot.decades(view.left, view.right, plot.powerOfTen);
    const up = plot.decades(view.bottom, view.top, inTime ? plot.seconds : plot.powerOfTen);
    const title = narrow ? view.quantity.axis : `◀ more accurate          ${view.quantity.axis}`;
    across.title = { text: plot.plainWords(title), standoff: 8, font: { size: 13 } };
    const direction = inTime ? "faster" : "less work";
    up.title = {
      text: plot.plainWords(`◀ ${direction}          ${ordinateTitle(view.ordinate)}`),
      standoff: 6,
      font: { size: 13 },
    };
    return { xaxis: across, yaxis: up };
  }

  /** Whether a drawing shows other ranges than those of its view. */
  function isZoomed(drawing, view) {
    const differs = ({ range }, ends) =>
      range.some((end, at) => Math.abs(end - Math.log10(ends[at])) > 1e-6);
    const { xaxis, yaxis } = drawing.layout;
    return differs(xaxis, [view.left, view.right]) || differs(yaxis, [view.bottom, view.top]);
  }

  /** Shows all of a view in its drawing. */
  function showWhole(drawing, view) {
    const range = (...ends) => ends.map(Math.log10);
    Plotly.relayout(drawing, {
      "xaxis.range": range(view.left, view.right),
      "yaxis.range": range(view.bottom, view.top),
    });
  }

  qddotReport.chartView = { currentView, axes, isZoomed, showWhole };
}
