// The report's data, which the packer wrote as JSON.
import { byId } from "./element.js";
import { words } from "./words.js";

export const report = JSON.parse(byId("report").textContent);
export const points = report.points;
export const methods = report.methods;

/** All runs, as places in the columns of `points`. */
export const allRuns = [...points.method.keys()];

/** The runs of each method, from the largest knob to the least. */
export const runsOf = methods.map((_, method) =>
  allRuns
    .filter((point) => points.method[point] === method)
    .sort((a, b) => points.value[b] - points.value[a]),
);

/** The families that have methods, as {title, members}. */
export const familiesWithMethods = report.families
  .map(({ title }, family) => ({
    title,
    members: [...methods.keys()].filter((method) => methods[method].family === family),
  }))
  .filter(({ members }) => members.length);

// Errors above this are another motion: as the pictures of the experiments have it.
const MOST_ERROR = 3;

/** Whether a number was measured. */
export const isKnown = (value) => typeof value === "number";

/** Whether a run is a mark among the errors of a quantity over an ordinate. */
export const isDrawn = (point, column, ordinate) =>
  points.outcome[point] === "reached_end" &&
  isKnown(points[column]?.[point]) &&
  points[column][point] <= MOST_ERROR &&
  points[ordinate]?.[point] > 0;

/** Why a run is no such mark, in words; null where its error or cost was not measured. */
export function whyNot(point, column) {
  if (points.outcome[point] !== "reached_end") return words.plain(points.outcome[point]);
  if (points.cause[point]) return points.cause[point];
  return points[column]?.[point] > MOST_ERROR ? `error above ${MOST_ERROR}` : null;
}

/** The knob of a run with its value: "h = 0.0005 s". */
export const knobOf = (point) => words.knob(points.knob[point], points.value[point]);

const motions = report.motion?.runs ?? [];

/** The motions that were kept of runs, the most telling first. */
export const keptRuns = motions.filter((run) => run.role === "run" && run.point !== null);

/** The kept motion of a point, or null: where the point stands for the reference too, the one
    that was compared with it. */
export function keptMotion(point) {
  const kept = motions.filter((run) => run.point === point);
  return kept.find((run) => run.role === "run") ?? kept[0] ?? null;
}

/** The counts of a run that are not zero, as pairs of words. */
export const countsOf = (point) =>
  report.counts
    .filter((column) => points[column]?.[point] > 0)
    .map((column) => [words.plain(column), words.count(points[column][point])]);
