// The front: the least cost at which any run reaches an accuracy.
"use strict";
{
  const { report, isDrawn } = qddotReport;
  const { points } = report;

  /** The runs on the front of a quantity over an ordinate, from the least error to the largest. */
  qddotReport.front = (quantity, ordinate, floor) => {
    const errors = points[quantity.column];
    const stands = (point) => Math.max(errors[point], floor);
    const candidates = points.method
      .map((_, point) => point)
      .filter(
        (point) => isDrawn(point, quantity.column, ordinate) && quantity.counts?.[point] !== false,
      )
      .sort((a, b) => stands(a) - stands(b) || points[ordinate][a] - points[ordinate][b]);
    const front = [];
    let least = Infinity;
    for (const point of candidates) {
      if (points[ordinate][point] >= least) continue;
      least = points[ordinate][point];
      front.push(point);
    }
    return front;
  };
}
