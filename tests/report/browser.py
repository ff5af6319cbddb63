"""Pages of made folders, through the real packer, in Chromium without a screen."""

import json
import tempfile
import unittest
from pathlib import Path

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

import made_folder
from packed_folder import pack

# Waits are for conditions; this is only how long a test may hang on a busy machine.
PATIENCE = 120
SOFTWARE_GL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
QUIET = (
    "--headless=new --no-sandbox --disable-gpu-sandbox --disable-dev-shm-usage"
    " --disable-background-networking --disable-component-update --disable-default-apps"
    " --disable-extensions --disable-sync --no-first-run --window-size=1400,1000"
).split()
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


class Browser:
    """A window; `flags` are further options of Chromium. It tells what a page asked for and what it
    complained of."""

    def __init__(self, flags=SOFTWARE_GL):
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for flag in (*QUIET, *flags):
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.driver.set_page_load_timeout(PATIENCE)
        self.driver.set_script_timeout(PATIENCE)

    def load(self, path, fragment=""):
        """Loads a file, afresh, and waits until its page is drawn."""
        self.driver.get("about:blank")
        self.logs()
        self.driver.get(f"{path.as_uri()}{fragment}")
        self.wait("document.documentElement.dataset.drawn === 'yes'")

    def run(self, script, *arguments):
        """The value that a script returns in the page."""
        return self.driver.execute_script(script, *arguments)

    def value(self, expression, *arguments):
        """The value of an expression in the page."""
        return self.run(f"return {expression}", *arguments)

    def wait(self, expression, *arguments):
        """Waits until an expression is true."""
        WebDriverWait(self.driver, PATIENCE, 0.05).until(
            lambda _: self.value(expression, *arguments), expression
        )

    def find(self, selector):
        """The first element that a selector names."""
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def text(self, selector="body"):
        """The words that are to be seen of an element."""
        return self.find(selector).text

    def wait_for_words(self, selector, words):
        """Waits until an element shows these words."""
        self.wait(f"document.querySelector('{selector}').innerText.includes(arguments[0])", words)

    def count(self, selector):
        """How many elements a selector names."""
        return self.value("document.querySelectorAll(arguments[0]).length", selector)

    def logs(self):
        """The console's words, and the addresses that were asked for, since the last call."""
        said = [entry["message"] for entry in self.driver.get_log("browser")]
        events = [
            json.loads(entry["message"])["message"] for entry in self.driver.get_log("performance")
        ]
        asked = [
            event["params"]["request"]["url"]
            for event in events
            if event["method"] == "Network.requestWillBeSent"
        ]
        return said, [url for url in asked if not url.startswith(("data:", "about:"))]


class Page(unittest.TestCase):
    """A test of pages: one browser for all tests of a class."""

    @classmethod
    def setUpClass(cls):
        cls.browser = cls.another_browser()
        cls.home = Path(cls.enterClassContext(tempfile.TemporaryDirectory()))
        cls.made = cls.packed("made")

    @classmethod
    def another_browser(cls, **options):
        """A browser that ends with the class."""
        browser = Browser(**options)
        cls.addClassCleanup(browser.driver.quit)
        return browser

    @classmethod
    def packed(cls, name, change=lambda folder: None, **options):
        """The page of a made folder; `change` may spoil the folder before it is packed."""
        folder = cls.home / name
        made_folder.make_folder(folder, **{"side": 5, "frames": 8, "runs": 5, **options})
        change(folder)
        assert pack(folder) == (0, "")
        return folder / "report.html"

    def load(self, path, fragment=""):
        """Loads a page; at the end of the test it must have asked for nothing and complained of
        nothing."""
        self.browser.load(path, fragment)
        self.addCleanup(self.check_logs, path)

    def check_logs(self, path):
        """Compares what was asked for with the one file."""
        said, asked = self.browser.logs()
        self.assertEqual((said, {url.split("#")[0] for url in asked}), ([], {path.as_uri()}))

    @property
    def chosen(self):
        """The run that is chosen."""
        return self.browser.value("qddotReport.state.run")

    def wait_until_chosen(self, point):
        """Waits until a run is chosen."""
        self.browser.wait("qddotReport.state.run === arguments[0]", point)

    def point(self, condition):
        """The first run for which a condition in JavaScript of `points` and `i` holds."""
        found = self.browser.run(
            "const points = qddotReport.report.points;"
            f"return points.method.findIndex((_, i) => {condition})"
        )
        self.assertGreaterEqual(found, 0, condition)
        return found

    def move_to(self, drawing, point):
        """Moves the pointer onto a run's mark; what the page says there."""
        place = self.browser.driver.execute_async_script(PLACE, drawing, point)
        self.assertIsNotNone(place)
        actions = ActionChains(self.browser.driver)
        actions.w3c_actions.pointer_action.move_to_location(*place)
        actions.perform()
        box = "document.getElementById('tooltip')"
        self.browser.wait(f"!{box}.hidden && Number({box}.dataset.point) === arguments[0]", point)
        return self.browser.text("#tooltip")

    def click(self, point):
        """Clicks on the run's mark that the pointer is on; what the page then says of the run."""
        ActionChains(self.browser.driver).click().perform()
        self.wait_until_chosen(point)
        return self.browser.text("#run-head")

    def choose(self, point):
        """Chooses a run and waits for what belongs to it."""
        self.browser.run("qddotReport.choose({run: arguments[0]})", point)
        self.assertEqual(self.chosen, point)
