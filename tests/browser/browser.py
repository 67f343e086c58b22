"""Headless Chromium on a page from disk, and a folder of results to make the page of."""

from __future__ import annotations

import json
import os
import sys
import tempfile
import unittest
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT), str(ROOT / "tests" / "analysis")]

from selenium import webdriver
from selenium.webdriver.chrome.options import Options
from selenium.webdriver.chrome.service import Service
from selenium.webdriver.remote.webelement import WebElement

CHROMIUM, DRIVER = "/usr/bin/chromium", "/usr/bin/chromedriver"  # Debian's, so that nothing is downloaded


def start() -> webdriver.Chrome:
    options = Options()
    options.binary_location = CHROMIUM
    for argument in ("--headless=new", "--disable-gpu", "--disable-dev-shm-usage", "--hide-scrollbars"):
        options.add_argument(argument)
    if os.geteuid() == 0:
        options.add_argument("--no-sandbox")  # Chromium has none for root
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    return webdriver.Chrome(service=Service(DRIVER), options=options)


class BrowserTest(unittest.TestCase):
    """One browser for all tests of a class; each test opens the page anew."""

    browser: webdriver.Chrome
    page: Path

    @classmethod
    def setUpClass(cls) -> None:
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.page = cls.make_page()
        cls.browser = start()
        cls.addClassCleanup(cls.browser.quit)

    @classmethod
    def make_page(cls) -> Path:
        raise NotImplementedError

    def open(self, width: int = 1280, height: int = 900, scheme: str = "light") -> None:
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600})
        self.browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                                     {"features": [{"name": "prefers-color-scheme", "value": scheme}]})
        self.browser.get(self.page.as_uri())

    def run_js(self, script: str, *arguments: Any) -> Any:
        return self.browser.execute_script(script, *arguments)

    def find(self, selector: str) -> WebElement:
        return self.browser.find_element("css selector", selector)

    def find_all(self, selector: str) -> list[WebElement]:
        return self.browser.find_elements("css selector", selector)

    def until(self, script: str) -> Any:
        """Waits at most five seconds for the script to return something true."""
        found = self.browser.execute_async_script(
            "const done = arguments[0], begin = Date.now(), look = () => { const found = (() => {" + script + "})();"
            "if (found || Date.now() - begin > 5000) done(found); else setTimeout(look, 20); }; look();")
        self.assertTrue(found, script)
        return found

    def requested(self) -> list[str]:
        """The addresses that the page asked for since the last call, its own among them."""
        entries = [json.loads(entry["message"])["message"] for entry in self.browser.get_log("performance")]
        return [entry["params"]["request"]["url"] for entry in entries if entry["method"] == "Network.requestWillBeSent"]

    def complaints(self) -> list[str]:
        return [entry["message"] for entry in self.browser.get_log("browser")]
