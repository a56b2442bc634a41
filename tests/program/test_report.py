"""scripts/report.py: what its page says is what the tables say, and a browser shows it."""

import html
import json
import pathlib
import re
import shutil
import subprocess
import sys
import time
import unittest

from program import ProgramTest, read_table

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "report.py"
sys.path.insert(0, str(SCRIPT.parent))

from reporting.page import missing_packages  # noqa: E402

LARGEST_FILE = 15e6  # [byte]
SWEEP = ("Study=sweep", "Sweep/First friction coefficient=0", "Sweep/Last friction coefficient=0.4", "Sweep/Number of friction coefficients=5")


def browser(width):
    """Chromium without a screen, or nothing."""
    try:
        from selenium import webdriver
        from selenium.webdriver.chrome.options import Options
        from selenium.webdriver.chrome.service import Service
    except ImportError:
        return None
    driver = shutil.which("chromedriver")
    if not driver or not shutil.which("chromium"):
        return None
    options = Options()
    for argument in ("--headless=new", "--no-sandbox", "--disable-dev-shm-usage", "--use-angle=swiftshader", "--enable-unsafe-swiftshader",
                     f"--window-size={width},900"):
        options.add_argument(argument)
    # Windows have a least width, screens of telephones do not
    options.add_experimental_option("mobileEmulation", {"deviceMetrics": {"width": width, "height": 900, "pixelRatio": 1.0}})
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(driver), options=options)


@unittest.skipIf(missing_packages(), "missing packages: " + " ".join(missing_packages()))
class Reports(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.stability = cls.run_scene("stability", "Output/Mode shapes=unstable")
        cls.sweep = cls.run_scene("sweep", *SWEEP)
        for folder in (cls.stability, cls.sweep):
            process = subprocess.run([sys.executable, "-B", SCRIPT, folder], capture_output=True, text=True, check=False)
            if process.returncode != 0:
                raise AssertionError(process.stderr)

    def page(self, folder):
        return (folder / "report.html").read_text(encoding="utf-8")

    def data(self, folder):
        return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', self.page(folder), re.S)[1])

    def verdict(self, folder):
        return html.unescape(re.search(r'<h1 id="verdict">(.*?)</h1>', self.page(folder))[1])

    def test_verdict(self):
        rows = read_table(self.stability / "complex_modes.csv")
        growing = [row for row in rows if row["unstable [-]"] == "1"]
        worst = max(growing, key=lambda row: float(row["divergence rate [%]"]))
        words = self.verdict(self.stability)
        self.assertTrue(words.startswith(f"{len(growing)} of the {len(rows)} modes up to 5000 Hz at μ = 0.4 grow"), words)
        self.assertIn(f"{worst['label']} at {float(worst['frequency [Hz]']):.0f} Hz", words)
        self.assertIn('<header class="unstable">', self.page(self.stability))

        rows = [row for row in read_table(self.sweep / "branches.csv") if float(row["divergence rate [%]"]) > 0.01]
        words = self.verdict(self.sweep)
        self.assertTrue(words.startswith(f"{len({row['branch [-]'] for row in rows})} modes grow by more than 0.01 %"), words)
        self.assertIn(f"from μ = {min(float(row['mu [-]']) for row in rows):.3g} on", words)

    def test_charts(self):
        """As many curves as branches, as many marks as modes."""
        rows = read_table(self.stability / "complex_modes.csv")
        damping, = self.data(self.stability)["charts"]
        self.assertEqual([len(trace["x"]) for trace in damping["data"]],
                         [sum(row["unstable [-]"] == flag for row in rows) for flag in ("0", "1")])
        for trace, flag in zip(damping["data"], ("0", "1")):
            self.assertEqual(trace["y"], [float(row["effective damping ratio -2R/omega [%]"]) for row in rows if row["unstable [-]"] == flag])
        charts = {chart["id"]: chart for chart in self.data(self.sweep)["charts"]}
        rows = read_table(self.sweep / "branches.csv")
        curves = charts["branches"]["data"][:-2]
        self.assertEqual(len(curves), len({row["branch [-]"] for row in rows}))
        self.assertEqual(sum(len(trace["x"]) for trace in curves), len(rows))
        events = read_table(self.sweep / "thresholds.csv")
        self.assertEqual(sum(len(trace["x"]) for trace in charts["branches"]["data"][-2:]), len(events))
        # Of two modes that meet, both have the frequency of the threshold there
        first, second = charts["bifurcations"]["data"][:2]
        event = next(row for row in events if first["name"].startswith(f"{row['label']} and {row['label of partner']}, "
                                                                       f"{float(row['frequency [Hz]']):.0f} Hz"))
        for curve in (first, second):
            at = min(range(len(curve["x"])), key=lambda i: abs(curve["x"][i] - float(event["mu [-]"])))
            self.assertLess(abs(curve["y"][at]), 0.1 * max(map(abs, first["y"] + second["y"])))

    def test_energy_and_shapes(self):
        data = self.data(self.stability)
        growing = [i for i, row in enumerate(read_table(self.stability / "complex_modes.csv"), start=1) if row["unstable [-]"] == "1"]
        self.assertEqual([entry["mode"] for entry in data["energy"]], growing)
        self.assertEqual([mode["number"] for mode in data["shapes"]["modes"]], growing)
        self.assertIsNone(self.data(self.sweep)["shapes"])

    def test_nothing_from_the_network(self):
        for folder in (self.stability, self.sweep):
            text = self.page(folder)
            self.assertLess(len(text.encode()), LARGEST_FILE)
            self.assertEqual(re.findall(r'<(?:script|link|img|iframe)[^>]*(?:src|href)="(?!data:)[^"]*"', text), [])
            self.assertEqual(re.findall(r"url\((?!data:|none)[^)]{0,60}", text.split("</style>")[0]), [])

    def test_belongs_to_the_run(self):
        """The next run takes the page away with the results that it shows."""
        record = json.loads((self.stability / "run.json").read_text(encoding="utf-8"))
        self.assertEqual(record["files [byte]"]["report.html"], (self.stability / "report.html").stat().st_size)
        shutil.copytree(self.stability, self.folder / "again")
        again = self.run_scene("again")
        self.addCleanup(shutil.rmtree, again)
        self.assertFalse((again / "report.html").exists())

    def test_no_results(self):
        process = subprocess.run([sys.executable, "-B", SCRIPT, self.folder / "none"], capture_output=True, text=True, check=False)
        self.assertEqual(process.returncode, 1)
        self.assertTrue(process.stderr.startswith("error: there is no folder"), process.stderr)

    def test_in_a_browser(self):
        for width in (1200, 390):
            driver = browser(width)
            if driver is None:
                self.skipTest("chromium, chromium-driver or python3-selenium is not installed")
            try:
                for folder in (self.stability, self.sweep):
                    with self.subTest(folder.name, width=width):
                        self.look(driver, folder, width)
            finally:
                driver.quit()

    def look(self, driver, folder, width):
        driver.get((folder / "report.html").as_uri())
        time.sleep(1)
        self.assertEqual([entry for entry in driver.get_log("browser") if entry["level"] == "SEVERE"], [])
        self.assertEqual(driver.find_element("id", "verdict").text, self.verdict(folder))
        # Nothing is wider than the screen, and no part lies on another
        self.assertLessEqual(driver.execute_script("return document.documentElement.scrollWidth"), width)
        places = driver.execute_script("return [...document.querySelectorAll('main > *')].map(e => { const r = e.getBoundingClientRect();"
                                       " return [r.top, r.bottom]; })")
        for (_, bottom), (top, _) in zip(places, places[1:]):
            self.assertLessEqual(bottom, top + 0.5)
        for chart in self.data(folder)["charts"]:
            shown = driver.execute_script("return document.getElementById(arguments[0]).data.length", "chart-" + chart["id"])
            self.assertEqual(shown, len(chart["data"]))
        name = "complex_modes" if folder == self.stability else "thresholds"
        self.assert_sorts(driver, folder / f"{name}.csv")
        if folder == self.stability:
            self.assert_moves(driver)

    def assert_sorts(self, driver, path):
        """A click on a head sorts its column, a second one the other way round."""
        column = next(i for i, name in enumerate(read_table(path)[0]) if name == "frequency [Hz]")
        values = sorted(float(row["frequency [Hz]"]) for row in read_table(path))
        head = driver.find_elements("css selector", f"#table-{path.stem} thead th")[column]
        for extreme in (values[0], values[-1]):
            driver.execute_script("arguments[0].click()", head)
            first = driver.execute_script("return document.querySelector(arguments[0]).textContent",
                                          f"#table-{path.stem} tbody tr:first-child td:nth-child({column + 1})")
            self.assertAlmostEqual(float(first) / extreme, 1, delta=1e-5)

    def assert_moves(self, driver):
        place = "return Array.from(viewer.geometry.getAttribute('position').array.slice(0, 30000)).reduce((a, x) => a + Math.abs(x), 0)"
        before, frames = driver.execute_script(place), driver.execute_script("return viewer.frames")
        time.sleep(0.7)
        self.assertGreater(driver.execute_script("return viewer.frames"), frames)
        self.assertNotEqual(driver.execute_script(place), before)
        driver.execute_script("document.getElementById('play').click()")
        time.sleep(0.3)
        still = driver.execute_script(place)
        time.sleep(0.4)
        self.assertEqual(driver.execute_script(place), still)
        # Another mode has other shape and energy
        energy = "return document.getElementById('energy-mode').value"
        before = driver.execute_script(energy)
        driver.execute_script("[...document.querySelectorAll('#modes button')].find(b => !b.classList.contains('chosen')).click()")
        self.assertNotEqual(driver.execute_script(energy), before)
        triangles = "return viewer.geometry.index.count"
        before = driver.execute_script(triangles)
        driver.execute_script("document.getElementById('disc').click()")
        self.assertLess(driver.execute_script(triangles), before)


if __name__ == "__main__":
    unittest.main()
