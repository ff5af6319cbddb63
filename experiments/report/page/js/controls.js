// The clock of a motion, with a slider, play and pause; and the colours of distances from the
// reference, logarithmic: blue (1e-14), purple, orange (1).
import { byId, options } from "./element.js";
import { words } from "./words.js";

// In s: about how long a motion plays at first.
const PASS = 5;
const SLIDER_STEPS = 1000;

// Times slower or faster than real, from the fastest: 1, 2 and 5 times powers of ten.
function speeds(until) {
  const wanted = Math.log10(until / PASS);
  const nice = [];
  for (let power = -9; power <= 3; power++)
    for (const digit of [1, 2, 5]) nice.push(digit * 10 ** power);
  const off = (speed) => Math.abs(Math.log10(speed) - wanted);
  const at = nice.map(off).indexOf(Math.min(...nice.map(off)));
  const offered = new Set([1, ...nice.slice(Math.max(0, at - 4), at + 4)]);
  return { nearest: nice[at], offered: [...offered].sort((a, b) => b - a) };
}

function speedInWords(speed) {
  if (speed === 1) return "× 1, real time";
  return speed > 1 ? `× ${words.exact(speed)}` : `× 1/${words.count(Math.round(1 / speed))}`;
}

export const player = byId("player");
const [play, slider, output, speed] = player.children;
let until = 1;
let shown = null;
let t = 0;
let playing = false;
let before = null;

/** Lets the player go through the times 0 to `end`, and calls `show(t)` at each change of it. */
export function startPlayer(end, show) {
  const { nearest, offered } = speeds(end);
  [until, shown, t] = [end, show, 0];
  speed.replaceChildren(...options(offered.map((one) => [one, speedInWords(one)])));
  speed.value = nearest;
  setPlaying(false);
}

/** Shows the motion at a time. */
export function goTo(time) {
  t = Math.min(Math.max(time, 0), until);
  slider.value = Math.round((SLIDER_STEPS * t) / until);
  const now = `t = ${words.seconds(t)}`;
  output.textContent = now;
  slider.setAttribute("aria-valuetext", now);
  shown(t);
}

function tick(now) {
  if (!playing) return;
  if (before !== null) goTo(t + ((now - before) / 1000) * Number(speed.value));
  before = now;
  if (t >= until) setPlaying(false);
  else requestAnimationFrame(tick);
}

/** Plays the motion on, or pauses it. */
export function setPlaying(on) {
  if (on && t >= until) goTo(0);
  playing = on;
  play.textContent = on ? "❚❚ Pause" : "▶ Play";
  play.setAttribute("aria-pressed", String(on));
  before = null;
  if (on) requestAnimationFrame(tick);
}

play.addEventListener("click", () => setPlaying(!playing));
slider.addEventListener("input", () => {
  setPlaying(false);
  goTo((Number(slider.value) / SLIDER_STEPS) * until);
});

const DECADES = 14;
// All about as light as each other, so that a face's shade stays to be seen, and none pale on
// white.
const STOPS = [
  "#4a86bd",
  "#5573bf",
  "#6b60ba",
  "#8650ac",
  "#a34598",
  "#c0427c",
  "#d84f58",
  "#e86a35",
  "#f29111",
];

const percent = (power) => `${Math.min(Math.max((100 * (power + DECADES)) / DECADES, 0), 100)}%`;

// The power of ten that a packed distance stands for.
const powerOf = (code) => ((code - 1) / 254) * DECADES - DECADES;

/** The colours of the 256 packed distances, red, green and blue as linear light. */
export function colorTable() {
  const stops = STOPS.map((stop) => new THREE.Color(stop).convertLinearToSRGB());
  const table = new Float32Array(3 * 256);
  for (let code = 0; code < 256; code++) {
    const at = (Math.max(code - 1, 0) / 254) * (STOPS.length - 1);
    const [low, high] = [stops[Math.floor(at)], stops[Math.ceil(at)]];
    low
      .clone()
      .lerp(high, at % 1)
      .convertSRGBToLinear()
      .toArray(table, 3 * code);
  }
  return table;
}

/** A bar of the colours with its numbers. */
export const scale = byId("scale");
const [sentence, now, bar, , pale] = scale.children;
bar.style.background = `linear-gradient(to right, ${STOPS.join(", ")})`;

/** Makes distances pale below `known`, the least that means something; none if it is null or 0. */
export function markUnknown(known) {
  const unknown = bar.firstElementChild;
  unknown.hidden = pale.hidden = !(known > 0);
  unknown.style.width = percent(Math.log10(known));
  pale.textContent = `Pale: below ${words.about(known)} the reference itself may be off.`;
}

/** Moves the pointer to the largest packed distance. */
export function pointAt(code) {
  now.firstElementChild.style.left = percent(powerOf(code));
  const far = code === 0 ? "at most 1e-14" : words.about(10 ** powerOf(code));
  sentence.textContent = `Distance of a node from the reference, relative to the largest displacement. Largest now: ${far}`;
}
