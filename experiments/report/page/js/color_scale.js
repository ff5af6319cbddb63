// Colours of distances from the reference, logarithmic: blue (1e-14), purple, orange (1).
"use strict";
{
  const { element, words } = qddotReport;
  const DECADES = 14;
  const TICKS = [-14, -10, -6, -2, 0];
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

  const channels = (color) => [1, 3, 5].map((at) => parseInt(color.slice(at, at + 2), 16));

  /** Red, green and blue from 0 to 255 at a place from 0 to 1 of the scale. */
  function colorAt(place) {
    const at = Math.min(Math.max(place, 0), 1) * (STOPS.length - 1);
    const [low, high] = [channels(STOPS[Math.floor(at)]), channels(STOPS[Math.ceil(at)])];
    return low.map((value, channel) => value + (at % 1) * (high[channel] - value));
  }

  const linear = (value) =>
    value <= 10.31475 ? value / 3294.6 : ((value / 255 + 0.055) / 1.055) ** 2.4;

  /** Red, green and blue of the 256 packed distances, as linear light, which three.js computes
      with. */
  const table = new Float32Array(256 * 3);
  for (let code = 0; code < 256; code++)
    colorAt((code - 1) / 254).forEach(
      (value, channel) => (table[3 * code + channel] = linear(value)),
    );

  /** The relative distance that a packed one stands for. */
  const distanceOf = (code) => (code === 0 ? 0 : 10 ** (((code - 1) / 254) * DECADES - DECADES));

  // Where the scale says nothing: below what is known of the reference.
  function unknownPart(known) {
    const share = (100 * (Math.log10(known) + DECADES)) / DECADES;
    const part = element("i", { class: "scale-unknown" });
    part.style.width = `${Math.min(Math.max(share, 0), 100)}%`;
    return part;
  }

  /** A bar with its numbers, and a pointer at the largest distance, which `point(code)` moves;
      `known`: the least distance that means something, or null. */
  function legend(known) {
    const bar = element("div", { class: "scale-bar" });
    bar.style.background = `linear-gradient(to right, ${STOPS.join(", ")})`;
    if (known > 0) bar.append(unknownPart(known));
    const ticks = element("div", { class: "scale-ticks" });
    for (const power of TICKS) {
      const text = power === 0 ? "1" : power === -DECADES ? `≤ 1e${power}` : `1e${power}`;
      const tick = element("span", {}, text);
      tick.style.left = `${(100 * (power + DECADES)) / DECADES}%`;
      ticks.append(tick);
    }
    const pointer = element("i");
    const sentence = element("p", { "aria-live": "off" });
    const node = element(
      "div",
      { class: "scale" },
      sentence,
      element("div", { class: "scale-now", "aria-hidden": "true" }, pointer),
      bar,
      ticks,
      known > 0
        ? element("p", {}, `Pale: below ${words.about(known)} the reference itself may be off.`)
        : null,
    );
    function point(code) {
      pointer.style.left = `${(100 * Math.max(0, code - 1)) / 254}%`;
      const far = code === 0 ? "at most 1e-14" : words.about(distanceOf(code));
      sentence.textContent = `Distance of a node from the reference, relative to the largest displacement. Largest now: ${far}`;
    }
    return { node, point };
  }

  qddotReport.distanceScale = { table, colorAt, distanceOf, legend };
}
