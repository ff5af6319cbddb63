// Numbers in words, as the pictures of the experiments write them.

/** Whether a number was measured. */
export const isKnown = Number.isFinite;

/** A number in few characters: 2e-3, 0.5, 3.3e-14; a dash where it is unknown. */
function number(value) {
  if (!isKnown(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 0.1 && size < 1000) return String(Number(value.toPrecision(3)));
  return value.toExponential(1).replace(".0e", "e").replace("e+", "e");
}

/** A number that is known to about one digit: "about 6e-3". */
function about(value) {
  if (!isKnown(value) || value === 0) return number(value);
  const rough = Number(value.toPrecision(1));
  return `about ${number(rough)}`;
}

/** A number to four digits: 0.0005, 6.17e-5. */
function exact(value) {
  if (!isKnown(value)) return "–";
  const digits = Number(value.toPrecision(4));
  return digits !== 0 && Math.abs(digits) < 1e-3
    ? digits.toExponential().replace("e+", "e")
    : String(digits);
}

/** A duration with its unit: 20 µs, 5 ms, 3 s. */
function seconds(value) {
  if (!isKnown(value)) return "–";
  if (value === 0) return "0 s";
  for (const [unit, scale] of [
    ["s", 1],
    ["ms", 1e-3],
    ["µs", 1e-6],
    ["ns", 1e-9],
  ]) {
    if (value >= 0.9999 * scale || unit === "ns")
      return `${Number((value / scale).toPrecision(3))} ${unit}`;
  }
}

/** A whole number with its thousands apart. */
function count(value) {
  if (!isKnown(value)) return "–";
  return Number.isInteger(value)
    ? value.toLocaleString("en").replaceAll(",", "\u202f")
    : number(value);
}

/** A count of things in words: "1 run", "12 runs". */
const things = (value, name) => `${count(value)} ${value === 1 ? name : `${name}s`}`;

/** A ratio in words: "1.04 ×", "120 ×". */
function ratio(value) {
  return isKnown(value) ? `${value < 10 ? value.toPrecision(3) : count(Math.round(value))} ×` : "–";
}

/** A column's or an outcome's name in words: "force evaluations". */
const plain = (name) => name.replaceAll("_", " ");

export const words = {
  number,
  about,
  exact,
  seconds,
  count,
  things,
  ratio,
  plain,
};
