// Names beside the lines of the chart, where they hide neither each other nor the ends of lines.
"use strict";
{
  const { report } = qddotReport;
  const CHARACTER = 6.7;
  const HEIGHT = 15;
  const AWAY = 9;
  const SIDES = [
    [1, -1],
    [-1, 1],
    [1, 1],
    [-1, -1],
    [1, 0],
    [-1, 0],
  ];

  function box(x, y, side, width) {
    const left = side[0] > 0 ? x + AWAY : x - AWAY - width;
    const top = y - HEIGHT / 2 + side[1] * (AWAY + (side[1] ? 3 : 0));
    return { left, top, right: left + width, bottom: top + HEIGHT };
  }

  const overlap = (a, b) =>
    a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
  const holds = (a, mark) =>
    mark.x > a.left - 3 && mark.x < a.right + 3 && mark.y > a.top - 3 && mark.y < a.bottom + 3;

  /** Labels of methods as {method, x, y, right, up} in px; `lines` is a list of {method, places},
      the most important first; `size` is the plot's in px, and `size.left` where its names may
      begin. A method for which there is no room gets none. */
  qddotReport.placeLabels = (lines, size) => {
    const marks = lines.flatMap((line) => line.places);
    const taken = [];
    const labels = [];
    for (const { method, places } of lines) {
      const width = report.methods[method].name.length * CHARACTER;
      let best = null;
      // The ends of a line belong to it most plainly; then its middle.
      const order = [...places.keys()].sort(
        (a, b) => Math.min(a, places.length - 1 - a) - Math.min(b, places.length - 1 - b),
      );
      for (const index of order) {
        const { x, y } = places[index];
        for (const side of SIDES) {
          const room = box(x, y, side, width);
          if (
            room.left < size.left ||
            room.right > size.width ||
            room.top < 0 ||
            room.bottom > size.height
          )
            continue;
          if (taken.some((other) => overlap(room, other))) continue;
          const hidden = marks.filter((mark) => holds(room, mark)).length;
          const cost = hidden + Math.min(index, places.length - 1 - index) * 0.3;
          if (!best || cost < best.cost) best = { cost, room, place: places[index], side };
        }
      }
      if (!best || best.cost > 4) continue;
      taken.push(best.room);
      labels.push({ method, point: best.place.point, side: best.side });
    }
    return labels;
  };
}
