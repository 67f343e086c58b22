"""The report page as its readers use it: opened from disk, clicked, dragged and typed at."""

import unittest
from pathlib import Path

import numpy as np
from browser import BrowserTest  # first: it puts the others on the path
from page_results import FIREFLY, fail_run, picture, read_fields, write_page_results
from support import write_csv
from selenium.webdriver.common.action_chains import ActionChains
from selenium.webdriver.common.actions.wheel_input import ScrollOrigin
from selenium.webdriver.common.keys import Keys

from analysis import report_page

FAILED = "scene=occluded,method=rl,seed=3"


class PageTest(BrowserTest):
    @classmethod
    def make_page(cls) -> Path:
        results = write_page_results(cls.folder / "study", side=16)
        fail_run(results, FAILED, "failed", "frame 3 took longer than frame_timeout_s", 2)
        configurations = read_fields(results / "configurations.csv")
        configurations[0]["relmse"] = "0.12512345678901234"  # more digits than anybody would show
        write_csv(results / "configurations.csv", configurations)
        page = cls.folder / "elsewhere" / "a page.html"
        report_page.main([str(results), "--out", str(page)])
        return page

    def setUp(self) -> None:
        self.requested(), self.complaints()
        self.open()

    def tearDown(self) -> None:
        self.assertEqual(self.complaints(), [])
        self.assertEqual({url for url in self.requested() if not url.startswith(("data:", "blob:"))}, {self.page.as_uri()})

    def column(self, name: str) -> list[str]:
        heads = [head.text.replace("\n", " ").strip(" ↕↑↓") for head in self.find_all("#configurations-table thead th")]
        place = heads.index(name)
        return self.run_js("return [...document.querySelectorAll('#configurations-table tbody tr')].map("
                           "row => row.cells[arguments[0]].dataset.value)", place)

    def press_heading(self, name: str) -> str:
        for head in self.find_all("#configurations-table thead th"):
            if head.text.replace("\n", " ").strip(" ↕↑↓") == name:
                head.find_element("css selector", "button").send_keys(Keys.ENTER)
                return head.get_attribute("aria-sort") or "none"
        raise AssertionError(name)


class FirstLookTest(PageTest):
    def test_failures_stand_first(self) -> None:
        first = self.find("main > section:first-child .findings > li:first-child")
        self.assertIn("1 of 18 runs failed", first.text)
        self.assertIn(f"{FAILED}: frame 3 took longer than frame_timeout_s", first.text)
        self.assertEqual(first.get_attribute("class"), "failed")

    def test_nothing_is_wider_than_a_telephone(self) -> None:
        for width in (390, 1280):
            self.open(width)
            self.assertLessEqual(self.run_js("return document.documentElement.scrollWidth"), width)

    def test_theme_follows_the_system_until_told_otherwise(self) -> None:
        background = "return getComputedStyle(document.body).backgroundColor"
        light = self.run_js(background)
        self.open(scheme="dark")
        dark = self.run_js(background)
        self.assertNotEqual(light, dark)
        button = self.find("#theme")
        for expected in (("Theme: light", light), ("Theme: dark", dark), ("Theme: auto", dark)):
            button.click()
            self.assertEqual((button.text, self.run_js(background)), expected)

    def test_every_control_has_a_name(self) -> None:
        nameless = self.run_js("""return [...document.querySelectorAll('button, select, input, [tabindex="0"]')].filter(it =>
            !(it.getAttribute('aria-label') || it.textContent.trim() && it.tagName !== 'SELECT' || it.labels?.length
              || it.closest('pre'))).map(it => it.outerHTML.slice(0, 80))""")
        self.assertEqual(nameless, [])

    def test_focus_is_visible(self) -> None:
        self.find("body").send_keys(Keys.TAB)
        self.assertEqual(self.run_js("return getComputedStyle(document.activeElement).outlineStyle"), "solid")


class TableTest(PageTest):
    def test_sorting_up_down_and_back(self) -> None:
        name = "host ms/frame"  # 250, 500 and 1000, which letters would sort otherwise
        values = [row["host_ms_median"] for row in read_fields(self.folder / "study" / "configurations.csv")]
        self.assertEqual(self.column(name), values)
        self.assertEqual(self.press_heading(name), "ascending")
        self.assertEqual(self.column(name), sorted(values, key=float))
        self.assertEqual(self.press_heading(name), "descending")
        self.assertEqual(self.column(name), sorted(values, key=float, reverse=True))
        self.assertEqual(self.press_heading(name), "none")
        self.assertEqual(self.column(name), values)

    def test_filter(self) -> None:
        self.find('[data-filters="configurations-table"]').send_keys("occl rl")
        shown = [row.text for row in self.find_all("#configurations-table tbody tr") if row.is_displayed()]
        self.assertEqual(len(shown), 1)

    def test_pointing_shows_all_digits(self) -> None:
        row = read_fields(self.folder / "study" / "configurations.csv")[0]
        field = self.find(f'#configurations-table td[data-value="{row["relmse"]}"]')
        ActionChains(self.browser).move_to_element(field).perform()
        self.assertEqual(self.find(".tip").text, f"{row['relmse']} [{row['relmse_low']}, {row['relmse_high']}]")


class CurvesTest(PageTest):
    def tip_after(self, *keys: str) -> str:
        chart = self.find("#curve-panels .chart")
        chart.send_keys(*keys)
        return self.find(".tip").text

    def test_arrow_keys_walk_along_a_line_to_the_digits_of_configurations_csv(self) -> None:
        row = read_fields(self.folder / "study" / "configurations.csv")[0]
        self.assertIn("1 spp", self.tip_after(Keys.ARROW_RIGHT))
        lines = self.tip_after(*[Keys.ARROW_RIGHT] * 3).split("\n")
        self.assertEqual(lines[0], row["configuration"])
        self.assertEqual(float(lines[2].removeprefix("relMSE ")), float(row["relmse"]))
        low, high = lines[3].removeprefix("95 %: ").split(" to ")
        self.assertEqual((float(low), float(high)), (float(row["relmse_low"]), float(row["relmse_high"])))
        self.assertIn("BSDF", self.tip_after(Keys.ARROW_DOWN))

    def test_pointing_at_a_marker_names_its_point(self) -> None:
        marker = self.find('#curve-panels [data-label="RL"] .marker')
        self.run_js("arguments[0].scrollIntoView({block: 'center'})", marker)
        ActionChains(self.browser).move_to_element(marker).perform()
        self.assertRegex(self.find(".tip").text, r"^simple / RL\n1 spp, ")

    def test_the_legend_takes_lines_away(self) -> None:
        count = "return document.querySelectorAll('#curve-panels [data-label=\"BSDF\"] .line').length"
        self.assertEqual(self.run_js(count), 4)  # two scenes, samples and seconds
        button = self.find('.legend [data-label="BSDF"]')
        button.click()
        self.assertEqual((self.run_js(count), button.get_attribute("aria-pressed")), (0, "false"))
        self.assertEqual(len(self.find_all('#speed-plot [data-label="BSDF"]')), 0)
        second = self.find('#speed .legend [data-label="BSDF"]')
        self.assertEqual(second.get_attribute("aria-pressed"), "false")
        second.click()
        self.assertEqual((self.run_js(count), button.get_attribute("aria-pressed")), (4, "true"))

    def test_metrics_and_the_reference_floor(self) -> None:
        self.assertEqual(len(self.find_all("#curve-panels .floor")), 4)
        self.run_js("const s = document.querySelector('#metric'); s.value = 'mape'; s.dispatchEvent(new Event('change'))")
        self.assertEqual(len(self.find_all("#curve-panels .floor")), 0)
        self.assertIn("MAPE", self.find("#curve-panels .chart").text)

    def test_every_configuration_is_a_point_of_speed_against_error(self) -> None:
        self.assertEqual(len(self.find_all("#speed-plot .marker")), 6)


class ImagesTest(PageTest):
    def setUp(self) -> None:
        super().setUp()
        self.stage = self.find(".stage")
        self.run_js("arguments[0].scrollIntoView({block: 'center'})", self.stage)
        self.painted("1 image 0")

    def painted(self, what: str, pane: int = 1) -> None:
        self.until(f"return document.querySelectorAll('.pane')[{pane}]?.dataset.painted === '{what}'")

    def canvas_pixel(self, x: int, y: int, pane: int) -> list[int]:
        """By way of a canvas that is made for reading: Chromium warns of others."""
        return self.run_js("const copy = new OffscreenCanvas(16, 16).getContext('2d', {willReadFrequently: true});"
                           "copy.drawImage(document.querySelectorAll('.pane canvas')[arguments[2]], 0, 0);"
                           "return [...copy.getImageData(arguments[0], arguments[1], 1, 1).data].slice(0, 3)", x, y, pane)

    def screen(self, value: float, stops: float = 0) -> int:
        linear = min(1.0, max(0.0, value * 2 ** stops))
        return round(255 * (12.92 * linear if linear <= 0.0031308 else 1.055 * linear ** (1 / 2.4) - 0.055))

    def reference_screen(self, x: int, y: int, stops: float = 0) -> list[int]:
        image = picture(16, 0, 0)
        return [self.screen(float(image[name][y, x]), stops) for name in "RGB"]

    def assert_near(self, found: list[int], expected: list[int]) -> None:
        self.assertLessEqual(max(abs(a - b) for a, b in zip(found, expected)), 1)

    def test_exposure_scales_radiance_before_srgb(self) -> None:
        self.painted("0 image 0", 0)
        self.assert_near(self.canvas_pixel(3, 1, 0), self.reference_screen(3, 1))
        self.run_js("const s = document.querySelector('#exposure'); s.value = -2; s.dispatchEvent(new Event('input'))")
        self.painted("0 image -2", 0)
        self.assert_near(self.canvas_pixel(3, 1, 0), self.reference_screen(3, 1, -2))
        self.assertEqual(self.find("#exposure-value").text, "−2 EV")
        self.stage.send_keys("]")
        self.painted("0 image -1.5", 0)
        self.find("#exposure-auto").click()
        image = picture(16, 0, 0)
        stops = np.log2(0.18) - np.mean([np.log2(image[name]) for name in "RGB"])
        self.assertAlmostEqual(float(self.find("#exposure").get_attribute("value")), stops, delta=0.13)

    def test_the_wipe_slider_and_its_handle_cut_the_second_image(self) -> None:
        clip = "return document.querySelector('.pane.second').style.clipPath"
        self.assertEqual(self.run_js(clip), "inset(0px 0px 0px 50%)")
        self.find("#wipe").send_keys(*[Keys.ARROW_RIGHT] * 4)
        self.assertEqual(self.run_js(clip), "inset(0px 0px 0px 52%)")
        width = self.stage.size["width"]
        ActionChains(self.browser).drag_and_drop_by_offset(self.find(".divider"), int(-0.27 * width), 0).perform()
        self.assertAlmostEqual(float(self.find("#wipe").get_attribute("value")), 25, delta=1)

    def test_flip_shows_one_image_at_a_time(self) -> None:
        shown = ("return [...document.querySelectorAll('.pane')].filter(p => getComputedStyle(p).visibility === 'visible')"
                 ".map(p => p.querySelector('.name').textContent)")
        self.find('[data-mode="flip"]').click()
        self.assertEqual(self.run_js(shown), ["NEE, two rays"])
        self.stage.send_keys("f")
        self.assertEqual(self.run_js(shown), ["reference"])
        self.find("#flip-now").click()
        self.assertEqual(self.run_js(shown), ["NEE, two rays"])

    def test_the_readout_has_the_pixel_in_every_image(self) -> None:
        self.until("return [...document.querySelectorAll('.readout tbody tr')].length === 4")
        box = self.stage.rect
        at = (int((5.5 / 16 - 0.5) * box["width"]), int((2.5 / 16 - 0.5) * box["height"]))
        ActionChains(self.browser).move_to_element_with_offset(self.stage, *at).perform()
        self.assertEqual(self.find("#pixel-place").text, "Pixel 5, 2")
        rows = [[field.text for field in row.find_elements("css selector", "th, td")]
                for row in self.find_all("#images .viewer .readout tr.shown, #images .viewer .readout tbody tr")]
        self.assertEqual([row[0] for row in rows], ["reference", "NEE, two rays", "BSDF", "RL"])
        image = picture(16, 0, 0)
        truth = [float(image[name][2, 5]) for name in "RGB"]
        for text, value in zip(rows[0][1:4], truth):
            self.assertAlmostEqual(float(text) / value, 1, delta=1e-3)
        self.assertEqual(rows[0][4], "")
        values = [float(text) for text in rows[2][1:4]]
        error = sum((a - r) ** 2 / (r ** 2 + 0.01) for a, r in zip(values, truth)) / 3
        self.assertAlmostEqual(float(rows[2][4]) / error, 1, delta=0.05)
        self.stage.send_keys(Keys.ARROW_RIGHT, Keys.ARROW_DOWN)
        self.assertEqual(self.find("#pixel-place").text, "Pixel 6, 3")

    def test_zoom_is_the_same_in_all_panes(self) -> None:
        self.find('[data-mode="side"]').click()
        transforms = "return [...document.querySelectorAll('.pane canvas')].map(c => c.style.transform)"
        before = self.run_js(transforms)
        self.find("#zoom-in").click()
        ActionChains(self.browser).drag_and_drop_by_offset(self.find(".pane"), 40, 25).perform()
        first, second = self.run_js(transforms)
        self.assertEqual(first, second)
        self.assertNotEqual(first, before[0])
        self.stage.send_keys("0")
        self.assertEqual(self.run_js(transforms), before)
        self.assertIs(self.run_js("return document.activeElement === arguments[0]", self.stage), True)
        ActionChains(self.browser).scroll_from_origin(ScrollOrigin.from_element(self.stage), 0, -300).perform()
        self.until(f"return document.querySelector('.pane canvas').style.transform !== '{before[0]}'")

    def test_all_methods_at_once_and_the_error_map(self) -> None:
        self.find('[data-mode="all"]').click()
        self.assertEqual([name.text for name in self.find_all(".pane .name")], ["reference", "NEE, two rays", "BSDF", "RL"])
        self.find('[data-show="error"]').click()
        self.painted("2 error", 2)
        self.painted("0 image 0", 0)
        self.assertTrue(self.find("#error-scale").is_displayed())

    def test_fireflies_are_marked_where_their_manifest_says(self) -> None:
        self.find("#fireflies").click()
        mark = self.find(".pane.second .firefly:not(.under)")
        scale = self.stage.size["width"] / 16
        self.assertAlmostEqual(float(mark.get_attribute("cx")), (FIREFLY["x"] + 0.5) * scale, delta=0.6)
        self.assertAlmostEqual(float(mark.get_attribute("cy")), (FIREFLY["y"] + 0.5) * scale, delta=0.6)
        self.find("#firefly-list summary").click()
        self.find("#firefly-list button").click()
        self.assertEqual(self.find("#pixel-place").text, "Pixel 5, 2")
        self.assertIn("118", self.find("#firefly-list tbody").text)

    def test_the_name_of_a_row_shows_its_image(self) -> None:
        link = self.find('#configurations-table tr[data-key="occluded / BSDF"] a')
        link.send_keys(Keys.ENTER)
        self.painted("2 image 0")
        self.assertIn("B: scene=occluded,method=bsdf,seed=1, frame 8", self.find("#sources").text)

    def test_another_scene_and_another_method(self) -> None:
        self.run_js("const s = document.querySelector('#gallery'); s.value = 1; s.dispatchEvent(new Event('change'))")
        self.stage.send_keys("3")
        self.painted("3 image 0")
        self.assertIn("B: scene=occluded,method=rl,seed=1, frame 8", self.find("#sources").text)


if __name__ == "__main__":
    unittest.main()
