// The motion of the chosen run beside the reference's.
"use strict";
{
  const { element, byId, report, state, keptMotion } = qddotReport;
  const { sentence, endsEarly, withoutMotion, viewOf, knownTo, explain } = qddotReport.motionWords;
  const { motion } = report;
  const section = byId("motion");
  // The reference in grey: dark lines, lighter faces, on which shade is seen.
  const NEUTRAL = motion?.faces ? [0.24, 0.25, 0.27] : [0.07, 0.075, 0.085];
  // How far up the largest displacement of a line of nodes is drawn, as a part of its length.
  const LIFT = 0.2;
  const FEWEST_LIFTED = 8;
  // A packed relative distance of 0.3.
  const FAR = 246;
  let stage = null;
  let player = null;
  let lists = null;
  let scene = null;
  let turn = 0;

  const reference = motion?.runs.find((run) => run.role === "reference") ?? null;
  const lost = element(
    "p",
    { class: "bad", role: "status", hidden: true },
    "The browser took away what the motion is drawn with; it is drawn again when it comes back.",
  );

  // A line of nodes moves along itself: its displacements are drawn upwards, or nobody would see
  // them.
  function lifted(bounds) {
    if (motion.dimension !== 1 || motion.nodes < FEWEST_LIFTED || !(motion.distance_unit > 0))
      return null;
    const extents = bounds.high.map((high, axis) => high - bounds.low[axis]);
    const along = extents.indexOf(Math.max(...extents));
    return {
      along,
      up: along === 2 ? 0 : 2,
      factor: (LIFT * extents[along]) / motion.distance_unit,
    };
  }

  function place(run, body, t) {
    qddotReport.positionsAt(run, t, body.positions);
    if (!scene.lift) return;
    const { along, up, factor } = scene.lift;
    const { places } = run;
    for (let i = along; i < body.positions.length; i += 3) {
      const start = motion.low[along] + (motion.size * places[i]) / 65535;
      body.positions[i - along + up] = scene.middle[up] + factor * (body.positions[i] - start);
    }
  }

  function paint(run, body, t) {
    if (!run.distances) {
      for (let i = 0; i < body.colors.length; i++) body.colors[i] = NEUTRAL[i % 3];
      return null;
    }
    const { frame } = qddotReport.frameAt(run.times, t);
    const { table } = qddotReport.distanceScale;
    let largest = 0;
    for (let node = 0; node < motion.nodes; node++) {
      const code = run.distances[frame * motion.nodes + node];
      if (code > largest) largest = code;
      body.colors.set(table.subarray(3 * code, 3 * code + 3), 3 * node);
    }
    return largest;
  }

  function show(t) {
    if (!scene) return;
    for (const { run, body, view } of scene.parts) {
      place(run, body, t);
      const largest = paint(run, body, t);
      if (largest !== null) scene.scale?.point(largest);
      body.update();
      view.style.background =
        t > run.times.at(-1) && (run.outcome !== "reached_end" || endsEarly(run)) ? "#fbe9e5" : "";
    }
    stage.draw();
  }

  function buttons() {
    const button = (text, label, act) =>
      element("button", { type: "button", "aria-label": label, title: label, click: act }, text);
    return [
      button("+", "Closer", () => stage.zoom(1.25)),
      button("−", "Farther", () => stage.zoom(0.8)),
      button("Reset view", "Show the whole scene", () => stage.look(scene.bounds)),
    ];
  }

  async function build(runs) {
    lists ??= {
      springs: await qddotReport.nodeLists(motion.springs),
      faces: await qddotReport.nodeLists(motion.faces),
    };
    const unpacked = await Promise.all(runs.map(qddotReport.unpackedRun));
    const bounds = qddotReport.boundsOf(unpacked[0]);
    return { unpacked, bounds };
  }

  // Errors of the chart are those at the end. A run that blows up shows most while it is still in
  // the view: while its error is about as large as the motion.
  function openingTime(run, until) {
    if (run.outcome === "reached_end" || !run.distances) return until;
    const far = run.distances.findIndex((code) => code >= FAR);
    return far < 0 ? run.times.at(-1) : run.times[Math.floor(far / motion.nodes)];
  }

  function liftBounds(bounds, lift) {
    if (!lift) return bounds;
    const [low, high] = [[...bounds.low], [...bounds.high]];
    const reach = 1.2 * lift.factor * motion.distance_unit;
    const middle = (low[lift.up] + high[lift.up]) / 2;
    [low[lift.up], high[lift.up]] = [middle - reach, middle + reach];
    return { low, high };
  }

  /** Draws the motion of the chosen run, or says why there is none. */
  qddotReport.drawMotion = async () => {
    const mine = ++turn;
    player?.pause();
    const beside = reference ? "Its motion beside the reference" : "Its motion";
    const heading = element("h3", {}, beside);
    const say = (...nodes) => section.replaceChildren(heading, ...nodes.filter(Boolean));
    scene = null;
    if (!motion || !motion.runs.length)
      return say(sentence("No motions were kept."), state.run === null ? null : withoutMotion());
    if (!qddotReport.canInflate())
      return say(sentence("This browser cannot unpack the motions: it lacks DecompressionStream."));
    const chosen = keptMotion(state.run);
    const runs = [...new Set([reference, chosen].filter(Boolean))];
    const missing = state.run !== null && !chosen ? withoutMotion() : null;
    if (!runs.length) return say(qddotReport.keptMotions(), missing);

    const views = runs.map(viewOf);
    const holder = element("div", { class: views.length > 1 ? "views" : "views alone" }, ...views);
    const opening = stage === null;
    try {
      stage ??= qddotReport.motionStage(motion.dimension, (gone) => (lost.hidden = !gone));
    } catch {
      return say(
        qddotReport.keptMotions(),
        missing,
        sentence(
          "This browser draws no WebGL, which the motion is drawn with; all else on this page works without.",
        ),
      );
    }
    const built = await build(runs).catch(() => null);
    if (mine !== turn) return;
    if (!built)
      return say(
        qddotReport.keptMotions(),
        missing,
        sentence("The motion cannot be unpacked: this file is damaged."),
      );
    const { unpacked, bounds } = built;
    const lift = lifted(bounds);
    const bodies = unpacked.map(() =>
      qddotReport.motionBody({ nodes: motion.nodes, pinned: motion.pinned, ...lists }),
    );
    const scale = unpacked.some((run) => run.distances)
      ? qddotReport.distanceScale.legend(knownTo(reference))
      : null;
    const wide = liftBounds(bounds, lift);
    const middle = wide.low.map((low, axis) => (low + wide.high[axis]) / 2);
    scene = {
      bounds: wide,
      lift,
      middle,
      scale,
      parts: unpacked.map((run, at) => ({ run, body: bodies[at], view: views[at] })),
    };
    const until = Math.max(...unpacked.map((run) => run.times.at(-1)));
    // A single frame has no time to go through.
    player = until > 0 ? qddotReport.player(until, show) : null;
    const controls = player?.node ?? element("div", { class: "player" });
    controls.append(...buttons());
    say(
      qddotReport.keptMotions(),
      missing,
      holder,
      lost,
      controls,
      scale?.node,
      ...explain(lift?.factor ?? null),
    );
    stage.canvas.setAttribute(
      "aria-label",
      `Motion of ${runs.map((run) => run.label).join(" and ")}`,
    );
    stage.show(holder, views, bodies);
    // The reader's own view stays from run to run.
    if (opening || !reference) stage.look(wide);
    const begin = openingTime(unpacked.at(-1), until);
    if (player) player.go(begin);
    else show(begin);
    section.dataset.ready = state.run ?? "";
  };

  /** Makes the motion ready for paper, or for the screen again. */
  qddotReport.printMotion = (onPaper) => scene && stage.still(onPaper);
}
