// The clock of a motion: a slider, play and pause, real time or slower.
"use strict";
{
  const { element, words } = qddotReport;
  const PASS = 5;

  /** Times slower or faster than real, from the fastest: 1, 2 and 5 times powers of ten. */
  function speeds(until) {
    const wanted = Math.log10(until / PASS);
    const nice = [];
    for (let power = -9; power <= 3; power++)
      for (const digit of [1, 2, 5]) nice.push(digit * 10 ** power);
    const nearest = nice.reduce((a, b) =>
      Math.abs(Math.log10(b) - wanted) < Math.abs(Math.log10(a) - wanted) ? b : a,
    );
    const at = nice.indexOf(nearest);
    const offered = new Set([1, ...nice.slice(Math.max(0, at - 4), at + 4)]);
    return { nearest, offered: [...offered].sort((a, b) => b - a) };
  }

  function speedInWords(speed) {
    if (speed === 1) return "× 1, real time";
    return speed > 1 ? `× ${words.exact(speed)}` : `× 1/${words.count(Math.round(1 / speed))}`;
  }

  /** The controls over the times 0 to `until`; `shown(t)` is called at each change of the time. */
  qddotReport.player = (until, shown) => {
    const { nearest, offered } = speeds(until);
    let t = 0;
    let speed = nearest;
    let playing = false;
    let before = null;

    const play = element(
      "button",
      {
        type: "button",
        class: "play",
        "aria-pressed": "false",
        click: () => (playing ? pause() : start()),
      },
      "▶ Play",
    );
    const slider = element("input", {
      type: "range",
      min: 0,
      max: 1000,
      step: 1,
      value: 0,
      "aria-label": "Time of the motion",
      input: () => {
        pause();
        go((Number(slider.value) / 1000) * until);
      },
    });
    const output = element("output");
    const menu = element(
      "select",
      { "aria-label": "Speed", change: () => (speed = Number(menu.value)) },
      ...offered.map((one) =>
        element("option", { value: one, selected: one === nearest }, speedInWords(one)),
      ),
    );

    function go(time) {
      t = Math.min(Math.max(time, 0), until);
      slider.value = Math.round((1000 * t) / until);
      const now = `t = ${words.seconds(t)}`;
      output.textContent = now;
      slider.setAttribute("aria-valuetext", now);
      shown(t);
    }

    function tick(now) {
      if (!playing) return;
      if (before !== null) go(t + ((now - before) / 1000) * speed);
      before = now;
      if (t >= until) pause();
      else requestAnimationFrame(tick);
    }

    function start() {
      if (t >= until) go(0);
      playing = true;
      before = null;
      name();
      requestAnimationFrame(tick);
    }

    function pause() {
      playing = false;
      name();
    }

    function name() {
      play.textContent = playing ? "❚❚ Pause" : "▶ Play";
      play.setAttribute("aria-pressed", String(playing));
    }

    const node = element("div", { class: "player" }, play, slider, output, menu);
    return { node, go, pause, time: () => t };
  };
}
