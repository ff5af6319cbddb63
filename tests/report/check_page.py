"""Whether the page of a report does what it should in a real browser: Chromium without a screen."""

import itertools

from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.keys import Keys

from browser import Page
from check_page_motion import Moving  # They run with the tests of this file.
from packed_folder import edit_json
from study_tables import judge, read_table, write_table

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&lt;"
CHART = "document.getElementById('chart-drawing')"
GOOD = "points.outcome[i] === 'reached_end' && points.error_position[i] < 1e-3"


class Choosing(Page):
    """A reader's ways to find a run."""

    def setUp(self):
        self.load(self.made)

    def test_a_mark_tells_its_run_on_hover_and_is_chosen_by_a_click(self):
        self.browser.run("qddotReport.choose({ ordinate: 'none' })")
        self.assertIn("No run gave a point", self.browser.text("#chart"))
        # Marks answer again after a choice that had none.
        self.browser.run("qddotReport.choose({ ordinate: 'time_s' })")
        point = self.point(GOOD)
        said = self.move_to("chart-drawing", point)
        for words in ("relative position error", "time of a run", "force evaluations"):
            self.assertIn(words, said)
        head = self.click(point)
        name = self.browser.run(
            "const { methods, points } = qddotReport.report;"
            "return methods[points.method[arguments[0]]].name",
            point,
        )
        self.assertIn(name, head)
        self.assertIn(f"run={name}", self.browser.driver.current_url)
        self.assertGreater(self.browser.value(f"{CHART}.data.at(-1).x.length"), 0)  # the ring
        # No run of the made folder has factorizations.
        offered = self.browser.value(
            "[...document.getElementById('ordinate').options].map(one => one.value)"
        )
        self.assertNotIn("factorizations", offered)
        self.assertIn("force_evaluations", offered)
        point = self.point("points.outcome[i] === 'diverged'")
        cause = self.browser.value("qddotReport.report.points.cause[arguments[0]]", point)
        self.assertIn(cause, self.move_to("failures-drawing", point))
        self.assertIn(cause, self.click(point))

    def test_a_zoom_stays_until_it_is_undone(self):
        ranges = f"[...{CHART}.layout.xaxis.range, ...{CHART}.layout.yaxis.range]"
        whole = self.browser.value(ranges)
        node = self.browser.find("#chart-drawing .nsewdrag")
        self.browser.run("arguments[0].scrollIntoView({ block: 'center' })", node)
        # Upwards alone: one axis is enough.
        drag = ActionChains(self.browser.driver).move_to_element_with_offset(node, 50, 50)
        drag.click_and_hold().move_by_offset(0, -120).release().perform()
        self.browser.wait("!document.getElementById('whole').hidden")
        zoomed = self.browser.value(ranges)
        self.assertNotEqual(zoomed[2:], whole[2:])
        self.browser.find("#cloud").click()
        self.assertEqual(self.browser.value(ranges), zoomed)
        self.browser.driver.set_window_size(700, 900)
        self.addCleanup(self.browser.driver.set_window_size, 1400, 1000)
        narrow = "document.getElementById('failures-drawing').layout.margin.l"
        before = self.browser.value(narrow)
        self.browser.driver.set_window_size(520, 900)
        self.browser.wait(f"{narrow} !== arguments[0]", before)
        self.assertTrue(self.browser.value(f"{CHART}._fullLayout.width === {CHART}.clientWidth"))
        self.assertEqual(self.browser.value(ranges), zoomed)
        self.browser.find("#whole").click()
        self.assertEqual(self.browser.value(ranges), whole)
        self.assertFalse(self.browser.find("#whole").is_displayed())

    def test_charts_on_paper_are_as_wide_as_the_sheet(self):
        width = "document.querySelector('#chart-drawing .main-svg').clientWidth"
        wide = self.browser.value(width)
        self.browser.run("dispatchEvent(new Event('beforeprint'))")
        # A4 has 210 mm, less 14 mm on either side, at 96 px an inch.
        self.assertLessEqual(self.browser.value(width), (210 - 28) * 96 / 25.4)
        self.browser.run("dispatchEvent(new Event('afterprint'))")
        self.assertEqual(self.browser.value(width), wide)

    def test_a_row_of_the_answers_is_chosen_by_enter(self):
        rows = "[...document.querySelectorAll('.answers tbody tr')].map(row => row.dataset.point)"
        points = self.browser.value("qddotReport.report.answers.map(answer => answer.point)")
        # One row for a run that is the fastest at several accuracies.
        points = [point for point, _ in itertools.groupby(points)]
        self.assertLess(len(points), 7)
        expected = [None if point is None else str(point) for point in points]
        self.assertEqual(self.browser.value(rows), expected)
        opening = self.chosen
        row = self.browser.find(".answers tbody tr[data-point]:last-child")
        button = row.find_element("tag name", "button")
        button.send_keys(Keys.ENTER)
        point = int(row.get_attribute("data-point"))
        self.assertNotEqual(point, opening)
        self.assertEqual((self.chosen, button.get_attribute("aria-pressed")), (point, "true"))
        self.browser.driver.back()
        self.wait_until_chosen(opening)
        self.browser.driver.forward()
        self.wait_until_chosen(point)
        # The link to the answers leaves the run in the address.
        # The link shows only with the focus, and older drivers send no keys to what does not show.
        self.browser.run("document.querySelector('.skip').focus()")
        self.browser.driver.switch_to.active_element.send_keys(Keys.ENTER)
        self.browser.wait("location.hash.includes('run=')")
        self.assertEqual(self.chosen, point)

    def test_the_menus_lead_to_every_run_and_quantity(self):
        self.browser.find("#run-choice select").send_keys("verlet")
        self.browser.wait(
            "qddotReport.report.methods[qddotReport.report.points.method[qddotReport.state.run]]"
            ".name === 'verlet'"
        )
        runs = "#run-choice label:nth-child(2)"
        self.assertIn("relative position error", self.browser.text(runs))
        self.browser.run("qddotReport.choose({ column: 'error_energy_max' })")
        self.assertNotIn("position", self.browser.text(runs))
        before = self.chosen
        self.browser.find("#run-choice button[aria-label='Finer run']").click()
        self.assertNotEqual(self.chosen, before)
        for quantity in self.browser.value("qddotReport.report.quantities"):
            self.browser.run(
                "const menu = document.getElementById('quantity'); menu.value = arguments[0];"
                "menu.dispatchEvent(new Event('change'))",
                quantity["column"],
            )
            title = self.browser.value(f"{CHART}.layout.xaxis.title.text")
            self.assertIn(quantity["axis"], title)
            self.assertEqual(self.browser.text("#quantity-about"), quantity["subtitle"])
        self.browser.find("#ordinate").send_keys("force evaluations")
        self.browser.wait(f"{CHART}.layout.yaxis.title.text.includes('force evaluations')")

    def test_methods_are_switched_on_and_off(self):
        strong = f"{CHART}.data.slice(2, -1).map(one => one.name)"
        all_of_them, none = (
            self.browser.find(f".legend-buttons button:nth-child({place})") for place in (2, 3)
        )
        none.click()
        self.assertEqual(self.browser.value(strong), [])
        self.browser.find("#legend input[type=search]").send_keys("VERL")
        shown = [
            one
            for one in self.browser.driver.find_elements("css selector", "[data-method]")
            if one.is_displayed()
        ]
        self.assertEqual([one.text for one in shown], ["verlet"])
        shown[0].click()
        self.assertEqual(self.browser.value(strong), ["verlet"])
        self.browser.find("#legend input[type=search]").send_keys("?")
        self.assertIn("No method has it.", self.browser.text("#legend"))
        all_of_them.click()
        methods = self.browser.value("qddotReport.report.methods.length")
        self.assertEqual(len(self.browser.value(strong)), methods)
        none.click()
        self.assertGreater(self.browser.value(f"{CHART}.data[1].x.length"), 0)
        self.browser.find("#cloud").click()
        self.assertEqual(self.browser.value(f"{CHART}.data[1].x.length"), 0)

    def test_a_link_leads_to_its_run_and_rubbish_to_the_opening_one(self):
        opening = self.chosen
        point = self.point(f"i !== {opening} && points.outcome[i] === 'diverged'")
        self.choose(point)
        fragment = "#" + self.browser.driver.current_url.split("#")[1]
        self.browser.load(self.made, fragment)
        self.assertEqual(self.chosen, point)
        self.browser.load(self.made, "#run=%E0%A4%A&error=__proto__&against=constructor")
        self.assertEqual(self.chosen, opening)
        for rubbish in ("#%", "#run=verlet@", "#run=@@&error=__proto__", "#<b>", "#run=%E0%A4%A"):
            self.browser.driver.execute_async_script(
                "addEventListener('hashchange', () => arguments[1](), { once: true });"
                "location.hash = arguments[0];",
                rubbish,
            )
            self.assertEqual(self.chosen, opening, rubbish)


class Odd(Page):
    """Pages of odd folders and browsers."""

    def test_failures_only(self):
        def spoil(folder):
            failed = {"outcome": "diverged", "error_position": "", "time_s": ""}
            rows = [row | failed for row in read_table(folder / "points.csv")]
            write_table(folder / "points.csv", rows)
            for name in ("front.csv", "front.json", "motions.csv"):
                (folder / name).unlink()
            judge(folder)

        self.load(self.packed("failures", spoil))
        self.assertIn("No run gave a point", self.browser.text("#chart"))
        self.assertIn("No motions were kept.", self.browser.text("#motion"))
        point = self.browser.value("qddotReport.report.points.method.length - 1")
        self.move_to("failures-drawing", point)
        self.click(point)

    def test_hostile_names_are_words(self):
        def spoil_sidecar(content):
            content["scene"]["name"] = HOSTILE
            for method in content["methods"]:
                method["summary"] = {"onclick": "alert(3)"}

        def spoil(folder):
            rows = read_table(folder / "points.csv")
            first = rows[0]["method"]
            for row in rows:
                row["scene"] = HOSTILE
                row["method"] = HOSTILE if row["method"] == first else row["method"]
            write_table(folder / "points.csv", rows)
            edit_json(folder / "points.json", spoil_sidecar)
            edit_json(folder / "chart.json", lambda content: content.update(scene=HOSTILE))

        self.load(self.packed("hostile", spoil))
        self.assertEqual(self.browser.text("h1"), HOSTILE)
        self.assertEqual(self.browser.driver.title, f"{HOSTILE} – qddot report")
        method = "qddotReport.report.methods.findIndex(one => one.name === arguments[0])"
        self.choose(self.browser.value(f"qddotReport.runsOf[{method}][0]", HOSTILE))
        self.browser.find(".legend-buttons button:nth-child(2)").click()
        self.assertIn(HOSTILE, self.browser.text("#run-head"))
        self.assertEqual(self.browser.count("img[src=x], [onclick]"), 0)

    def test_a_telephone_needs_no_scrolling_sideways(self):
        screen = {"width": 400, "height": 800, "deviceScaleFactor": 2, "mobile": True}
        command = self.browser.driver.execute_cdp_cmd
        command("Emulation.setDeviceMetricsOverride", screen)
        self.addCleanup(command, "Emulation.clearDeviceMetricsOverride", {})
        self.load(self.made)
        self.browser.wait("document.querySelector('.views canvas') !== null")
        width, window = self.browser.value("[document.documentElement.scrollWidth, innerWidth]")
        self.assertEqual(window, 400)
        self.assertLessEqual(width, window)
        self.browser.find(".answers .pick").click()
        self.browser.find(".answers .chosen .see-run").click()
        # Scrolling is smooth: it takes a while.
        top = "document.getElementById('run').getBoundingClientRect().top"
        self.browser.wait(f"Math.abs({top}) < 100")

    def test_without_webgl_or_scripts_something_stands_in_its_place(self):
        other = self.another_browser(flags=("--disable-gpu", "--disable-3d-apis"))
        other.load(self.made)
        other.wait_for_words("#motion", "no WebGL")
        self.assertIn("What to take", other.text())
        other.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
        other.driver.get(self.made.as_uri())
        self.assertTrue(other.find("noscript table").is_displayed())
        self.assertIn("1e-4", other.text("noscript"))

    def test_without_decompression_a_sentence_stands_in_its_place(self):
        spoiled = self.made.with_name("old.html")
        page = self.made.read_text(encoding="utf-8")
        script = "<script>delete window.DecompressionStream</script>"
        spoiled.write_text(page.replace("<body>", f"<body>{script}", 1), encoding="utf-8")
        self.load(spoiled)
        self.browser.wait_for_words("#motion", "lacks DecompressionStream")
