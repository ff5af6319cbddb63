// The kept motions: positions of all nodes at the kept times, and their distances from the
// reference.
"use strict";
{
  const { report } = qddotReport;
  const { motion } = report;
  const unpacked = new Map();
  const MOST_KEPT = 4;

  /** Undoes the packing: frames of 16-bit integers, each minus the one before, low bytes first. */
  function integrate(bytes, perFrame) {
    const count = bytes.length / 2;
    const places = new Uint16Array(count);
    for (let i = 0; i < count; i++) {
      const change = bytes[i] | (bytes[count + i] << 8);
      places[i] = i < perFrame ? change : places[i - perFrame] + change;
    }
    return places;
  }

  async function unpack(run) {
    const perFrame = 3 * motion.nodes;
    const places = integrate(await qddotReport.bytes(run.positions), perFrame);
    const distances = run.distances ? await qddotReport.bytes(run.distances) : null;
    const count = run.times.length * motion.nodes;
    if (places.length !== 3 * count || (distances && distances.length !== count))
      throw new RangeError(`The motion of ${run.label} has not ${count} places.`);
    return { ...run, perFrame, places, distances };
  }

  /** A run with its frames unpacked: `places` (frames x nodes x 3) and `distances` (frames x nodes)
      or null. Rejects where its blobs cannot be unpacked. */
  qddotReport.unpackedRun = async (run) => {
    if (!unpacked.has(run)) {
      // A few are kept, so that a reader who looks at many needs no more memory for it.
      if (unpacked.size >= MOST_KEPT) {
        const old = [...unpacked.keys()].find((one) => one.role !== "reference");
        unpacked.delete(old);
      }
      const attempt = unpack(run);
      unpacked.set(run, attempt);
      // What failed is tried again when it is asked for again.
      attempt.catch(() => unpacked.delete(run));
    }
    return unpacked.get(run);
  };

  /** The kept motion of a point, or null: where the point stands for the reference too, the one
      that was compared with it. */
  qddotReport.keptMotion = (point) => {
    const kept = point === null ? [] : (motion?.runs ?? []).filter((run) => run.point === point);
    return kept.find((run) => run.role === "run") ?? kept[0] ?? null;
  };

  /** The pairs or triples of nodes in a blob of 32-bit integers. */
  qddotReport.nodeLists = async (id) => {
    if (!id) return new Uint32Array(0);
    const bytes = await qddotReport.bytes(id);
    return new Uint32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
  };

  /** Where a time lies among a run's frames: the frame before it and the share of the way to the
      next. */
  qddotReport.frameAt = (times, t) => {
    let low = 0;
    let high = times.length - 1;
    if (t >= times[high]) return { frame: high, share: 0 };
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (times[middle] <= t) low = middle;
      else high = middle;
    }
    return { frame: low, share: Math.max(0, (t - times[low]) / (times[high] - times[low])) };
  };

  /** Writes the positions at a time in m into `out` (nodes x 3), straight between frames. */
  qddotReport.positionsAt = (run, t, out) => {
    const { frame, share } = qddotReport.frameAt(run.times, t);
    const { places, perFrame } = run;
    const now = frame * perFrame;
    const next = share > 0 ? now + perFrame : now;
    const scale = motion.size / 65535;
    for (let i = 0; i < perFrame; i++) {
      const place = places[now + i] + share * (places[next + i] - places[now + i]);
      out[i] = motion.low[i % 3] + scale * place;
    }
  };

  /** The least and the largest coordinates over all frames of a run, in m. */
  qddotReport.boundsOf = ({ places }) => {
    const low = [65535, 65535, 65535];
    const high = [0, 0, 0];
    for (let i = 0; i < places.length; i += 3) {
      for (let axis = 0; axis < 3; axis++) {
        const place = places[i + axis];
        if (place < low[axis]) low[axis] = place;
        if (place > high[axis]) high[axis] = place;
      }
    }
    const metres = (place, axis) => motion.low[axis] + (motion.size * place) / 65535;
    return { low: low.map(metres), high: high.map(metres) };
  };
}
