// Draws the page below the answers, once the libraries are there, and again what a choice changes.
"use strict";
{
  const { element, byId, report, words, state, choose, ordinates, onChoice } = qddotReport;

  function menu(id, choices, key) {
    const select = byId(id);
    select.append(...choices.map(([value, text]) => element("option", { value }, text)));
    select.value = state[key];
    select.addEventListener("change", () => choose({ [key]: select.value }));
    onChoice(() => (select.value = state[key]));
  }

  function drawAll() {
    menu(
      "quantity",
      report.quantities.map(({ column, name }) => [column, name]),
      "column",
    );
    menu(
      "ordinate",
      ordinates.map((column) => [column, column === "time_s" ? "time" : words.plain(column)]),
      "ordinate",
    );
    for (const id of ["chart", "run"]) byId(id).hidden = report.points.method.length === 0;
    qddotReport.drawLegend();
    qddotReport.drawChart();
    qddotReport.drawFailures();
    byId("cloud").addEventListener("change", qddotReport.drawChart);
    byId("whole").addEventListener("click", qddotReport.showWholeChart);
    qddotReport.drawRunChoice();
    drawRun();
    qddotReport.drawBackground();
    qddotReport.fitCharts();
    addEventListener("scroll", qddotReport.hideTooltip, { passive: true });
    document.documentElement.dataset.drawn = "yes";
  }

  function drawRun() {
    if (!report.points.method.length) return;
    qddotReport.drawRun();
    qddotReport.drawEnergies();
    qddotReport.drawMotion();
  }

  onChoice((changed) => {
    if (changed.includes("column") || changed.includes("ordinate")) {
      qddotReport.drawChart();
    } else {
      qddotReport.moveRing();
    }
    qddotReport.drawFailures();
    if (changed.includes("run")) drawRun();
  });

  // The answers come to the screen first: the rest waits for the frame after.
  requestAnimationFrame(() => setTimeout(drawAll));
}
