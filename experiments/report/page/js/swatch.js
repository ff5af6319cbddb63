// A method's line and mark in small, as they are in the chart.
"use strict";
{
  const { svgElement, lookOf } = qddotReport;
  const SHAPES = {
    o: "M-4 0a4 4 0 1 0 8 0a4 4 0 1 0-8 0z",
    s: "M-3.6-3.6h7.2v7.2h-7.2z",
    "^": "M0-4.4L4.2 3.2H-4.2z",
    v: "M0 4.4L4.2-3.2H-4.2z",
    D: "M0-4.8L4.8 0L0 4.8L-4.8 0z",
    P: "M-1.6-4.6h3.2v3h3v3.2h-3v3h-3.2v-3h-3v-3.2h3z",
    X: "M-4.4-2.2L-2.2-4.4L0-2.2L2.2-4.4L4.4-2.2L2.2 0L4.4 2.2L2.2 4.4L0 2.2L-2.2 4.4L-4.4 2.2L-2.2 0z",
  };

  /** An SVG of 28 by 14 px that shows how a method is drawn. */
  qddotReport.swatch = (method) => {
    const { color, marker, dash, filled, width } = lookOf(method);
    const line = {
      d: "M1 7h26",
      stroke: color,
      "stroke-width": width,
      "stroke-dasharray": dash.length ? dash.join(" ") : null,
    };
    const mark = {
      d: SHAPES[marker] ?? SHAPES.o,
      transform: "translate(14 7)",
      fill: filled ? color : "#fff",
      stroke: color,
      "stroke-width": 1.2,
    };
    return svgElement(
      "svg",
      {
        class: "swatch",
        width: 28,
        height: 14,
        viewBox: "0 0 28 14",
        "aria-hidden": "true",
        fill: "none",
      },
      svgElement("path", line),
      svgElement("path", mark),
    );
  };

  /** The swatch with the method's name. */
  qddotReport.named = (method) =>
    qddotReport.element(
      "span",
      { class: "named" },
      qddotReport.swatch(method),
      qddotReport.report.methods[method].name,
    );
}
