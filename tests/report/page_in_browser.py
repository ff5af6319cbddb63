"""Pages of made folders, through the real packer, in a real browser."""

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

from selenium.webdriver.common.action_chains import ActionChains

import made_folder
import report
from browser import Browser

CHOSEN = "return qddotReport.state.run"
# The place of a run's mark in the window, in px, once it is scrolled into view.
PLACE = """
const [id, wanted, done] = arguments;
const drawing = document.getElementById(id);
const marks = [...drawing.querySelectorAll(".scatterlayer .point")];
const runOf = (mark) => mark.closest(".trace").__data__[0].trace.customdata?.[mark.__data__.i];
const mark = marks.find((one) => runOf(one) === wanted);
if (!mark) done(null);
mark.scrollIntoView({ block: "center" });
// The page hides what stands beside the pointer when it hears of scrolling, a frame later.
requestAnimationFrame(() => requestAnimationFrame(() => {
  const box = mark.getBoundingClientRect();
  done([Math.round(box.x + box.width / 2), Math.round(box.y + box.height / 2)]);
}));
"""


class Page(unittest.TestCase):
    """A test of pages: one browser for all tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls.browser = Browser()
        cls.addClassCleanup(cls.browser.close)
        cls.home = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.made = cls.packed("made")

    @classmethod
    def packed(cls, name, change=lambda folder: None, **options):
        """The page of a made folder; `change` may spoil the folder before it is packed."""
        folder = cls.home / name
        made_folder.make_folder(folder, **{"side": 5, "frames": 8, "runs": 5, **options})
        change(folder)
        with contextlib.redirect_stderr(io.StringIO()) as said:
            status = report.main([str(folder)])
        assert status == 0, said.getvalue()
        return folder / "report.html"

    def load(self, path, fragment=""):
        """Loads a page; at the end of the test it must have asked for nothing and complained of
        nothing."""
        self.browser.load(path, fragment)
        self.addCleanup(self.check_logs, path)

    def check_logs(self, path):
        """Compares what was asked for with the one file."""
        said, asked = self.browser.logs()
        self.assertEqual(said, [])
        self.assertEqual({url.split("#")[0] for url in asked}, {path.as_uri()})

    def point(self, condition):
        """The first run for which a condition in JavaScript of `points` and `i` holds."""
        found = self.browser.run(
            "const points = qddotReport.report.points;"
            f"return points.method.findIndex((_, i) => {condition})"
        )
        self.assertGreaterEqual(found, 0, condition)
        return found

    def move_to(self, drawing, point):
        """Moves the pointer onto a run's mark."""
        place = self.browser.driver.execute_async_script(PLACE, drawing, point)
        self.assertIsNotNone(place)
        actions = ActionChains(self.browser.driver)
        actions.w3c_actions.pointer_action.move_to_location(*place)
        actions.perform()
        self.browser.wait(
            "const box = document.getElementById('tooltip');"
            "return !box.hidden && Number(box.dataset.point) === arguments[0]",
            point,
        )
        return actions

    def drag(self, selector, across, up):
        """Drags from a place in an element, right of and below its middle."""
        actions = ActionChains(self.browser.driver)
        node = self.browser.find(selector)
        self.browser.run("arguments[0].scrollIntoView({ block: 'center' })", node)
        actions.move_to_element_with_offset(node, 50, 50).click_and_hold()
        actions.move_by_offset(across, -up).release().perform()

    def choose(self, point):
        """Chooses a run and waits for what belongs to it."""
        self.browser.run("qddotReport.choose({run: arguments[0]})", point)
        self.assertEqual(self.browser.run(CHOSEN), point)
