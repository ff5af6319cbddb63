// The words beside the pointer: a run's name, errors, cost and counts.
"use strict";
{
  const { element, byId, report, words, named, state, visit } = qddotReport;
  const { points, methods } = report;
  const MOST_COUNTS = 5;

  function pairs(point) {
    const quantity = report.quantities.find((one) => one.column === state.column);
    const rows = [];
    if (quantity) rows.push([quantity.axis, words.number(points[quantity.column]?.[point])]);
    rows.push(["time of a run", words.seconds(points.time_s[point])]);
    const counted = report.counts
      .filter((column) => points[column]?.[point] > 0)
      .slice(0, MOST_COUNTS);
    for (const column of counted)
      rows.push([words.plain(column), words.count(points[column][point])]);
    return rows;
  }

  function content(point) {
    const list = element("dl");
    for (const [label, value] of pairs(point))
      list.append(element("dt", {}, label), element("dd", {}, value));
    const failed = points.outcome[point] !== "reached_end" || points.cause[point];
    return [
      element(
        "p",
        {},
        element("b", {}, named(points.method[point])),
        ` at ${words.knob(points.knob[point], points.value[point])}`,
      ),
      methods[points.method[point]].line &&
        element("p", { class: "quiet" }, methods[points.method[point]].line),
      failed && element("p", { class: "bad" }, qddotReport.whyNot(point, state.column)),
      list,
    ].filter(Boolean);
  }

  /** Shows the run beside a place of the window in px. */
  qddotReport.showTooltip = (point, x, y) => {
    const box = byId("tooltip");
    box.replaceChildren(...content(point));
    box.dataset.point = point;
    box.hidden = false;
    const { width, height } = box.getBoundingClientRect();
    const left = x + 16 + width > innerWidth ? x - 16 - width : x + 16;
    const top = y + 16 + height > innerHeight ? y - 16 - height : y + 16;
    box.style.transform = `translate(${Math.max(8, Math.min(left, innerWidth - width - 8))}px, ${Math.max(8, top)}px)`;
  };

  qddotReport.hideTooltip = () => {
    byId("tooltip").hidden = true;
  };

  /** Lets the marks of one of Plotly's drawings show their run on hover and choose it on a click. */
  qddotReport.listenToMarks = (drawing) => {
    const pointOf = (event) =>
      event.points?.map((mark) => mark.customdata).find((point) => typeof point === "number");
    drawing.on("plotly_hover", (event) => {
      const point = pointOf(event);
      if (point !== undefined)
        qddotReport.showTooltip(point, event.event.clientX, event.event.clientY);
    });
    drawing.on("plotly_unhover", qddotReport.hideTooltip);
    drawing.on("plotly_click", (event) => {
      const point = pointOf(event);
      if (point !== undefined) visit({ run: point });
    });
  };
}
