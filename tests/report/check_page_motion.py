"""Motions on a page, in a real browser; check_page.py runs these with its own."""

import numpy as np
from selenium.webdriver.common.keys import Keys

import made_folder
from browser import Page
from packed_folder import edit_json
from study_tables import read_table

DRAWS = "Number(document.querySelector('.views').dataset.draws)"
ENDED = "run.outcome === 'reached_end'"
# The dark points of each half of the canvas, read in the frame in which it is drawn: later it is
# empty.
INKS = """
const done = arguments[0];
document.querySelector(".player input").dispatchEvent(new Event("input"));
requestAnimationFrame(() => {
  const canvas = document.querySelector(".views canvas");
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
  copy.drawImage(canvas, 0, 0);
  const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
  const inks = [0, 0];
  for (let i = 0; i < data.length; i += 4) {
    const left = (i / 4) % canvas.width < canvas.width / 2;
    const light = data[i] + data[i + 1] + data[i + 2];
    if (data[i + 3] > 0 && light < 600) inks[left ? 0 : 1]++;
  }
  done(inks);
});
"""
# How high the drawing of a body is by its width, over all of the canvas.
SHAPE = """
const done = arguments[0];
document.querySelector(".player input").dispatchEvent(new Event("input"));
requestAnimationFrame(() => {
  const canvas = document.querySelector(".views canvas");
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d");
  copy.drawImage(canvas, 0, 0);
  const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
  const [xs, ys] = [new Set(), new Set()];
  for (let i = 0; i < data.length; i += 4) {
    if (data[i + 3] === 0 || data[i] + data[i + 1] + data[i + 2] > 600) continue;
    xs.add((i / 4) % canvas.width);
    ys.add(Math.floor(i / 4 / canvas.width));
  }
  done(ys.size / xs.size);
});
"""
CHOICES = """
let listening = 0;
const { addEventListener: add, removeEventListener: remove } = window;
window.addEventListener = (...what) => { listening++; add(...what); };
window.removeEventListener = (...what) => { listening--; remove(...what); };
const { choose, report } = qddotReport;
const points = report.motion.runs.filter((run) => run.energy).map((run) => run.point);
const [drawings, counts] = [new Set(), []];
for (let turn = 0; turn < 20; turn++) {
  choose({ run: points[turn % points.length] });
  document.querySelectorAll(".js-plotly-plot").forEach((one) => drawings.add(one));
  counts.push(listening);
}
return [drawings.size, counts];
"""


class Moving(Page):
    """The motion of a run beside the reference's."""

    def kept(self, condition="true"):
        """The run of a kept motion for which a condition of `run` holds."""
        return self.browser.value(
            f"qddotReport.report.motion.runs.find(run => run.role === 'run' && {condition}).point"
        )

    def wait_until_ready(self):
        """Waits until the motion of the chosen run is there."""
        self.browser.wait(
            "document.getElementById('motion').dataset.ready === String(qddotReport.state.run)"
        )

    def show(self, condition=ENDED, page=None):
        """Loads a page and shows the kept motion for which a condition of `run` holds; what the page
        says of it."""
        self.load(page or self.made)
        return self.show_next(condition)

    def show_next(self, condition):
        """Shows another motion of the page."""
        self.choose(self.kept(condition))
        self.wait_until_ready()
        return self.browser.text("#motion")

    def test_slider_and_play_move_two_views_that_show_something(self):
        self.show()
        self.assertEqual(self.browser.count(".view"), 2)
        self.assertGreater(min(self.browser.driver.execute_async_script(INKS)), 1000)
        slider = self.browser.find(".player input[type=range]")
        slider.send_keys(Keys.HOME)
        self.assertEqual(self.browser.text(".player output"), "t = 0 s")
        slider.send_keys(Keys.ARROW_RIGHT)
        self.assertNotEqual(self.browser.text(".player output"), "t = 0 s")
        before = self.browser.value(DRAWS)
        # The fastest, so that the pass is short.
        self.browser.run(
            "const menu = document.querySelector('.player select'); menu.selectedIndex = 0;"
            "menu.dispatchEvent(new Event('change'))"
        )
        self.browser.find(".player .play").click()
        self.browser.wait(f"{DRAWS} > arguments[0]", before)
        self.browser.wait("document.querySelector('.play').getAttribute('aria-pressed') === 'false'")
        self.assertEqual(slider.get_attribute("value"), "1000")
        self.show_next("run.outcome !== 'reached_end'")
        self.assertIn("stopped at t = ", self.browser.text(".views"))

    def test_a_run_without_a_motion_gets_the_command_that_makes_one(self):
        self.load(self.made)
        kept = "qddotReport.report.motion.runs.some(run => run.point === i)"
        self.choose(self.point(f"!{kept}"))
        self.browser.wait_for_words("#motion", "--motion motion.vtkhdf --every ")
        # A hundredth of the made motion is 0.005 s: no frames are nearer than the steps.
        coarse = "points.knob[i] === 'step_size' && points.value[i] === 0.02"
        self.choose(self.point(f"{coarse} && !{kept}"))
        self.browser.wait_for_words("#motion", "--every 0.02")

    def test_a_run_that_stands_for_the_reference_too_is_compared_with_it(self):
        self.load(self.made)
        point = self.browser.run("""
            const { motion } = qddotReport.report;
            const { runs } = motion;
            const { point } = runs.find((run) => run.role === "reference");
            runs.push({ ...runs.find((run) => run.distances), point, label: "the same" });
            runs[0].why = "within 3e-10 of it";
            motion.known_to = 3e-10;
            return point;
        """)
        self.choose(point)
        self.wait_until_ready()
        self.browser.wait("document.querySelectorAll('.view').length === 2")
        said = self.browser.text("#motion")
        self.assertIn("stands for the reference: within 3e-10 of it", said)
        self.assertIn("below about 3e-10 the reference itself may be off", said)
        self.assertRegex(said, r"Largest now: about \d(e-\d+)?")

    def test_a_motion_that_ends_before_its_run_says_so(self):
        self.load(self.made)
        condition = f"{ENDED} && run.point !== qddotReport.state.run"
        self.browser.run(
            "const run = qddotReport.keptMotion(arguments[0]);"
            "run.times = run.times.map((t) => t / 2)",
            self.kept(condition),
        )
        self.show_next(condition)
        said = "its numbers grow beyond what is kept from t = 250 ms on"
        self.browser.wait_for_words("#motion", said)
        self.browser.find(".player input[type=range]").send_keys(Keys.END)
        reference, run = self.browser.value(
            "[...document.querySelectorAll('.view')].map(one => one.style.background)"
        )
        self.assertEqual(reference, "")
        self.assertNotEqual(run, "")

    def test_an_adaptive_run_is_not_quite_the_chart_s(self):
        words, knob = "so it is not quite the chart's run", "qddotReport.report.points.knob"
        self.assertIn(words, self.show(f"{knob}[run.point] === 'rtol'"))
        self.assertNotIn(words, self.show_next(f"{knob}[run.point] === 'step_size'"))

    def test_a_lost_view_says_so_and_comes_back(self):
        self.show()
        self.browser.run("""
            const canvas = document.querySelector(".views canvas");
            window.taken = canvas.getContext("webgl2").getExtension("WEBGL_lose_context");
            taken.loseContext();
        """)
        self.browser.wait_for_words("#motion", "took away")
        before = self.browser.value(DRAWS)
        self.browser.run("taken.restoreContext()")
        self.browser.wait(f"{DRAWS} > arguments[0]", before)
        self.assertNotIn("took away", self.browser.text("#motion"))
        # three.js tells the console of it.
        said, _ = self.browser.logs()
        self.assertEqual([words for words in said if "Context" not in words], [])
        self.browser.load(self.made)

    def test_a_damaged_motion_is_a_sentence_until_it_can_be_read(self):
        self.load(self.made)
        point = self.kept("run.point !== qddotReport.state.run")
        blob = "document.getElementById(qddotReport.keptMotion(arguments[0]).positions)"
        self.browser.run(f"window.whole = {blob}.textContent; {blob}.textContent = '@'", point)
        self.choose(point)
        self.browser.wait_for_words("#motion", "this file is damaged")
        self.assertEqual(self.browser.count(".view"), 0)
        self.browser.run(f"{blob}.textContent = whole", point)
        self.choose(self.kept(f"run.point !== {point}"))
        self.choose(point)
        self.wait_until_ready()

    def test_a_motion_of_one_frame_has_no_player(self):
        self.show("true", self.packed("still", frames=1))
        self.browser.wait(f"{DRAWS} > 0")
        self.assertEqual(self.browser.count(".play"), 0)

    def test_several_motions_share_a_view_and_a_plot_of_energies(self):
        self.show()
        kept = self.browser.value(
            "qddotReport.keptRuns.map(run => run.point).filter(at => at !== qddotReport.state.run)"
        )
        for point in kept[:2]:
            self.browser.run(
                "const menu = document.getElementById('compare-menu'); menu.value = arguments[0];"
                "menu.dispatchEvent(new Event('change'))",
                str(point),
            )
        self.browser.wait("document.querySelectorAll('.view').length === 4")
        energies = "document.getElementById('energy-errors').data.length"
        self.assertEqual(self.browser.value(energies), 4)
        self.browser.find("#together").click()
        self.browser.wait("document.querySelectorAll('.view').length === 1")
        words = self.browser.text(".view")
        for point in kept[:2]:
            label = self.browser.value("qddotReport.keptMotion(arguments[0]).label", point)
            self.assertIn(label, words)
            self.assertIn(label, self.browser.text("#energies-key"))
        self.assertGreater(sum(self.browser.driver.execute_async_script(INKS)), 1000)
        # The address keeps it all.
        fragment = self.browser.value("location.hash")
        self.doCleanups()
        self.load(self.made, fragment)
        self.assertEqual(self.browser.value("qddotReport.state.compared"), kept[:2])
        self.browser.wait("document.querySelectorAll('.view').length === 1")
        self.browser.find("#compared button").click()
        self.assertEqual(self.browser.value(energies), 3)

    def test_one_mass_has_its_phase_plane(self):
        self.show(page=self.packed("mass", side=2, dimension=2))
        drawn = "[...document.querySelectorAll('#phase-charts .drawing')].map(one => one.data)"
        charts = self.browser.value(f"{drawn}.map(data => data.map(({{ x, y }}) => [x, y]))")
        run = self.browser.value("qddotReport.keptMotion(qddotReport.state.run)")
        self.assertEqual(len(charts), 2)
        for along, (_, own) in enumerate(charts):
            self.assertEqual(own, [run["phase"][name][along] for name in ("position", "velocity")])
        self.assertNotEqual(*charts[1])  # along x nothing moves
        self.doCleanups()
        self.show()
        self.assertFalse(self.browser.find("#phase").is_displayed())

    def test_the_camera_stands_upright_in_gravity(self):
        # The sheet lies in the plane of x and y, and the camera looks down by some 23 degrees.
        shapes = []
        for name, gravity in (("none", [0, 0, 0]), ("z", [0, 0, -9.81]), ("y", [0, -9.81, 0])):
            def change(folder, gravity=gravity):
                edit_json(folder / "points.json", lambda c: c["scene"].update(gravity=gravity))

            self.show(page=self.packed(f"upright_{name}", change))
            self.browser.wait(f"{DRAWS} > 0")
            self.browser.run("qddotReport.goTo(0)")
            shapes.append(self.browser.driver.execute_async_script(SHAPE))
            self.doCleanups()
        self.assertEqual(shapes[0], shapes[1])
        # Two views beside each other: a square is half as wide as both.
        self.assertLess(shapes[1], 0.35)
        self.assertGreater(shapes[2], 0.45)

    def test_broken_springs_are_not_drawn(self):
        # Few springs are thick lines, many are thin ones. Some of them break at the fifth frame.
        for springs, kind in ((40, {"side": 5}), (3120, {"side": 40, "runs": 2})):
            inks = []
            for broken in (0, springs * 3 // 4):
                def change(folder, springs=springs, broken=broken):
                    for row in read_table(folder / "motions.csv"):
                        broken_from = np.where(np.arange(springs) < broken, 4, 99)
                        made_folder.write_strains(folder / row["file"], broken_from)

                name = f"broken_{broken}_of_{springs}"
                self.show(page=self.packed(name, change, has_faces=False, **kind))
                self.browser.wait(f"{DRAWS} > 0")
                end, start = (self.inks_at(time) for time in ("report.until", "0"))
                self.assertEqual(self.inks_at("report.until"), end)
                inks.append((start, end))
                self.doCleanups()  # which look at this page
            (start, whole), (start_of_broken, rest) = inks
            self.assertEqual(start_of_broken, start)
            for left, all_of_it in zip(rest, whole):
                self.assertLess(left, 0.8 * all_of_it)

    def inks_at(self, time):
        """The dark points of both views at a time."""
        self.browser.run(f"const {{ report, goTo }} = qddotReport; goTo({time})")
        return self.browser.driver.execute_async_script(INKS)

    def test_many_choices_leave_no_drawings_behind(self):
        self.load(self.made)
        drawings, listening = self.browser.run(CHOICES)
        # The chart, the failures and two of energies, the same ones all the time.
        self.assertEqual((drawings, listening[1]), (4, listening[-1]))

    def test_only_a_line_is_drawn_with_its_displacements_upwards(self):
        for dimension, is_upwards in ((1, True), (2, False)):
            page = self.packed(f"flat{dimension}", dimension=dimension, side=9)
            self.assertEqual("drawn upwards" in self.show(page=page), is_upwards)
            self.browser.wait(f"{DRAWS} > 0")
            self.doCleanups()  # which look at this page
