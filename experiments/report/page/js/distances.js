// Colours of distances from the reference, logarithmic: blue (1e-14), purple, orange (1).
import { element } from "./element.js";
import { words } from "./words.js";

const DECADES = 14;
const TICKS = [
  [-14, "≤ 1e-14"],
  [-10, "1e-10"],
  [-6, "1e-6"],
  [-2, "1e-2"],
  [0, "1"],
];
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

/** A bar with its numbers, and a pointer at the largest distance, which `point(code)` moves;
    `known`: the least distance that means something, or null. */
export function distanceScale(known) {
  const bar = element("div.scale-bar");
  bar.style.background = `linear-gradient(to right, ${STOPS.join(", ")})`;
  if (known > 0) {
    const pale = element("i.scale-unknown");
    pale.style.width = percent(Math.log10(known));
    bar.append(pale);
  }
  const ticks = TICKS.map(([power, text]) => {
    const tick = element("span", text);
    tick.style.left = percent(power);
    return tick;
  });
  const pointer = element("i");
  const sentence = element("p", { "aria-live": "off" });
  const node = element(
    "div.scale",
    sentence,
    element("div.scale-now", { "aria-hidden": "true" }, pointer),
    bar,
    element("div.scale-ticks", ticks),
    known > 0 && element("p", `Pale: below ${words.about(known)} the reference itself may be off.`),
  );
  function point(code) {
    pointer.style.left = percent(powerOf(code));
    const far = code === 0 ? "at most 1e-14" : words.about(10 ** powerOf(code));
    sentence.textContent = `Distance of a node from the reference, relative to the largest displacement. Largest now: ${far}`;
  }
  return { node, point };
}
