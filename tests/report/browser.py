"""Chromium without a screen, which tells what a page asked for and what it complained of."""

import json

from selenium import webdriver
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.common.by import By
from selenium.webdriver.support.ui import WebDriverWait

# Waits are for conditions; this is only how long a test may hang on a busy machine.
PATIENCE = 120
SOFTWARE_GL = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
QUIET = (
    "--headless=new",
    "--no-sandbox",
    "--disable-gpu-sandbox",
    "--disable-dev-shm-usage",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-extensions",
    "--disable-sync",
    "--no-first-run",
)


class Browser:
    """A window of `width` x `height` px; `flags` are further options of Chromium."""

    def __init__(self, width=1400, height=1000, flags=SOFTWARE_GL):
        options = webdriver.ChromeOptions()
        options.binary_location = "/usr/bin/chromium"
        for flag in (*QUIET, f"--window-size={width},{height}", *flags):
            options.add_argument(flag)
        options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
        self.driver = webdriver.Chrome(service=Service("/usr/bin/chromedriver"), options=options)
        self.driver.set_page_load_timeout(PATIENCE)
        self.driver.set_script_timeout(PATIENCE)

    def close(self):
        """Ends Chromium."""
        self.driver.quit()

    def screen(self, width, height):
        """Takes the screen of a telephone."""
        values = {"width": width, "height": height, "deviceScaleFactor": 2, "mobile": True}
        self.driver.execute_cdp_cmd("Emulation.setDeviceMetricsOverride", values)

    def load(self, path, fragment=""):
        """Loads a file, afresh, and waits until its page is drawn."""
        self.driver.get("about:blank")
        self.logs()
        self.driver.get(f"{path.as_uri()}{fragment}")
        self.wait("return document.documentElement.dataset.drawn === 'yes'")

    def run(self, script, *arguments):
        """What a script returns in the page."""
        return self.driver.execute_script(script, *arguments)

    def wait(self, script, *arguments):
        """Waits until a script returns something true, and returns that."""
        return WebDriverWait(self.driver, PATIENCE, 0.05).until(
            lambda driver: driver.execute_script(script, *arguments), script
        )

    def find(self, selector):
        """The first element that a selector names."""
        return self.driver.find_element(By.CSS_SELECTOR, selector)

    def text(self, selector="body"):
        """The words that are to be seen of an element."""
        return self.find(selector).text

    def logs(self):
        """What the console said, and the addresses that were asked for, since the last call."""
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
