# SPDX-License-Identifier: GPL-3.0-or-later

"""scripts/report.py: the page agrees with the tables, and a browser displays it."""

import html
import json
import math
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import time
import unittest

from program import EXECUTABLE, ProgramTest, read_table, settings

SCRIPT = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "report.py"

from squeal.reporting.page import missing_packages  # noqa: E402

WIDE, NARROW = 1200, 390  # width of a screen [pixel]
LARGEST_FILE = 15e6  # limit of the size of a page [byte]
RATE, LARGEST, ONSET, CHANGE = "divergence rate [%]", "largest divergence rate [%]", "mu of 0.01 % [-]", "divergence rate per 1 % [percentage points]"
QUICK = ("Sweep/Tolerance=1e-3", "Sweep/Threshold tolerance=1e-3", "Sweep/Number of friction coefficients=3")
SCENES = {"stability": ("Output/Mode shapes=unstable",),
          "sweep": ("Study=sweep", "Sweep/Last friction coefficient=0.4", "Sweep/Number of friction coefficients=5"),
          # Map with stable, unstable and undecided cells
          "map": ("Study=sweep", "Operation/Radial dissipation=consistent", "Sweep/Compare dissipation=false", "Sweep/Map parameter=load",
                  "Sweep/Number of map values=3", "Sweep/Map friction coefficients=4", *QUICK),
          # Solved and rejected designs
          "designs": ("Study=geometry", "Designs/Variables=Geometry/Pin height = 0.030, 0.034; Pin material/Young modulus = 1.9e9, 1", *QUICK),
          "search": ("Study=search", "Designs/Variables=Geometry/Pin diameter = 0.05 to 0.09; Geometry/Pin height = 0.03 to 0.034",
                     "Search/Samples=3", "Search/Evaluations=5", *QUICK),
          # Thresholds with and without derivatives
          "sensitivity": ("Study=sensitivity", "Sensitivity/Largest number of modes=2", "Sensitivity/Tolerance=1e-2", *QUICK)}
# A table of each page, and a column by which the test sorts it
SORTED = {"stability": ("complex_modes", "frequency [Hz]"), "sweep": ("thresholds", "frequency [Hz]"), "map": ("map", "growth rate [1/s]"),
          "designs": ("design_modes", "frequency [Hz]"), "search": ("search", LARGEST), "sensitivity": ("sensitivities", CHANGE)}
# Script that returns titles and legends that overlap or extend beyond their chart
CROWDED = """
return [...document.querySelectorAll('.chart')].flatMap(chart => {
  const frame = chart.getBoundingClientRect();
  const parts = [...chart.querySelectorAll('.g-xtitle, .g-ytitle, .legend, .colorbar, .xaxislayer-above .xtick:last-child')]
    .map(e => [e.getAttribute('class'), e.getBoundingClientRect()]).filter(([, r]) => r.width > 0);
  const outside = parts.filter(([, r]) => r.left < frame.left - 1 || r.right > frame.right + 1 || r.top < frame.top - 1 || r.bottom > frame.bottom + 1);
  const meet = (r, s) => Math.min(r.right, s.right) - Math.max(r.left, s.left) > 1 && Math.min(r.bottom, s.bottom) - Math.max(r.top, s.top) > 1;
  const pairs = parts.flatMap(([a, r], i) => parts.slice(i + 1).filter(([, s]) => meet(r, s)).map(([b]) => a + ' and ' + b));
  return [...outside.map(([a]) => a + ' beyond'), ...pairs].map(text => chart.id + ': ' + text);
});
"""


def browser(width):
    """Headless Chromium; None if it is not available."""
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
    # Emulate a phone: a browser window has a minimum width
    options.add_experimental_option("mobileEmulation", {"deviceMetrics": {"width": width, "height": 900, "pixelRatio": 1.0}})
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    return webdriver.Chrome(service=Service(driver), options=options)


@unittest.skipIf(missing_packages(), "missing packages: " + " ".join(missing_packages()))
class Reports(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        for name, overrides in SCENES.items():
            cls.report_of(cls.run_scene(name, *overrides))

    @staticmethod
    def report_of(folder):
        process = subprocess.run([sys.executable, "-B", SCRIPT, folder], capture_output=True, text=True, check=False)
        if process.returncode != 0:
            raise AssertionError(process.stderr)

    def rows(self, name, table):
        return read_table(self.folder / name / f"{table}.csv")

    def page(self, name):
        return (self.folder / name / "report.html").read_text(encoding="utf-8")

    def data(self, name):
        return json.loads(re.search(r'<script type="application/json" id="data">(.*?)</script>', self.page(name), re.S)[1])

    def charts(self, name):
        return {chart["id"]: chart for chart in self.data(name)["charts"]}

    def verdict(self, name):
        return html.unescape(re.search(r'<h1 id="verdict">(.*?)</h1>', self.page(name))[1])

    def section(self, name, which):
        """Text of a section of a page, without tags."""
        return html.unescape(re.sub("<[^>]*>", " ", re.search(rf'<section id="{which}">(.*?)</section>', self.page(name), re.S)[1]))

    def test_verdicts_name_what_the_tables_say(self):
        growing = [row for row in self.rows("stability", "complex_modes") if row["unstable [-]"] == "1"]
        onset, = [row for row in self.rows("sweep", "onsets") if float(row["divergence rate beyond [%]"]) == 0.01]
        cells = [row for row in self.rows("map", "map") if int(row["unstable modes [-]"]) > 0]
        solved = [row for row in self.rows("designs", "designs") if row["outcome"] == "solved"]
        found = [row for row in self.rows("search", "search") if row[LARGEST]]
        mode = self.rows("sensitivity", "sensitivities")[0]
        largest = next(row for row in self.rows("sensitivity", "sensitivity_ranking") if not row["body"])
        for name, rows, rate, label in (("stability", growing, RATE, "label"), ("map", cells, RATE, "label"), ("designs", solved, ONSET, "design [-]"),
                                        ("search", [{**row, LARGEST: "-" + row[LARGEST]} for row in found], LARGEST, "design [-]")):
            worst = max(rows, key=lambda row: float(row[rate]))
            self.assertIn(worst[label], self.verdict(name))
            self.assertIn(f"{abs(float(worst[rate])):.3g}", self.verdict(name))
        self.assertIn(f"{float(onset['mu [-]']):.3g}", self.verdict("sweep"))
        for text in (mode["label"], f"{float(mode[RATE]):.3g} %", largest["parameter"], f"{float(largest[CHANGE]):+.4f}".replace("-", "−")):
            self.assertIn(text, self.verdict("sensitivity"))
        self.assertIn('<header class="unstable">', self.page("stability"))

    def test_charts(self):
        """Charts have a curve for each branch and a marker for each mode."""
        rows = self.rows("stability", "complex_modes")
        damping = self.charts("stability")["damping"]
        self.assertEqual([len(trace["x"]) for trace in damping["data"]],
                         [sum(row["unstable [-]"] == flag for row in rows) for flag in ("0", "1")])
        for trace, flag in zip(damping["data"], ("0", "1")):
            self.assertEqual(trace["y"], [float(row["effective damping ratio -2R/omega [%]"]) for row in rows if row["unstable [-]"] == flag])
        charts = self.charts("sweep")
        rows = self.rows("sweep", "branches")
        curves = charts["branches"]["data"][:-2]
        self.assertEqual(len(curves), len({row["branch [-]"] for row in rows}))
        self.assertEqual(sum(len(trace["x"]) for trace in curves), len(rows))
        events = self.rows("sweep", "thresholds")
        self.assertEqual(sum(len(trace["x"]) for trace in charts["branches"]["data"][-2:]), len(events))
        # At a coalescence, both modes have the frequency of the threshold
        first, second = charts["bifurcations"]["data"][:2]
        event = next(row for row in events if first["name"].startswith(f"{row['label']} and {row['partner label']}, "
                                                                       f"{float(row['frequency [Hz]']):.1f} Hz"))
        for curve in (first, second):
            at = min(range(len(curve["x"])), key=lambda i: abs(curve["x"][i] - float(event["mu [-]"])))
            self.assertLess(abs(curve["y"][at]), 0.1 * max(map(abs, first["y"] + second["y"])))

    def test_energy_and_shapes(self):
        growing = [i for i, row in enumerate(self.rows("stability", "complex_modes"), start=1) if row["unstable [-]"] == "1"]
        self.assertEqual([int(choice["key"]) for choice in self.charts("stability")["energy"]["choices"]], growing)
        self.assertEqual([mode["number"] for mode in self.data("stability")["shapes"]["modes"]], growing)
        self.assertIsNone(self.data("sweep")["shapes"])

    def test_map(self):
        rows = self.rows("map", "map")
        growing = [row for row in rows if int(row["unstable modes [-]"]) > 0]
        chart = self.charts("map")["map"]
        self.assertEqual(chart["layout"]["yaxis"]["type"], "log")
        *maps, limit, names = chart["data"]
        cells = [[(value, text) for line, texts in zip(trace["z"], trace["text"]) for value, text in zip(line, texts) if value is not None]
                 for trace in maps]
        undecided = [row for row in rows if row not in growing and int(row["undecided modes [-]"]) > 0]
        self.assertEqual([len(one) for one in cells], [len(growing), len(rows) - len(growing) - len(undecided), len(undecided)])
        self.assertGreater(len(undecided), 0)
        # The table lists the cells in the same order
        for (value, text), row in zip(cells[0], growing):
            self.assertAlmostEqual(value / float(row[RATE]), 1, delta=1e-5)
            self.assertIn(row["label"], text)
        # The boundary between two cells is the geometric mean of their loads
        self.assertAlmostEqual(maps[0]["y"][1] / math.sqrt(100 * 1000), 1)
        self.assertGreater(sum(x is not None for x in limit["x"]), 3)
        self.assertLessEqual(set(names["text"]), {row["label"] for row in growing})

    def test_designs(self):
        solved = [row for row in self.rows("designs", "designs") if row["outcome"] == "solved"]
        charts = self.charts("designs")
        places = sorted((x, y) for trace in charts["designs_chart"]["data"] for x, y in zip(trace["x"], trace["y"]))
        for (x, y), row in zip(places, sorted(solved, key=lambda row: float(row[ONSET]))):
            self.assertAlmostEqual(x / float(row[ONSET]), 1, delta=1e-5)
            self.assertAlmostEqual(y / float(row[LARGEST]), 1, delta=1e-5)
        lines, = charts["variables_chart"]["data"]
        self.assertEqual([axis["label"] for axis in lines["dimensions"]], ["Pin height", "Young modulus", "onset μ (0.01 %)", "largest rate [%]"])
        self.assertEqual(lines["dimensions"][0]["values"], [0.03, 0.034])

    def test_search(self):
        rows = self.rows("search", "search")
        solved = [row for row in rows if row[LARGEST]]
        self.assertLess(len(solved), len(rows))
        best = min(solved, key=lambda row: float(row[LARGEST]))
        charts = self.charts("search")
        line, *marks = charts["history"]["data"]
        self.assertEqual(line["x"], [int(row["design [-]"]) for row in rows])
        for y, row in zip(line["y"], rows):
            self.assertAlmostEqual(y / float(row["best " + LARGEST]), 1, delta=1e-5)
        self.assertEqual(sorted(x for trace in marks for x in trace["x"]), line["x"])
        self.assertEqual(marks[-1]["x"], [int(row["design [-]"]) for row in rows if not row[LARGEST]])
        for choice in charts["over_variables"]["choices"]:
            places = [x for trace in choice["data"][:-1] for x in trace["x"]]
            self.assertEqual(sorted(places), sorted(float(row[choice["key"]]) for row in solved))
            self.assertEqual(choice["data"][-1]["x"], [float(best[choice["key"]])])

    def test_sensitivity(self):
        rows = self.rows("sensitivity", "sensitivities")
        chart = self.charts("sensitivity")["sensitivity"]
        self.assertEqual([choice["key"] for choice in chart["choices"]], ["1", "2"])
        self.assertEqual(chart["chosen"], "1")
        for choice in chart["choices"]:
            own = [row for row in rows if row["mode [-]"] == choice["key"] and not row["body"] and row[CHANGE]]
            shown = sorted(x for trace in choice["data"] for x in trace["x"])
            self.assertEqual(len(shown), len(own))
            for x, row in zip(shown, sorted(own, key=lambda row: float(row[CHANGE]))):
                self.assertAlmostEqual(x, float(row[CHANGE]), delta=1e-5 * abs(x))

        thresholds = self.rows("sensitivity", "sensitivities_thresholds")
        places = {row["mu [-]"]: row["derivative of"] for row in thresholds}
        without = [mu for mu, of in places.items() if of == "none"]
        self.assertGreater(len(without), 0)
        self.assertEqual(len(self.charts("sensitivity")["sensitivity_thresholds"]["choices"]), len(places) - len(without))
        for mu in without:
            self.assertIn(f"{float(mu):.4g}", self.section("sensitivity", "sensitivity_notes"))

    def test_nothing_grows(self):
        still = self.run_scene("still", "Study=sensitivity", "Sensitivity/Thresholds=false", "Sensitivity/Geometry=none",
                               "Operation/Friction coefficient=0")
        self.addCleanup(shutil.rmtree, still)
        self.report_of(still)
        self.assertIn('<header class="stable">', self.page("still"))

    def test_nothing_from_the_network(self):
        for name in SCENES:
            text = self.page(name)
            self.assertLess(len(text.encode()), LARGEST_FILE)
            self.assertEqual(re.findall(r'<(?:script|link|img|iframe)[^>]*(?:src|href)="(?!data:)[^"]*"', text), [])
            self.assertEqual(re.findall(r"url\((?!data:|none)[^)]{0,60}", text.split("</style>")[0]), [])

    def test_belongs_to_the_run(self):
        """The next run removes the page together with the results to which it belongs."""
        stability = self.folder / "stability"
        record = json.loads((stability / "run.json").read_text(encoding="utf-8"))
        self.assertEqual(record["files [byte]"]["report.html"], (stability / "report.html").stat().st_size)
        shutil.copytree(stability, self.folder / "again")
        again = self.run_scene("again")
        self.addCleanup(shutil.rmtree, again)
        self.assertFalse((again / "report.html").exists())

    def test_how_to_repeat_it(self):
        """The command shown on the page runs in a shell."""
        for name, overrides in SCENES.items():
            command = html.unescape(re.search(r'<section id="repeat">.*?<pre>(.*?)</pre>', self.page(name), re.S)[1])
            self.assertEqual(shlex.split(command), [EXECUTABLE, "scene.prm", "--output", name, *settings(overrides)])
        process = subprocess.run(command + " --dry-run", shell=True, cwd=self.folder, capture_output=True, text=True, check=False)
        self.assertEqual(process.returncode, 0, process.stderr)

    def test_no_results(self):
        process = subprocess.run([sys.executable, "-B", SCRIPT, self.folder / "none"], capture_output=True, text=True, check=False)
        self.assertEqual(process.returncode, 1)
        self.assertTrue(process.stderr.startswith("error: there is no folder"), process.stderr)

    def test_in_a_browser(self):
        for width in (WIDE, NARROW):
            driver = browser(width)
            if driver is None:
                self.skipTest("chromium, chromium-driver or python3-selenium is missing (scripts/setup.sh browser)")
            try:
                for name in SCENES:
                    with self.subTest(name, width=width):
                        self.look(driver, name, width)
                        if width == WIDE:
                            self.use(driver, name)
            finally:
                driver.quit()

    def look(self, driver, name, width):
        driver.get((self.folder / name / "report.html").as_uri())
        deadline = time.monotonic() + 30
        drawn = "return 'viewer' in window && [...document.querySelectorAll('.chart')].every(chart => chart.querySelector('.main-svg'))"
        while not driver.execute_script(drawn) and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assertEqual([entry for entry in driver.get_log("browser") if entry["level"] == "SEVERE"], [])
        self.assertEqual(driver.find_element("id", "verdict").text, self.verdict(name))
        # The page fits the width of the screen, and its sections do not overlap
        self.assertLessEqual(driver.execute_script("return document.documentElement.scrollWidth"), width)
        places = driver.execute_script("return [...document.querySelectorAll('main > *')].map(e => { const r = e.getBoundingClientRect();"
                                       " return [r.top, r.bottom]; })")
        for (_, bottom), (top, _) in zip(places, places[1:]):
            self.assertLessEqual(bottom, top + 0.5)
        self.assertEqual(driver.execute_script(CROWDED), [])
        for chart in self.data(name)["charts"]:
            shown = driver.execute_script("return document.getElementById(arguments[0]).data.length", "chart-" + chart["id"])
            traces = chart["data"] if "data" in chart else next(one["data"] for one in chart["choices"] if one["key"] == chart["chosen"])
            self.assertEqual(shown, len(traces))

    def use(self, driver, name):
        """Checks that do not depend on the width of the screen."""
        self.assert_tables(driver, name)
        self.assert_sorts(driver, self.folder / name / f"{SORTED[name][0]}.csv", SORTED[name][1])
        if name == "stability":
            self.assert_moves(driver)

    def assert_tables(self, driver, name):
        """Checks that every table has the rows of its file."""
        shown = driver.execute_script("return [...document.querySelectorAll('table.sortable')].map(t => [t.id, $(t).DataTable().rows().count()])")
        self.assertGreater(len(shown), 0)
        self.assertEqual(shown, [[table, len(self.rows(name, table.removeprefix("table-")))] for table, _ in shown])
        self.assertIn("table-" + SORTED[name][0], [table for table, _ in shown])

    def assert_sorts(self, driver, path, name):
        """Checks that a click on a header sorts by its column, and a second click reverses the order."""
        column = list(read_table(path)[0]).index(name)
        values = sorted(float(row[name]) for row in read_table(path) if row[name])
        head = driver.find_elements("css selector", f"#table-{path.stem} thead th")[column]
        found = []
        for _ in range(2):
            driver.execute_script("arguments[0].click()", head)
            texts = driver.execute_script("return $(arguments[0]).DataTable().column(arguments[1], { order: 'current' }).data().toArray()",
                                          f"#table-{path.stem}", column)
            found.append([float(text) for text in texts if text])
        self.assertEqual(found[0], sorted(found[0]))
        self.assertEqual(found[1], sorted(found[0], reverse=True))
        for shown, value in zip(found[0], values):
            self.assertAlmostEqual(shown, value, delta=1e-5 * abs(value))

    def assert_moves(self, driver):
        place = "return Array.from(viewer.geometry.getAttribute('position').array.slice(0, 30000)).reduce((a, x) => a + Math.abs(x), 0)"
        before, deadline = driver.execute_script(place), time.monotonic() + 30
        while driver.execute_script(place) == before and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assertNotEqual(driver.execute_script(place), before)
