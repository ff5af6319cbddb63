// The chart of all runs: error against time or a count.
"use strict";
{
  const { element, byId, report, state, traces, plot, chartView } = qddotReport;
  const { points, methods } = report;
  const drawing = byId("chart-drawing");

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

  function drawNone() {
    Plotly.purge(drawing);
    // That took the listeners with it.
    listening = false;
    byId("whole").hidden = true;
    drawing.replaceChildren(
      element("p", { class: "quiet empty" }, "No run gave a point of this chart."),
    );
    drawing.style.height = "auto";
  }

  /** Draws the chart for the present choice; a zoom stays while its axes do. */
  qddotReport.drawChart = () => {
    const view = chartView.currentView();
    byId("quantity-about").textContent = view.quantity?.subtitle ?? "";
    if (!view.drawn.length) return drawNone();
    if (drawing.style.height) {
      drawing.style.height = "";
      drawing.replaceChildren();
    }
    const narrow = drawing.clientWidth < plot.NARROW;
    const all = methods.map((_, method) => method);
    const strong = all.filter((method) => qddotReport.shown.has(method));
    const rest = all.filter((method) => !qddotReport.shown.has(method));
    const front = qddotReport.front(view.quantity, view.ordinate, view.stand);
    const margin = { l: narrow ? 62 : 84, r: 12, t: 10, b: 52 };
    const floor = floorShapes(view);
    const layout = {
      ...plot.layout(),
      ...plot.sizeOf(drawing),
      ...chartView.axes(view, narrow),
      uirevision: `${view.column} ${view.ordinate}`,
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
    Plotly.react(drawing, data, layout, { ...plot.config, doubleClick: false });
    listen();
    offerWhole();
  };

  let listening = false;
  function listen() {
    if (listening) return;
    listening = true;
    qddotReport.listenToMarks(drawing);
    drawing.on("plotly_relayout", offerWhole);
    drawing.on("plotly_doubleclick", qddotReport.showWholeChart);
  }

  function offerWhole() {
    byId("whole").hidden = !chartView.isZoomed(drawing, chartView.currentView());
  }

  /** Undoes the zoom. */
  qddotReport.showWholeChart = () => chartView.showWhole(drawing, chartView.currentView());

  /** Moves the ring to the chosen run. */
  qddotReport.moveRing = () => {
    if (!drawing.data) return;
    const ring = traces.ringTrace(state.run, chartView.currentView());
    Plotly.restyle(drawing, { x: [ring.x], y: [ring.y] }, [drawing.data.length - 1]);
  };
}
