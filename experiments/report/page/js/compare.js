// The runs that the reader compares with the chosen one, and the colours of all motions in one
// drawing.
import { button, byId, element, options } from "./element.js";
import { choose, keptMotion, keptRuns, onChoice, report, state } from "./report.js";

/** The colours of the reference and of the chosen run where several motions are in one drawing. */
export const REFERENCE = "#b5b5b0";
export const CHOSEN = "#222222";
// None of them is the colour of a kind of energy.
const OTHERS = ["#009E73", "#CC3399", "#56B4E9", "#E69F00"];

/** The reference's motion, or null. */
export const reference = report.motion?.runs.find((run) => run.role === "reference") ?? null;

/** The kept motions of the runs that the chosen one is compared with, as {run, color}. */
export const comparedMotions = () =>
  state.compared
    .map((point, at) => ({ run: keptMotion(point), color: OTHERS[at] }))
    .filter(({ run }) => run && run.point !== state.run);

/** All that belong into one drawing, as {run, color}, the reference first and the chosen run
    last, so that it is on top. */
export function shownMotions() {
  const chosen = keptMotion(state.run);
  return [
    reference && reference !== chosen && { run: reference, color: REFERENCE },
    ...comparedMotions(),
    chosen && { run: chosen, color: CHOSEN },
  ].filter(Boolean);
}

const menu = byId("compare-menu");
const together = byId("together");

function leave(point) {
  choose({ compared: state.compared.filter((other) => other !== point) });
}

/** A short line in a colour, as a key. */
export const keySign = (color) =>
  element("span", { "aria-hidden": "true", style: `color: ${color}` }, "━ ");

function update() {
  const offered = keptRuns.filter(
    ({ point }) => point !== state.run && !state.compared.includes(point),
  );
  menu.replaceChildren(
    element("option", { value: "" }, "another run"),
    ...options(offered.map(({ point, label, why }) => [point, why ? `${label}: ${why}` : label])),
  );
  menu.disabled = state.compared.length === OTHERS.length;
  together.checked = state.together;
  byId("compared").replaceChildren(
    ...comparedMotions().map(({ run, color }) =>
      button([keySign(color), `${run.label} ✕`], () => leave(run.point), {
        "aria-label": `Compare with ${run.label} no more`,
      }),
    ),
  );
}

menu.addEventListener("change", () =>
  choose({ compared: [...state.compared, Number(menu.value)].slice(0, OTHERS.length) }),
);
together.addEventListener("change", () => choose({ together: together.checked }));
byId("compare").hidden = keptRuns.length < 2;
onChoice(update);
update();
