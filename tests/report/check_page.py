#!/usr/bin/python3
"""Whether the page of a report does what it should in a real browser: Chromium without a screen."""

import unittest

from selenium.webdriver.common.keys import Keys

from browser import Browser
from check_page_motion import Moving  # They run with the tests of this file.
from made_sweeps import judge
from packed_folder import Folder
from page_in_browser import CHOSEN, Page

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&lt;"
RING = "return JSON.stringify(document.getElementById('chart-drawing').data.at(-1).x)"


class Choosing(Page):
    """What a reader does to find a run."""

    def test_a_mark_tells_its_run_on_hover_and_is_chosen_by_a_click(self):
        self.load(self.made)
        point = self.point("points.outcome[i] === 'reached_end' && points.error_position[i] < 1e-3")
        self.move_to("chart-drawing", point).click().perform()
        said = self.browser.text("#tooltip")
        for words in ("relative position error", "time of a run", "force evaluations"):
            self.assertIn(words, said)
        self.browser.wait("return qddotReport.state.run === arguments[0]", point)
        name = self.browser.run(
            "const { methods, points } = qddotReport.report;"
            "return methods[points.method[arguments[0]]].name",
            point,
        )
        self.assertIn(name, self.browser.text("#run-head"))
        self.assertIn(f"run={name}", self.browser.driver.current_url)
        self.assertNotEqual(self.browser.run(RING), "[]")

    def test_marks_answer_again_after_a_choice_that_had_none(self):
        self.load(self.made)
        self.browser.run("qddotReport.choose({ ordinate: 'none' })")
        self.assertIn("No run gave a point", self.browser.text("#chart"))
        self.browser.run("qddotReport.choose({ ordinate: 'time_s' })")
        point = self.point("points.outcome[i] === 'reached_end' && points.error_position[i] < 1e-3")
        self.move_to("chart-drawing", point).click().perform()
        self.browser.wait("return qddotReport.state.run === arguments[0]", point)
        # No run of the made folder has factorizations.
        offered = "return [...document.getElementById('ordinate').options].map(one => one.value)"
        self.assertNotIn("factorizations", self.browser.run(offered))
        self.assertIn("force_evaluations", self.browser.run(offered))

    def test_a_zoom_stays_until_it_is_undone(self):
        self.load(self.made)
        ranges = (
            "const { xaxis, yaxis } = document.getElementById('chart-drawing').layout;"
            "return [...xaxis.range, ...yaxis.range]"
        )
        whole = self.browser.run(ranges)
        # Upwards alone: one axis is enough.
        self.drag("#chart-drawing .nsewdrag", 0, 120)
        self.browser.wait("return !document.getElementById('whole').hidden")
        zoomed = self.browser.run(ranges)
        self.assertNotEqual(zoomed[2:], whole[2:])
        self.browser.find("#cloud").click()
        self.assertEqual(self.browser.run(ranges), zoomed)
        self.browser.driver.set_window_size(700, 900)
        self.addCleanup(self.browser.driver.set_window_size, 1400, 1000)
        narrow = "return document.getElementById('failures-drawing').layout.margin.l"
        fits = (
            "const drawing = document.getElementById('chart-drawing');"
            "return drawing._fullLayout.width === drawing.clientWidth"
        )
        before = self.browser.run(narrow)
        self.browser.driver.set_window_size(520, 900)
        self.browser.wait(f"{narrow} !== arguments[0]", before)
        self.assertTrue(self.browser.run(fits))
        self.assertEqual(self.browser.run(ranges), zoomed)
        self.browser.find("#whole").click()
        self.assertEqual(self.browser.run(ranges), whole)
        self.assertFalse(self.browser.find("#whole").is_displayed())

    def test_charts_on_paper_are_as_wide_as_the_sheet(self):
        self.load(self.made)
        width = "return document.querySelector('#chart-drawing .main-svg').clientWidth"
        wide = self.browser.run(width)
        self.browser.run("dispatchEvent(new Event('beforeprint'))")
        # A4 has 210 mm, less 14 mm on either side, at 96 px an inch.
        self.assertLessEqual(self.browser.run(width), (210 - 28) * 96 / 25.4)
        self.browser.run("dispatchEvent(new Event('afterprint'))")
        self.assertEqual(self.browser.run(width), wide)

    def test_a_failed_run_tells_its_cause_and_can_be_chosen(self):
        self.load(self.made)
        point = self.point("points.outcome[i] === 'diverged'")
        cause = self.browser.run("return qddotReport.report.points.cause[arguments[0]]", point)
        actions = self.move_to("failures-drawing", point)
        self.assertIn(cause, self.browser.text("#tooltip"))
        actions.click().perform()
        self.browser.wait("return qddotReport.state.run === arguments[0]", point)
        self.assertIn(cause, self.browser.text("#run-head"))

    def test_a_row_of_the_answers_is_chosen_by_enter(self):
        self.load(self.made)
        opening = self.browser.run(CHOSEN)
        row = self.browser.find(".answers tbody tr[data-point]:last-child")
        button = row.find_element("tag name", "button")
        button.send_keys(Keys.ENTER)
        point = int(row.get_attribute("data-point"))
        self.assertNotEqual(point, opening)
        self.assertEqual(self.browser.run(CHOSEN), point)
        self.assertEqual(button.get_attribute("aria-pressed"), "true")
        self.browser.driver.back()
        self.browser.wait("return qddotReport.state.run === arguments[0]", opening)
        self.browser.driver.forward()
        self.browser.wait("return qddotReport.state.run === arguments[0]", point)
        # The link to the answers leaves the run in the address.
        # The link shows only with the focus, and older drivers send no keys to what does not show.
        self.browser.run("document.querySelector('.skip').focus()")
        self.browser.driver.switch_to.active_element.send_keys(Keys.ENTER)
        self.browser.wait("return location.hash.includes('run=')")
        self.assertEqual(self.browser.run(CHOSEN), point)

    def test_every_answer_stands_in_the_table(self):
        self.load(self.made)
        shown = self.browser.run(
            "const rows = [...document.querySelectorAll('.answers tbody tr')];"
            "return rows.map(row => row.dataset.point)"
        )
        points = self.browser.run("return qddotReport.report.answers.map(answer => answer.point)")
        self.assertEqual(shown, [None if point is None else str(point) for point in points])

    def test_the_menus_lead_to_every_run_of_a_method(self):
        self.load(self.made)
        self.browser.find("#run-choice select").send_keys("verlet")
        self.browser.wait(
            "const { report, state } = qddotReport;"
            "return report.methods[report.points.method[state.run]].name === 'verlet'"
        )
        runs = "#run-choice label:nth-child(2)"
        self.assertIn("relative position error", self.browser.text(runs))
        self.browser.run("qddotReport.choose({ column: 'error_energy_max' })")
        self.assertNotIn("position", self.browser.text(runs))
        before = self.browser.run(CHOSEN)
        self.browser.find("#run-choice button[aria-label='Finer run']").click()
        self.assertNotEqual(self.browser.run(CHOSEN), before)

    def test_methods_are_switched_on_and_off(self):
        self.load(self.made)
        strong = (
            "return document.getElementById('chart-drawing').data.slice(2, -1).map(one => one.name)"
        )
        self.browser.find(".legend-buttons button:nth-child(3)").click()
        self.assertEqual(self.browser.run(strong), [])
        self.browser.find("#legend input[type=search]").send_keys("VERL")
        shown = [
            one
            for one in self.browser.driver.find_elements("css selector", "[data-method]")
            if one.is_displayed()
        ]
        self.assertEqual([one.text for one in shown], ["verlet"])
        shown[0].click()
        self.assertEqual(self.browser.run(strong), ["verlet"])
        self.browser.find("#legend input[type=search]").send_keys("?")
        self.assertIn("No method has it.", self.browser.text("#legend"))
        self.browser.find(".legend-buttons button:nth-child(2)").click()
        self.assertEqual(
            len(self.browser.run(strong)),
            self.browser.run("return qddotReport.report.methods.length"),
        )
        cloud = "return document.getElementById('chart-drawing').data[1].x.length"
        self.browser.find(".legend-buttons button:nth-child(3)").click()
        self.assertGreater(self.browser.run(cloud), 0)
        self.browser.find("#cloud").click()
        self.assertEqual(self.browser.run(cloud), 0)

    def test_quantities_and_ordinates_change_the_axes(self):
        self.load(self.made)
        for quantity in self.browser.run("return qddotReport.report.quantities"):
            self.browser.run(
                "const menu = document.getElementById('quantity'); menu.value = arguments[0];"
                "menu.dispatchEvent(new Event('change'))",
                quantity["column"],
            )
            title = self.browser.run(
                "return document.getElementById('chart-drawing').layout.xaxis.title.text"
            )
            self.assertIn(quantity["axis"], title)
            self.assertEqual(self.browser.text("#quantity-about"), quantity["subtitle"])
        self.browser.find("#ordinate").send_keys("force evaluations")
        self.browser.wait(
            "const { layout } = document.getElementById('chart-drawing');"
            "return layout.yaxis.title.text.includes('force evaluations')"
        )

    def test_a_link_leads_to_its_run_and_rubbish_to_the_opening_one(self):
        self.load(self.made)
        opening = self.browser.run(CHOSEN)
        point = self.point(f"i !== {opening} && points.outcome[i] === 'diverged'")
        self.choose(point)
        fragment = "#" + self.browser.driver.current_url.split("#")[1]
        self.browser.load(self.made, fragment)
        self.assertEqual(self.browser.run(CHOSEN), point)
        self.browser.load(self.made, "#run=%E0%A4%A&error=__proto__&against=constructor")
        self.assertEqual(self.browser.run(CHOSEN), opening)
        for rubbish in ("#%", "#run=verlet@", "#run=@@&error=__proto__", "#<b>", "#run=%E0%A4%A"):
            self.browser.driver.execute_async_script(
                "addEventListener('hashchange', () => arguments[1](), { once: true });"
                "location.hash = arguments[0];",
                rubbish,
            )
            self.assertEqual(self.browser.run(CHOSEN), opening, rubbish)


class Odd(Page):
    """Pages of odd folders and browsers."""

    def test_failures_only(self):
        def spoil(folder):
            table = Folder()
            table.folder = folder
            rows = table.rows()
            for row in rows:
                row.update(outcome="diverged", error_position="", time_s="")
            table.rewrite("points.csv", rows)
            for name in ("front.csv", "front.json", "motions.csv"):
                (folder / name).unlink()
            judge(folder)

        self.load(self.packed("failures", spoil))
        self.assertIn("No run gave a point", self.browser.text("#chart"))
        point = self.browser.run("return qddotReport.report.points.method.length - 1")
        self.move_to("failures-drawing", point).click().perform()
        self.browser.wait("return qddotReport.state.run === arguments[0]", point)

    def test_hostile_names_are_words(self):
        def spoil_methods(content):
            for method in content["methods"]:
                method["summary"] = {"onclick": "alert(3)"}

        def spoil(folder):
            table = Folder()
            table.folder = folder
            rows = table.rows()
            first = rows[0]["method"]
            for row in rows:
                row.update(
                    scene=HOSTILE, method=HOSTILE if row["method"] == first else row["method"]
                )
            table.rewrite("points.csv", rows)
            table.edit("points.json", lambda content: content["scene"].update(name=HOSTILE))
            table.edit("points.json", spoil_methods)
            table.edit("chart.json", lambda content: content.update(scene=HOSTILE))

        page = self.packed("hostile", spoil)
        self.load(page)
        self.assertEqual(self.browser.text("h1"), HOSTILE)
        self.assertEqual(self.browser.driver.title, f"{HOSTILE} – qddot report")
        method = self.browser.run(
            "return qddotReport.report.methods.findIndex(one => one.name === arguments[0])", HOSTILE
        )
        self.assertGreaterEqual(method, 0)
        self.choose(self.browser.run("return qddotReport.runsOf[arguments[0]][0]", method))
        self.browser.find(".legend-buttons button:nth-child(2)").click()
        self.assertIn(HOSTILE, self.browser.text("#run-head"))
        self.assertEqual(
            self.browser.run("return document.querySelectorAll('img[src=x], [onclick]').length"), 0
        )

    def test_a_telephone_needs_no_scrolling_sideways(self):
        self.browser.screen(400, 800)
        self.addCleanup(
            self.browser.driver.execute_cdp_cmd, "Emulation.clearDeviceMetricsOverride", {}
        )
        self.load(self.made)
        self.browser.wait("return document.querySelector('.views canvas') !== null")
        size = "return [document.documentElement.scrollWidth, innerWidth]"
        width, window = self.browser.run(size)
        self.assertEqual(window, 400)
        self.assertLessEqual(width, window)
        self.browser.find(".answers .pick").click()
        self.browser.find(".answers .chosen .see-run").click()
        # Scrolling is smooth: it takes a while.
        self.browser.wait(
            "return Math.abs(document.getElementById('run').getBoundingClientRect().top) < 100"
        )

    def test_without_webgl_a_sentence_stands_in_its_place(self):
        other = Browser(flags=("--disable-gpu", "--disable-3d-apis"))
        self.addCleanup(other.close)
        other.load(self.made)
        other.wait("return document.getElementById('motion').innerText.includes('no WebGL')")
        self.assertIn("What to take", other.text())

    def test_without_decompression_a_sentence_stands_in_its_place(self):
        spoiled = self.made.with_name("old.html")
        page = self.made.read_text(encoding="utf-8")
        spoiled.write_text(
            page.replace("<body>", "<body><script>delete window.DecompressionStream</script>", 1),
            encoding="utf-8",
        )
        self.load(spoiled)
        self.browser.wait(
            "const { innerText } = document.getElementById('motion');"
            "return innerText.includes('lacks DecompressionStream')"
        )

    def test_without_scripts_chart_and_table_stand_there(self):
        other = Browser()
        self.addCleanup(other.close)
        other.driver.execute_cdp_cmd("Emulation.setScriptExecutionDisabled", {"value": True})
        other.driver.get(self.made.as_uri())
        self.assertTrue(other.find("noscript table").is_displayed())
        self.assertIn("1e-4", other.text("noscript"))


if __name__ == "__main__":
    unittest.main()
