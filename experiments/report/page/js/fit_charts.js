// Draws charts again where their room changes: in another window, on a turned screen, on paper.
"use strict";
{
  const { byId } = qddotReport;
  const STILL_MS = 150;

  function drawCharts() {
    qddotReport.drawChart();
    qddotReport.drawFailures();
    qddotReport.drawEnergies();
  }

  /** From now on charts follow the width that they have. */
  qddotReport.fitCharts = () => {
    const drawing = byId("chart-drawing");
    const size = () => `${drawing.clientWidth} ${drawing.clientHeight}`;
    let drawn = size();
    let waiting = 0;
    const drawIfChanged = () => {
      if (size() === drawn || !drawing.clientWidth) return;
      drawCharts();
      drawn = size();
    };
    new ResizeObserver(() => {
      clearTimeout(waiting);
      waiting = setTimeout(drawIfChanged, STILL_MS);
    }).observe(drawing);

    const printing = (on) => {
      document.documentElement.classList.toggle("printing", on);
      drawCharts();
      qddotReport.printMotion(on);
      drawn = size();
    };
    addEventListener("beforeprint", () => printing(true));
    addEventListener("afterprint", () => printing(false));
  };
}
