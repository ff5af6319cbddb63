// Where the runs that gave no point stand: a row for each way to fail, and in a row those at about
// the same knob under each other.
"use strict";
{
  const { report, words, state, isDrawn, whyNot } = qddotReport;
  const { points } = report;
  // Marks in px: how far apart they are, in a row that is no higher than this.
  const PITCH = 9;
  const HIGHEST = 150;
  const SPARE = 20;
  const BINS_A_DECADE = 12;

  /** The failed runs of the present choice by the way they failed. */
  function failures() {
    const kinds = new Map();
    points.method.forEach((_, point) => {
      if (isDrawn(point, state.column, state.ordinate)) return;
      const ended = points.outcome[point] === "reached_end";
      const kind = ended ? whyNot(point, state.column) : words.plain(points.outcome[point]);
      if (kind !== "no such number") kinds.set(kind, [...(kinds.get(kind) ?? []), point]);
    });
    return kinds;
  }

  function levelsOf(runs) {
    const filled = new Map();
    return runs.map((point) => {
      const bin = `${points.knob[point]} ${Math.round(BINS_A_DECADE * Math.log10(points.value[point]))}`;
      const level = filled.get(bin) ?? 0;
      filled.set(bin, level + 1);
      return level;
    });
  }

  /** Rows as {kind, runs, ys, top, bottom} and their height, in px from the top. */
  qddotReport.failureRows = () => {
    let top = 0;
    const rows = [...failures()].map(([kind, runs]) => {
      const levels = levelsOf(runs);
      const most = levels.reduce((a, b) => Math.max(a, b), 0);
      const pitch = Math.min(PITCH, HIGHEST / Math.max(most, 1));
      const ys = levels.map((level) => top + SPARE / 2 + 4 + pitch * level);
      const row = { kind, runs, ys, top, bottom: top + SPARE + 8 + pitch * most };
      top = row.bottom;
      return row;
    });
    return { rows, height: top };
  };
}
