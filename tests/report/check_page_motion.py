"""What a page shows of motions, in a real browser; check_page.py runs these with its own."""

from selenium.webdriver.common.keys import Keys

from page_in_browser import Page

READY = "return document.getElementById('motion').dataset.ready === String(qddotReport.state.run)"


class Moving(Page):
    """The motion of a run beside the reference's."""

    def kept(self, condition="true"):
        """The run of a kept motion for which a condition of `run` holds."""
        return self.browser.run(
            "return qddotReport.report.motion.runs.find("
            f"run => run.role === 'run' && {condition}).point"
        )

    def test_slider_and_play_move_it(self):
        self.load(self.made)
        self.choose(self.kept("run.outcome === 'reached_end'"))
        self.browser.wait(READY)
        slider = self.browser.find(".player input[type=range]")
        slider.send_keys(Keys.HOME)
        self.assertEqual(self.browser.text(".player output"), "t = 0 s")
        slider.send_keys(Keys.ARROW_RIGHT)
        self.assertNotEqual(self.browser.text(".player output"), "t = 0 s")
        before = int(self.browser.run("return document.querySelector('.views').dataset.draws"))
        # The fastest, so that the pass is short.
        self.browser.run(
            "const menu = document.querySelector('.player select'); menu.selectedIndex = 0;"
            "menu.dispatchEvent(new Event('change'))"
        )
        play = self.browser.find(".player .play")
        play.click()
        self.browser.wait(
            "return Number(document.querySelector('.views').dataset.draws) > arguments[0]",
            before,
        )
        self.browser.wait(
            "return document.querySelector('.play').getAttribute('aria-pressed') === 'false'"
        )
        self.assertEqual(slider.get_attribute("value"), "1000")

    def test_two_views_stand_beside_each_other_and_show_something(self):
        self.load(self.made)
        self.choose(self.kept("run.outcome === 'reached_end'"))
        self.browser.wait(READY)
        self.assertEqual(len(self.browser.driver.find_elements("css selector", ".view")), 2)
        # The canvas is read in the frame in which it is drawn: later it is empty.
        inks = self.browser.driver.execute_async_script("""
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
        """)
        for ink in inks:
            self.assertGreater(ink, 1000)

    def test_a_run_that_failed_plays_up_to_there_and_says_so(self):
        self.load(self.made)
        self.choose(self.kept("run.outcome !== 'reached_end'"))
        self.browser.wait(READY)
        self.assertIn("stopped at t = ", self.browser.text(".views"))

    def test_a_run_without_a_motion_gets_the_command_that_makes_one(self):
        self.load(self.made)
        point = self.point("!qddotReport.report.motion.runs.some(run => run.point === i)")
        self.choose(point)
        self.browser.wait(
            "return document.getElementById('motion').innerText.includes('--motion motion.vtkhdf --every ')"
        )

    def test_the_command_has_no_frames_nearer_than_the_steps(self):
        self.load(self.made)
        # A hundredth of the made motion is 0.005 s.
        point = self.point(
            "points.knob[i] === 'step_size' && points.value[i] === 0.02"
            " && !qddotReport.report.motion.runs.some(run => run.point === i)"
        )
        self.choose(point)
        self.browser.wait(
            "return document.getElementById('motion').innerText.includes('--every 0.02')"
        )

    def test_a_run_that_stands_for_the_reference_too_is_compared_with_it(self):
        self.load(self.made)
        point = self.browser.run("""
            const { runs } = qddotReport.report.motion;
            const { point } = runs.find((run) => run.role === "reference");
            runs.push({ ...runs.find((run) => run.distances), point, label: "the same" });
            runs[0].why = "within 3e-10 of it";
            return point;
        """)
        self.choose(point)
        self.browser.wait(READY)
        self.browser.wait("return document.querySelectorAll('.view').length === 2")
        said = self.browser.text("#motion")
        self.assertIn("stands for the reference: within 3e-10 of it", said)
        self.assertIn("below about 3e-10 the reference itself may be off", said)
        self.assertRegex(said, r"Largest now: about \d(e-\d+)?")

    def test_a_motion_that_ends_before_its_run_says_so(self):
        self.load(self.made)
        point = self.kept("run.outcome === 'reached_end' && run.point !== qddotReport.state.run")
        self.browser.run(
            "const run = qddotReport.keptMotion(arguments[0]);"
            "run.times = run.times.map((t) => t / 2)",
            point,
        )
        self.choose(point)
        self.browser.wait(READY)
        said = "its numbers grow beyond what is kept from t = 250 ms on"
        self.browser.wait(
            "return document.getElementById('motion').innerText.includes(arguments[0])", said
        )
        self.browser.find(".player input[type=range]").send_keys(Keys.END)
        shade = "return [...document.querySelectorAll('.view')].map(one => one.style.background)"
        reference, run = self.browser.run(shade)
        self.assertEqual(reference, "")
        self.assertNotEqual(run, "")

    def test_an_adaptive_run_is_not_quite_the_chart_s(self):
        self.load(self.made)
        words = "so it is not quite the chart's run"
        for knob, check in (("rtol", self.assertIn), ("step_size", self.assertNotIn)):
            self.choose(self.kept(f"qddotReport.report.points.knob[run.point] === '{knob}'"))
            self.browser.wait(READY)
            check(words, self.browser.text("#motion"))

    def test_a_lost_view_says_so_and_comes_back(self):
        self.load(self.made)
        self.choose(self.kept("run.outcome === 'reached_end'"))
        self.browser.wait(READY)
        self.browser.run("""
            const canvas = document.querySelector(".views canvas");
            window.taken = canvas.getContext("webgl2").getExtension("WEBGL_lose_context");
            taken.loseContext();
        """)
        told = "return document.getElementById('motion').innerText.includes('took away')"
        self.browser.wait(told)
        draws = "return Number(document.querySelector('.views').dataset.draws)"
        before = self.browser.run(draws)
        self.browser.run("taken.restoreContext()")
        self.browser.wait(f"{draws} > arguments[0]", before)
        self.assertFalse(self.browser.run(told))
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
        self.browser.wait(
            "return document.getElementById('motion').innerText.includes('this file is damaged')"
        )
        self.assertEqual(self.browser.run("return document.querySelectorAll('.view').length"), 0)
        self.browser.run(f"{blob}.textContent = whole", point)
        self.choose(self.kept(f"run.point !== {point}"))
        self.choose(point)
        self.browser.wait(READY)

    def test_a_motion_of_one_frame_has_no_player(self):
        self.load(self.packed("still", frames=1))
        self.choose(self.kept())
        self.browser.wait(READY)
        self.browser.wait("return Number(document.querySelector('.views').dataset.draws) > 0")
        self.assertEqual(self.browser.run("return document.querySelectorAll('.play').length"), 0)

    def test_many_choices_leave_no_drawings_behind(self):
        self.load(self.made)
        drawings, listening = self.browser.run("""
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
        """)
        # The chart, the failures and two of energies, the same ones all the time.
        self.assertEqual(drawings, 4)
        self.assertEqual(listening[1], listening[-1])

    def test_without_motions_the_page_says_so(self):
        page = self.packed("motionless", has_motions=False)
        self.load(page)
        self.assertIn("No motions were kept.", self.browser.text("#motion"))

    def shown_flat(self, dimension):
        """What the page says of the motion of a scene of this dimension."""
        self.load(self.packed(f"flat{dimension}", dimension=dimension, side=9))
        self.choose(self.kept("run.outcome === 'reached_end'"))
        self.browser.wait(READY)
        self.browser.wait("return Number(document.querySelector('.views').dataset.draws) > 0")
        return self.browser.text("#motion")

    def test_a_line_is_drawn_with_its_displacements_upwards(self):
        self.assertIn("drawn upwards", self.shown_flat(1))

    def test_a_plane_is_drawn_as_it_is(self):
        self.assertNotIn("drawn upwards", self.shown_flat(2))
