// The chart of all runs: error against time or a count.
"use strict";
{
  const { element, byId, report, words, state, choose, traces, plot, isDrawn } = qddotReport;
  const { points, methods } = report;
  const drawing = byId("chart-drawing");
  const NARROW = 560;

  /** The axes of the present choice: where a run stands in them, and their ends. */
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

  function floorShapes(view) {
    if (view.floor === null) return { shapes: [], annotations: [] };
    const edges = { xref: "x", yref: "paper", y0: 0, y1: 1, layer: "below" };
    return {
      shapes: [
        {
          ...edges,
          type: "rect",
          x0: view.left / 1e3,
          x1: view.floor,
          fillcolor: "#efefec",
          line: { width: 0 },
        },
        {
          ...edges,
          type: "line",
          x0: view.floor,
          x1: view.floor,
          line: { color: plot.FAINT, width: 1 },
        },
      ],
      annotations: [
        {
          text: plot.plainWords(view.quantity.floor_words || "no smaller error means anything"),
          x: Math.log10(view.floor),
          y: 0.01,
          yref: "paper",
          xanchor: "left",
          yanchor: "bottom",
          textangle: -90,
          showarrow: false,
          font: { size: 11.5, color: plot.FAINT },
          bgcolor: "rgba(255,255,255,0.85)",
        },
      ],
    };
  }

  function labels(view, strong, front, margin) {
    const size = {
      width: drawing.clientWidth - margin.l - margin.r,
      height: drawing.clientHeight - margin.t - margin.b,
    };
    const across = (value) =>
      (Math.log(value / view.left) / Math.log(view.right / view.left)) * size.width;
    const up = (value) =>
      size.height * (1 - Math.log(value / view.bottom) / Math.log(view.top / view.bottom));
    // The region of errors that mean nothing has words of its own.
    size.left = view.floor === null ? 0 : across(view.floor);
    const onFront = new Set(front.map((point) => points.method[point]));
    const lines = strong
      .map((method) => ({
        method,
        places: traces
          .drawnRuns(method, view.column, view.ordinate)
          .map((point) => ({ point, x: across(view.x(point)), y: up(view.y(point)) })),
      }))
      .filter((line) => line.places.length)
      .sort((a, b) => onFront.has(b.method) - onFront.has(a.method));
    return qddotReport.placeLabels(lines, size).map(({ method, point, side }) => ({
      text: plot.plainWords(methods[method].name),
      x: Math.log10(view.x(point)),
      y: Math.log10(view.y(point)),
      xanchor: side[0] > 0 ? "left" : "right",
      yanchor: "middle",
      xshift: side[0] * 7,
      yshift: -side[1] * 11,
      showarrow: false,
      font: { size: 12, color: methods[method].text_color },
      bgcolor: "rgba(255,255,255,0.6)",
      borderpad: 0,
    }));
  }

  /** Draws the chart for the present choice. */
  qddotReport.drawChart = () => {
    const view = currentView();
    const note = byId("quantity-about");
    note.textContent = view.quantity?.subtitle ?? "";
    if (!view.drawn.length) {
      Plotly.purge(drawing);
      drawing.replaceChildren(
        element("p", { class: "quiet empty" }, "No run gave a point of this chart."),
      );
      drawing.style.height = "auto";
      return;
    }
    if (drawing.style.height) {
      drawing.style.height = "";
      drawing.replaceChildren();
    }
    const narrow = drawing.clientWidth < NARROW;
    const strong = methods
      .map((_, method) => method)
      .filter((method) => qddotReport.shown.has(method));
    const rest = methods
      .map((_, method) => method)
      .filter((method) => !qddotReport.shown.has(method));
    const front = qddotReport.front(view.quantity, view.ordinate, view.stand);
    const margin = { l: narrow ? 62 : 84, r: 12, t: 10, b: 52 };
    const floor = floorShapes(view);
    const layout = {
      ...plot.layout(),
      ...axes(view, narrow),
      margin,
      shapes: floor.shapes,
      annotations: [...floor.annotations, ...labels(view, strong, front, margin)],
    };
    const data = [
      traces.frontTrace(front, view),
      traces.cloudTrace(byId("cloud").checked ? rest : [], view),
      ...strong.map((method) => traces.methodTrace(method, view)),
      traces.ringTrace(state.run, view),
    ];
    Plotly.react(drawing, data, layout, plot.config);
    listen();
  };

  let listening = false;
  function listen() {
    if (listening) return;
    listening = true;
    qddotReport.listenToMarks(drawing);
    drawing.on(
      "plotly_relayout",
      () => (byId("whole").hidden = drawing.layout.xaxis.autorange === true || !zoomed()),
    );
  }

  function zoomed() {
    const view = currentView();
    const [from, to] = drawing.layout.xaxis.range;
    return (
      Math.abs(from - Math.log10(view.left)) > 1e-6 || Math.abs(to - Math.log10(view.right)) > 1e-6
    );
  }

  /** Lets the marks of a drawing show their run on hover and choose it on a click. */
  qddotReport.listenToMarks = (node) => {
    const pointOf = (event) =>
      event.points?.map((mark) => mark.customdata).find((point) => typeof point === "number");
    node.on("plotly_hover", (event) => {
      const point = pointOf(event);
      if (point !== undefined)
        qddotReport.showTooltip(point, event.event.clientX, event.event.clientY);
    });
    node.on("plotly_unhover", qddotReport.hideTooltip);
    node.on("plotly_click", (event) => {
      const point = pointOf(event);
      if (point !== undefined) choose({ run: point });
    });
  };

  /** Moves the ring to the chosen run. */
  qddotReport.moveRing = () => {
    if (!drawing.data) return;
    const ring = traces.ringTrace(state.run, currentView());
    Plotly.restyle(drawing, { x: [ring.x], y: [ring.y] }, [drawing.data.length - 1]);
  };
}
