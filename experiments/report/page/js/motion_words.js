// What is said of a motion: beside its view, below the views, and in the place of one that is not
// there.
"use strict";
{
  const { element, report, words, state } = qddotReport;
  const { motion, points } = report;
  // How many frames a user is told to make of a run without a motion.
  const FRAMES = 100;
  const ROUNDING = 1e-6;

  const sentence = (text) => element("p", { class: "quiet" }, text);

  /** Whether the kept frames of a run end before the run did. */
  const endsEarly = (run) =>
    run.t_reached !== null && run.times.at(-1) < (1 - ROUNDING) * run.t_reached;

  /** Words in the place of the motion of a run that has none, with the command that makes it. */
  function withoutMotion() {
    const command = points.command[state.run];
    if (!command || !report.until) return sentence("No motion of this run was kept.");
    const [knob, value] = [points.knob[state.run], points.value[state.run]];
    const apart = report.until / FRAMES;
    // Frames nearer to each other than its steps would have the run take other steps.
    const every = knob === "step_size" ? Math.max(apart, value) : apart;
    return element(
      "div",
      {},
      sentence("No motion of this run was kept. This command writes it for ParaView:"),
      qddotReport.commandLine(`${command} --motion motion.vtkhdf --every ${every}`),
    );
  }

  function stopWords(run) {
    if (run.outcome === "reached_end")
      return endsEarly(run)
        ? `its numbers grow beyond what is kept from t = ${words.seconds(run.times.at(-1))} on`
        : null;
    const why = run.point !== null ? points.cause[run.point] : null;
    return `stopped at t = ${words.seconds(run.t_reached)}: ${why ?? words.plain(run.outcome)}`;
  }

  function role(run) {
    if (run.role !== "reference") return run.why;
    return run.why ? `stands for the reference: ${run.why}` : "stands for the reference";
  }

  /** The place of a run's view, with what it shows in words. */
  function viewOf(run) {
    const said = element("div", { class: "view-words" }, element("b", {}, run.label), role(run));
    const quiet = (text) => said.append(element("div", { class: "quiet" }, text));
    const stop = stopWords(run);
    if (stop) said.append(element("div", {}, element("span", { class: "view-stop" }, stop)));
    if (run.role === "run" && points.knob[run.point] === "rtol")
      quiet("its steps end at the frames, so it is not quite the chart's run");
    if (run.left_box) quiet("parts of it leave what is kept");
    return element("div", { class: "view" }, said);
  }

  /** The least relative distance that the reference's own error lets mean something, where what is
      said of the reference tells it; else null. */
  function knownTo(reference) {
    const found = /\bwithin (\d[\d.]*e-?\d+)\b/.exec(reference?.why ?? "");
    return found ? Number(found[1]) : null;
  }

  /** How to move the view, and what else the drawing means; `factor`: how many times as large
      displacements along a line are drawn upwards, or null. */
  function explain(factor) {
    const move =
      motion.dimension < 3 ? "Drag to move" : "Drag to turn, with the right button to move";
    const notes = [
      ...motion.notes,
      "Dark squares are pinned nodes. Between kept frames nodes move straight.",
    ];
    if (factor !== null)
      notes.push(
        `Nodes move along the line; their displacement is drawn upwards as well, ${words.ratio(factor)} as large.`,
      );
    return [
      sentence(`${move}; pinch, or click and turn the wheel, to zoom.`),
      sentence(notes.join(" ")),
    ];
  }

  qddotReport.motionWords = { sentence, endsEarly, withoutMotion, viewOf, knownTo, explain };
}
