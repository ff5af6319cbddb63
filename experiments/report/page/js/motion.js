// The motion of the chosen run beside the reference's, and the words on it.
import { reference, shownMotions, keySign } from "./compare.js";
import {
  colorTable,
  goTo,
  markUnknown,
  player,
  pointAt,
  scale,
  setPlaying,
  startPlayer,
} from "./controls.js";
import { button, byId, commandLine, element, options } from "./element.js";
import {
  boundsOf,
  canUnpack,
  frameAt,
  metres,
  nodeLists,
  positionsAt,
  unpacked,
  wholeSprings,
} from "./frames.js";
import { choose, keptMotion, keptRuns, points, report, state, visit } from "./report.js";
import { bodyOf, stageOf } from "./stage.js";
import { words } from "./words.js";

const { motion } = report;
const section = byId("motion");
// The reference in grey: dark lines, lighter faces, on which shade is seen.
const NEUTRAL = motion?.faces ? [0.24, 0.25, 0.27] : [0.07, 0.075, 0.085];
// The height at which the largest displacement of a line of nodes is drawn, by its length.
const LIFT = 0.2;
const FEWEST_LIFTED = 8;
// A packed relative distance of 0.3.
const FAR = 246;
// The number of frames that the command for a run without a motion makes.
const FRAMES = 100;
const ROUNDING = 1e-6;
const MOST_BUTTONS = 6;

const sentence = (text) => element("p.quiet", text);
const lost = byId("motion-lost");
const controls = byId("motion-controls");

let stage = null;
// The parts {run, body, view} that are drawn, with their bounds and how a line is lifted. In one view
// each has a color of its own.
let scene = null;
let turn = 0;

// The runs whose motion was kept: the most telling as buttons, all of many in a menu.
function keptMotions() {
  if (!keptRuns.length) return null;
  const buttonOf = ({ point, label, why }) =>
    button(label, () => visit({ run: point }), {
      "aria-pressed": String(point === state.run),
      title: why,
    });
  const menu = element(
    "select",
    {
      "aria-label": "All runs whose motion was kept",
      change: () => choose({ run: Number(menu.value) }),
    },
    element("option", { value: "", disabled: true }, `all ${keptRuns.length}`),
    options(keptRuns.map(({ point, label, why }) => [point, why ? `${label}: ${why}` : label])),
  );
  menu.value = keptRuns.some(({ point }) => point === state.run) ? state.run : "";
  return element(
    "div.kept",
    { role: "group", "aria-label": "Runs whose motion was kept" },
    "Kept motions:",
    keptRuns.slice(0, MOST_BUTTONS).map(buttonOf),
    keptRuns.length > MOST_BUTTONS && menu,
  );
}

// Words in the place of the motion of a run that has none, with the command that makes it.
function withoutMotion() {
  const command = points.command[state.run];
  if (!command || !report.until) return sentence("No motion of this run was kept.");
  const apart = report.until / FRAMES;
  // Frames nearer to each other than its steps would have the run take other steps.
  const hasSteps = points.knob[state.run] === "step_size";
  const every = hasSteps ? Math.max(apart, points.value[state.run]) : apart;
  return element(
    "div",
    sentence("No motion of this run was kept. This command writes it for ParaView:"),
    commandLine(`${command} --motion motion.vtkhdf --every ${every}`),
  );
}

// Whether the kept frames of a run end before its motion does.
const endsEarly = ({ t_reached: end, times }) =>
  end !== null && times.at(-1) < (1 - ROUNDING) * end;

function stopWords(run) {
  if (run.outcome !== "reached_end") {
    const why = run.point === null ? null : points.cause[run.point];
    return `stopped at t = ${words.seconds(run.t_reached)}: ${why ?? words.plain(run.outcome)}`;
  }
  if (!endsEarly(run)) return null;
  return `its numbers grow beyond what is kept from t = ${words.seconds(run.times.at(-1))} on`;
}

// A run in words, in a view of its own.
function wordsOf(run) {
  const isReference = run.role === "reference";
  const stop = stopWords(run);
  const notes = [
    !isReference &&
      points.knob[run.point] === "rtol" &&
      "its steps end at the frames, so it is not quite the chart's run",
    run.left_box && "parts of it leave what is kept",
  ];
  return [
    element("b", run.label),
    isReference ? ["stands for the reference", run.why].filter(Boolean).join(": ") : run.why,
    stop && element("div", element("span.view-stop", stop)),
    notes.filter(Boolean).map((text) => element("div.quiet", text)),
  ];
}

// The same among others in one view, which they must not hide.
function shortWordsOf({ run, color }) {
  const isWhole = run.outcome === "reached_end";
  const stop = isWhole ? stopWords(run) : `stopped at t = ${words.seconds(run.t_reached)}`;
  const name = run.role === "reference" ? `${run.label}, for the reference` : run.label;
  return element("div", keySign(color), name, stop && [" ", element("span.view-stop", stop)]);
}

const viewWith = (...words) => element("div.view", element("div.view-words", words));

// The ways to move the view, and the meaning of the drawing.
function explanation(lift) {
  const move =
    motion.dimension < 3 ? "Drag to move" : "Drag to turn, with the right button to move";
  const notes = [
    ...motion.notes,
    "Dark squares are pinned nodes. Between kept frames nodes move straight.",
  ];
  if (lift)
    notes.push(
      `Nodes move along the line; their displacement is drawn ${motion.up ? "sideways" : "upwards"} as well, ${words.ratio(lift.factor)} as large.`,
    );
  return [
    sentence(`${move}; pinch, or click and turn the wheel, to zoom.`),
    sentence(notes.join(" ")),
  ];
}

// A line of nodes moves along itself: its displacements are drawn upwards, or nobody would see
// them. Widens the bounds for that.
function liftOf({ low, high }) {
  if (motion.dimension !== 1 || motion.nodes < FEWEST_LIFTED || !(motion.distance_unit > 0))
    return null;
  const extents = high.map((end, axis) => end - low[axis]);
  const along = extents.indexOf(Math.max(...extents));
  const up = along === 2 ? 0 : 2;
  const reach = LIFT * extents[along];
  const middle = (low[up] + high[up]) / 2;
  [low[up], high[up]] = [middle - 1.2 * reach, middle + 1.2 * reach];
  return { along, up, middle, factor: reach / motion.distance_unit };
}

function place(run, { positions }, t) {
  positionsAt(run, t, positions);
  if (!scene.lift) return;
  const { along, up, middle, factor } = scene.lift;
  for (let i = 0; i < positions.length; i += 3) {
    const start = metres(run.places[i + along], along);
    positions[i + up] = middle + factor * (positions[i + along] - start);
  }
}

// Colours the nodes by their distances, or all the same in one view; returns the largest packed
// distance, null where none is shown.
function paint(run, { colors }, t, color) {
  if (color || !run.distances) {
    const same = color ? new THREE.Color(color).toArray() : NEUTRAL;
    colors.forEach((_, i) => (colors[i] = same[i % 3]));
    return null;
  }
  const first = frameAt(run, t) * motion.nodes;
  const codes = run.distances.subarray(first, first + motion.nodes);
  codes.forEach((code, node) => colors.set(scene.table.subarray(3 * code, 3 * code + 3), 3 * node));
  return codes.reduce((a, b) => Math.max(a, b), 0);
}

function show(t) {
  if (!scene) return;
  for (const { run, body, view, color } of scene.parts) {
    place(run, body, t);
    const largest = paint(run, body, t, color);
    // The chosen run is the last.
    if (largest !== null && run === scene.parts.at(-1).run) pointAt(largest);
    body.update(wholeSprings(run, scene.springs, t));
    if (color) continue;
    const isOver = t > run.times.at(-1) && (run.outcome !== "reached_end" || endsEarly(run));
    view.style.background = isOver ? "#fbe9e5" : "";
  }
  stage.draw();
}

byId("closer").addEventListener("click", () => stage.zoom(1.25));
byId("farther").addEventListener("click", () => stage.zoom(0.8));
byId("reset").addEventListener("click", () => scene && stage.look(scene.bounds));
// The controls come back with a motion.
section.replaceChildren();

// Errors of the chart are those at the end. A run that blows up shows most while it is still in
// the view: while its error is about as large as the motion.
function openingTime(run, until) {
  if (run.outcome === "reached_end" || !run.distances) return until;
  const far = run.distances.findIndex((code) => code >= FAR);
  return far < 0 ? run.times.at(-1) : run.times[Math.floor(far / motion.nodes)];
}

/** Draws the motion of the chosen run, or says why there is none. */
export async function drawMotion() {
  const mine = ++turn;
  setPlaying(false);
  scene = null;
  const heading = element("h3", reference ? "Its motion beside the reference" : "Its motion");
  const say = (...nodes) => section.replaceChildren(heading, ...nodes.flat().filter(Boolean));
  if (!motion?.runs.length) return say(sentence("No motions were kept."), withoutMotion());
  if (!canUnpack())
    return say(sentence("This browser cannot unpack the motions: it lacks DecompressionStream."));
  const chosen = keptMotion(state.run);
  const shown = shownMotions();
  const runs = shown.map(({ run }) => run);
  const above = [keptMotions(), !chosen && withoutMotion()];
  if (!runs.length) return say(above);

  const isFirst = stage === null;
  try {
    stage ??= stageOf(motion, (gone) => (lost.hidden = !gone));
  } catch {
    const why = "This browser draws no WebGL, which the motion is drawn with";
    return say(above, sentence(`${why}; all else on this page works without.`));
  }
  let frames, springs, faces;
  try {
    frames = await Promise.all(runs.map(unpacked));
    [springs, faces] = await Promise.all([motion.springs, motion.faces].map(nodeLists));
  } catch {
    if (mine !== turn) return;
    return say(above, sentence("The motion cannot be unpacked: this file is damaged."));
  }
  if (mine !== turn) return;

  const { together } = state;
  const views = together
    ? [viewWith(shown.map(shortWordsOf))]
    : runs.map((run) => viewWith(wordsOf(run)));
  const bodies = runs.map(() => bodyOf({ ...motion, springs, faces }));
  const bounds = boundsOf(frames[0]);
  const lift = liftOf(bounds);
  const hasDistances = !together && frames.some((run) => run.distances);
  markUnknown(motion.known_to);
  const parts = frames.map((run, at) => ({
    run,
    body: bodies[at],
    view: views[together ? 0 : at],
    color: together ? shown[at].color : null,
  }));
  scene = { parts, lift, bounds, springs, table: colorTable() };
  const until = Math.max(...frames.map((run) => run.times.at(-1)));
  // A single frame has no time to go through.
  player.remove();
  if (until > 0) {
    startPlayer(until, show);
    controls.prepend(player);
  }
  const holder = element(views.length > 1 ? "div.views" : "div.views.alone", views);
  say(above, holder, lost, controls, hasDistances && scale, explanation(lift));
  const names = runs.map(({ label }) => label).join(" and ");
  stage.canvas.setAttribute("aria-label", `Motion of ${names}`);
  stage.show(holder, views, together ? [bodies] : bodies.map((body) => [body]));
  // The reader's own view stays from run to run.
  if (isFirst || !reference) stage.look(bounds);
  (until > 0 ? goTo : show)(openingTime(frames.at(-1), until));
  section.dataset.ready = state.run;
}

/** Makes the motion ready for paper, or for the screen again. */
export const printMotion = (onPaper) => scene && stage.still(onPaper);
