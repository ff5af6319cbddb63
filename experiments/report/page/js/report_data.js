// What the page is made from, read once: the JSON that the packer wrote.
"use strict";
{
  const report = JSON.parse(qddotReport.byId("report").textContent);
  const { points, methods } = report;

  // Errors above this are another motion: as the pictures of the experiments have it.
  const MOST_ERROR = 3;

  const runsOf = methods.map(() => []);
  points.method.forEach((method, point) => runsOf[method].push(point));
  for (const runs of runsOf) runs.sort((a, b) => points.value[b] - points.value[a]);

  /** Whether a run is a mark among the errors of a quantity over an ordinate. */
  function isDrawn(point, column, ordinate) {
    const error = points[column]?.[point];
    return (
      points.outcome[point] === "reached_end" &&
      typeof error === "number" &&
      error <= MOST_ERROR &&
      points[ordinate]?.[point] > 0
    );
  }

  /** Why a run is no such mark: its own cause, or what its error has to do with it. */
  function whyNot(point, column) {
    if (points.cause[point]) return points.cause[point];
    if (points.outcome[point] !== "reached_end")
      return qddotReport.words.plain(points.outcome[point]);
    const error = points[column]?.[point];
    return error > MOST_ERROR ? `error above ${MOST_ERROR}` : "no such number";
  }

  /** How a method is drawn: its colour and mark, and its family's line; dashes in px. */
  function lookOf(method) {
    const { color, marker, family } = methods[method];
    const { dash, filled, width } = report.families[family];
    return { color, marker, dash, filled, width };
  }

  /** A run in words: "verlet at h = 0.0005 s". */
  const runName = (point) =>
    `${methods[points.method[point]].name} at ${qddotReport.words.knob(points.knob[point], points.value[point])}`;

  Object.assign(qddotReport, { report, runsOf, isDrawn, whyNot, lookOf, runName, MOST_ERROR });
}
