// The kept motions: positions of all nodes at the kept times, and their distances from the
// reference. They stand in the page as base64 of raw deflate.
import { byId } from "./element.js";
import { report } from "./report.js";

const { motion } = report;

/** Whether this browser can unpack them. */
export function canUnpack() {
  try {
    return Boolean(new DecompressionStream("deflate-raw"));
  } catch {
    return false;
  }
}

async function bytesOf(id) {
  const text = atob(byId(id).textContent.trim());
  const packed = Uint8Array.from(text, (character) => character.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate-raw"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

// Frames of 16-bit integers, each minus the one before, all low bytes first.
function integrate(bytes, perFrame) {
  const count = bytes.length / 2;
  const places = new Uint16Array(count);
  for (let i = 0; i < count; i++) {
    const change = bytes[i] | (bytes[count + i] << 8);
    places[i] = i < perFrame ? change : places[i - perFrame] + change;
  }
  return places;
}

/** A run with its frames unpacked: `places` (frames x nodes x 3), `distances` (frames x nodes) or
    null, and `brokenFrom`, the frame from which each spring is broken, or null where none breaks.
    Rejects where its blobs cannot be unpacked. */
export async function unpacked(run) {
  const perFrame = 3 * motion.nodes;
  const places = integrate(await bytesOf(run.positions), perFrame);
  const distances = run.distances ? await bytesOf(run.distances) : null;
  const count = run.times.length * motion.nodes;
  if (places.length !== 3 * count || (distances && distances.length !== count))
    throw new RangeError(`The motion of ${run.label} has not ${count} places.`);
  const brokenFrom = run.broken_from ? await nodeLists(run.broken_from) : null;
  return { ...run, perFrame, places, distances, brokenFrom };
}

/** The 32-bit integers of a blob, as the pairs or triples of nodes. */
export async function nodeLists(id) {
  if (!id) return new Uint32Array(0);
  const { buffer } = await bytesOf(id);
  return new Uint32Array(buffer);
}

/** The coordinate in m of a packed place. */
export const metres = (place, axis) => motion.low[axis] + (motion.size / 65535) * place;

/** The last frame that is not after a time. */
export const frameAt = ({ times }, t) =>
  Math.max(
    0,
    times.findLastIndex((time) => time <= t),
  );

/** Those of the springs (pairs of nodes) that are not broken at a time. */
export function wholeSprings(run, springs, t) {
  if (!run.brokenFrom) return springs;
  const frame = frameAt(run, t);
  return springs.filter((_, end) => run.brokenFrom[end >> 1] > frame);
}

/** Writes the positions at a time in m into `out` (nodes x 3), straight between frames. */
export function positionsAt({ times, places, perFrame }, t, out) {
  const frame = frameAt({ times }, t);
  const isLast = frame === times.length - 1;
  const share = isLast ? 0 : Math.max(0, (t - times[frame]) / (times[frame + 1] - times[frame]));
  const now = frame * perFrame;
  const next = isLast ? now : now + perFrame;
  for (let i = 0; i < perFrame; i++) {
    const place = places[now + i] + share * (places[next + i] - places[now + i]);
    out[i] = metres(place, i % 3);
  }
}

/** The least and the largest coordinates over all frames of a run, in m. */
export function boundsOf({ places }) {
  const low = [65535, 65535, 65535];
  const high = [0, 0, 0];
  places.forEach((place, i) => {
    if (place < low[i % 3]) low[i % 3] = place;
    if (place > high[i % 3]) high[i % 3] = place;
  });
  return { low: low.map(metres), high: high.map(metres) };
}
