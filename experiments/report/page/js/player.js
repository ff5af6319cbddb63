// The clock of a motion: a slider, play and pause, real time or slower.
import { element } from "./element.js";
import { words } from "./words.js";

// In s: about how long a motion plays at first.
const PASS = 5;
const TICKS = 1000;

// Times slower or faster than real, from the fastest: 1, 2 and 5 times powers of ten.
function speeds(until) {
  const wanted = Math.log10(until / PASS);
  const nice = [];
  for (let power = -9; power <= 3; power++)
    for (const digit of [1, 2, 5]) nice.push(digit * 10 ** power);
  const off = (speed) => Math.abs(Math.log10(speed) - wanted);
  const at = nice.reduce((best, speed, i) => (off(speed) < off(nice[best]) ? i : best), 0);
  const offered = new Set([1, ...nice.slice(Math.max(0, at - 4), at + 4)]);
  return { nearest: nice[at], offered: [...offered].sort((a, b) => b - a) };
}

function speedInWords(speed) {
  if (speed === 1) return "× 1, real time";
  return speed > 1 ? `× ${words.exact(speed)}` : `× 1/${words.count(Math.round(1 / speed))}`;
}

/** The controls over the times 0 to `until`; `shown(t)` is called at each change of the time. */
export function playerOf(until, shown) {
  const { nearest, offered } = speeds(until);
  let t = 0;
  let playing = false;
  let before = null;

  const play = element("button.play", { type: "button", click: () => set(!playing) });
  const slider = element("input", {
    type: "range",
    min: 0,
    max: TICKS,
    step: 1,
    value: 0,
    "aria-label": "Time of the motion",
    input: () => {
      set(false);
      go((Number(slider.value) / TICKS) * until);
    },
  });
  const output = element("output");
  const speed = element(
    "select",
    { "aria-label": "Speed" },
    offered.map((one) =>
      element("option", { value: one, selected: one === nearest }, speedInWords(one)),
    ),
  );

  function go(time) {
    t = Math.min(Math.max(time, 0), until);
    slider.value = Math.round((TICKS * t) / until);
    const now = `t = ${words.seconds(t)}`;
    output.textContent = now;
    slider.setAttribute("aria-valuetext", now);
    shown(t);
  }

  function tick(now) {
    if (!playing) return;
    if (before !== null) go(t + ((now - before) / 1000) * Number(speed.value));
    before = now;
    if (t >= until) set(false);
    else requestAnimationFrame(tick);
  }

  function set(on) {
    if (on && t >= until) go(0);
    playing = on;
    play.textContent = on ? "❚❚ Pause" : "▶ Play";
    play.setAttribute("aria-pressed", String(on));
    before = null;
    if (on) requestAnimationFrame(tick);
  }

  set(false);
  const node = element("div.player", play, slider, output, speed);
  return { node, go, pause: () => set(false) };
}
