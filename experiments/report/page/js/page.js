// Draws the page below the answers, and again where a choice or the room changes.
import "./background.js";
import { drawChart, moveRing } from "./chart.js";
import { byId, options } from "./element.js";
import { drawEnergies } from "./energies.js";
import { drawFailures } from "./failures.js";
import "./legend.js";
import { drawMotion, printMotion } from "./motion.js";
import { drawPhase } from "./phase.js";
import { allRuns, choose, isStudy, onChoice, ordinates, report, state } from "./report.js";
import { drawRun } from "./run.js";
import { words } from "./words.js";

const STILL_MS = 150;

function menu(id, choices, key) {
  const select = byId(id);
  select.append(...options(choices));
  select.addEventListener("change", () => choose({ [key]: select.value }));
  const update = () => (select.value = state[key]);
  update();
  onChoice(update);
}

function drawCharts() {
  drawChart();
  drawFailures();
  drawEnergies();
  drawPhase();
}

// Charts follow the width that they have: in another window, on a turned screen, on paper.
function fitCharts() {
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
    printMotion(on);
    drawn = size();
  };
  addEventListener("beforeprint", () => printing(true));
  addEventListener("afterprint", () => printing(false));
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
  byId("chart").hidden = !isStudy || allRuns.length === 0;
  byId("run").hidden = allRuns.length === 0;
  if (allRuns.length) {
    drawRun();
    drawCharts();
    drawMotion();
    fitCharts();
  }
  document.documentElement.dataset.drawn = "yes";
}

onChoice((changed) => {
  const has = (...keys) => keys.some((key) => changed.includes(key));
  if (has("column", "ordinate", "shown")) drawChart();
  else moveRing();
  drawFailures();
  if (has("run", "column")) drawRun();
  if (has("run", "compared")) {
    drawEnergies();
    drawPhase();
  }
  if (has("run", "compared", "together")) drawMotion();
});

// The answers come to the screen first: the rest waits for the frame after.
requestAnimationFrame(() => setTimeout(drawAll));
