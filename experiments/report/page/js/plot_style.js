// What all drawings of the page have in common: type, axes, marks; and Plotly's words made
// harmless.
"use strict";
{
  const { words, lookOf } = qddotReport;
  const INK = "#222222";
  const FAINT = "#5f6368";
  const GRID = "#e8e8e4";
  const SYMBOLS = {
    o: "circle",
    s: "square",
    "^": "triangle-up",
    D: "diamond",
    v: "triangle-down",
    P: "cross",
    X: "x",
  };
  // Triangles look smaller than squares of the same size, and matplotlib's are larger too.
  const SIZES = { o: 7, s: 6.5, "^": 8.5, v: 8.5, D: 7, P: 8, X: 7.5 };
  const MOST_TICKS = 12;
  // Width in px below which drawings have fewer words.
  const NARROW = 560;
  const FONT = {
    family: "system-ui, -apple-system, 'Segoe UI', Roboto, 'DejaVu Sans', sans-serif",
    size: 13,
    color: INK,
  };

  // Plotly reads some HTML in its words.
  const plainWords = (text) =>
    text.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");

  function markerOf(method) {
    const { color, marker, filled } = lookOf(method);
    return {
      symbol: SYMBOLS[marker] ?? "circle",
      size: SIZES[marker] ?? 7,
      fill: filled ? color : "#ffffff",
      edge: color,
    };
  }

  function lineOf(method) {
    const { color, dash, width } = lookOf(method);
    return {
      color,
      width,
      dash: dash.length ? dash.map((part) => `${part.toFixed(1)}px`).join(",") : "solid",
    };
  }

  /** A logarithmic axis over a range of positive numbers, with ticks at decades in given words. */
  function decades(low, high, inWords) {
    const [from, to] = [Math.log10(low), Math.log10(high)];
    const every = Math.ceil((to - from) / MOST_TICKS);
    const ticks = [];
    for (let power = Math.ceil(from / every) * every; power <= to; power += every)
      ticks.push(power);
    return {
      type: "log",
      range: [from, to],
      tickvals: ticks.map((power) => 10 ** power),
      ticktext: ticks.map((power) => plainWords(inWords(Number(`1e${power}`)))),
      gridcolor: GRID,
      linecolor: FAINT,
      showline: true,
      zeroline: false,
      tickfont: { size: 12 },
      fixedrange: false,
      minor: { showgrid: false },
    };
  }

  function powerOfTen(value) {
    const power = Math.round(Math.log10(value));
    return power === 0 ? "1" : power === 1 ? "10" : `1e${power}`;
  }

  /** A range of positive numbers, by a factor wider at both ends and never shorter than two
      decades. */
  function widened(low, high, factor) {
    const spare = Math.max(1, Math.sqrt(100 / (high / low)));
    return [low / Math.max(factor, spare), high * Math.max(factor, spare)];
  }

  // No motion of the page by its own: Plotly's drawings stand still and ask nobody for anything.
  const config = {
    displayModeBar: false,
    showTips: false,
    doubleClick: "reset",
    showLink: false,
  };
  const layout = () => ({
    font: FONT,
    paper_bgcolor: "#ffffff",
    plot_bgcolor: "#ffffff",
    showlegend: false,
    hovermode: "closest",
    hoverdistance: 16,
    dragmode: matchMedia("(pointer: coarse)").matches ? false : "zoom",
  });

  /** The room of a drawing that is drawn anew when that changes; Plotly itself keeps the first. */
  const sizeOf = ({ clientWidth, clientHeight }) => ({
    width: clientWidth,
    height: clientHeight,
  });

  qddotReport.plot = {
    INK,
    FAINT,
    GRID,
    NARROW,
    SYMBOLS,
    plainWords,
    markerOf,
    lineOf,
    decades,
    powerOfTen,
    widened,
    config,
    layout,
    sizeOf,
    seconds: words.seconds,
  };
}
