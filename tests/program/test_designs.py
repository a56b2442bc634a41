# SPDX-License-Identifier: GPL-3.0-or-later

"""Design studies: agreement with single runs, resumption after interruptions, invalid designs."""

import os
import re
import shutil
import signal
import subprocess
import time

from program import COARSE, EXECUTABLE, ProgramTest, design_tables, read_table, settings

STUDY = ["Study=geometry", "Sweep/Number of friction coefficients=8"]
# Large tolerances for tests that ignore the results of designs
QUICK = ["Study=geometry", "Sweep/Number of friction coefficients=3", "Sweep/Tolerance=1e-3", "Sweep/Threshold tolerance=1e-3"]
VARIABLES = "Designs/Variables=Geometry/Pin height = 0.030, 0.034; Pin material/Young modulus = 1.7e9, 1.9e9, 1"


class DesignsTest(ProgramTest):
    scene = COARSE

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.study = cls.run_scene("study", *STUDY, VARIABLES)

    def test_every_design_has_its_row(self):
        rows = read_table(self.study / "designs.csv")
        self.assertEqual([int(row["design [-]"]) for row in rows], [1, 2, 3, 4, 5, 6])
        self.assertEqual([row["Geometry/Pin height"] for row in rows], ["0.030"] * 3 + ["0.034"] * 3)
        self.assertEqual([row["outcome"] for row in rows], ["solved", "solved", "refused"] * 2)
        for row in rows:
            if row["outcome"] == "refused":
                self.assertNotEqual(row["reason"], "")
                self.assertEqual(row["modes [-]"], "")
            else:
                self.assertEqual(row["modes [-]"], row["modes counted [-]"])
                self.assertEqual(row["complete [-]"], "1")
                self.assertLess(float(row["estimated error of lambda [-]"]), 1e-6)
        self.assertFalse((self.folder / "study.checkpoint").exists())

    def test_designs_are_those_of_single_runs(self):
        row = read_table(self.study / "designs.csv")[3]
        number = row["design [-]"]
        single = self.run_scene(f"single_{number}", file=str(self.study / "designs" / f"{number}.prm"))
        mine = [t for t in read_table(self.study / "design_thresholds.csv") if t["design [-]"] == number]
        others = read_table(single / "thresholds.csv")
        self.assertEqual(len(mine), len(others))
        self.assertGreater(len(mine), 0)
        for one, other in zip(mine, others):
            self.assertEqual((one["event"], one["mechanism"]), (other["event"], other["mechanism"]))
            self.assertLessEqual(abs(float(one["mu [-]"]) - float(other["mu [-]"])),
                                 float(one["uncertainty [-]"]) + float(other["uncertainty [-]"]))
        branches = read_table(single / "branches.csv")
        growing = [b for b in branches if b["growing [-]"] == "1"]
        largest = max(float(b["divergence rate [%]"]) for b in growing)
        self.assertAlmostEqual(float(row["largest divergence rate [%]"]), largest, delta=1e-3 * largest)
        last = max(float(b["mu [-]"]) for b in branches)
        self.assertEqual(int(row["unstable modes [-]"]),
                         sum(b["verdict"] == "unstable" and float(b["mu [-]"]) == last for b in branches))
        weak = float(row["mu of 0.01 % [-]"])
        below = [float(b["divergence rate [%]"]) for b in branches if float(b["mu [-]"]) < weak - 1e-5]
        self.assertLessEqual(max(below), 0.01)
        self.assertTrue(any(float(b["divergence rate [%]"]) > 0.01 for b in branches))

    def test_modes_have_the_names_of_the_scene(self):
        scene = self.run_scene("scene")
        known = {row["label"] for row in read_table(scene / "real_modes.csv")}
        modes = read_table(self.study / "design_modes.csv")
        for number in ("1", "5"):
            mine = [mode for mode in modes if mode["design [-]"] == number]
            of_disc = [mode for mode in mine if re.match("[ARC][0-9]", mode["label"])]
            self.assertGreater(len(of_disc), 8)
            for mode in of_disc:
                self.assertIn(mode["label"], known | {"unnamed"})
            # Height and modulus of the pins hardly affect most disc modes
            clear = [mode for mode in of_disc if float(mode["overlap with reference [-]"] or 0) > 0.9]
            self.assertGreater(len(clear), 0.7 * len(of_disc))
            self.assertEqual(len({mode["label"] for mode in clear}), len(clear))

    def test_one_design_alone_is_the_same(self):
        process = self.call("scene.prm", "--output", "some", "--designs", "2, 6-6", *settings((*STUDY, VARIABLES)))
        self.assertEqual(process.returncode, 0, process.stderr)
        some = self.folder / "some"
        self.assertEqual(design_tables(some)["designs"], [design_tables(self.study)["designs"][i] for i in (1, 5)])
        self.assertEqual(sorted(path.name for path in (some / "designs").iterdir()), ["2.prm", "6.prm"])
        self.assertEqual(*((folder / "designs" / "2.prm").read_text(encoding="utf-8") for folder in (some, self.study)))

    def test_unknown_designs_are_refused(self):
        for designs, what in (("7", "is neither the number of a design"), (",", "--designs")):
            process = self.call("scene.prm", "--output", "none", "--designs", designs, *settings((*STUDY, VARIABLES)))
            self.assert_message(process, [what])
            self.assertFalse((self.folder / "none").exists())

    def test_several_processes(self):
        # Ignore overlaps: vectors of the multiple eigenvalues of equal pins depend on rounding
        found, expected = (design_tables(folder) for folder in (self.run_scene("parallel", *STUDY, VARIABLES, n_processes=2), self.study))
        for rows in (*found.values(), *expected.values()):
            for row in rows:
                row.pop("overlap with reference [-]", None)
        self.assertEqual(found, expected)

    def test_killed_and_resumed(self):
        self.interrupt("killed", (*STUDY, VARIABLES), ((2, signal.SIGKILL), (3, signal.SIGTERM), (4, signal.SIGKILL)))
        # Worker processes must end with the killed study
        deadline = time.monotonic() + 60
        while self.processes_of("killed.checkpoint") and time.monotonic() < deadline:
            time.sleep(0.1)
        self.assertEqual(self.processes_of("killed.checkpoint"), [])
        n_known = len(self.stored("killed"))
        self.assertGreaterEqual(n_known, 4)

        # A study with other parameters must not resume the interrupted one
        other = self.call("scene.prm", "--output", "killed", *settings((*STUDY, VARIABLES, "Sweep/Tolerance=1e-5")))
        self.assert_message(other, ["an unfinished study with other parameters"])

        process = self.call("scene.prm", "--output", "killed", *settings((*STUDY, VARIABLES)))
        self.assertEqual(process.returncode, 0, process.stderr)
        self.assertIn(f"{n_known} of 6 designs are finished", process.stdout)
        self.assertEqual(design_tables(self.folder / "killed"), design_tables(self.study))
        self.assertFalse((self.folder / "killed.checkpoint").exists())

    @staticmethod
    def processes_of(words):
        """Ids of the processes whose command line contains `words`."""
        found = []
        for entry in os.listdir("/proc"):
            if entry.isdigit():
                try:
                    with open(f"/proc/{entry}/cmdline", "rb") as file:
                        if words.encode() in file.read():
                            found.append(entry)
                except OSError:
                    pass
        return found

    def test_crashes_are_rows(self):
        """If a worker process is killed, only its design fails."""
        words = settings((*QUICK, "Designs/Variables=Geometry/Pin height = 0.030, 0.034, 0.032", "Designs/Processes=1"))
        process = subprocess.Popen([EXECUTABLE, "scene.prm", "--output", "crash", *words], cwd=self.folder, stdout=subprocess.DEVNULL,
                                   stderr=subprocess.PIPE, text=True)
        victims, deadline = [], time.monotonic() + 300
        while not victims and time.monotonic() < deadline:
            victims = [int(number) for number in self.processes_of("crash.checkpoint/design-2")]
            time.sleep(0.01)
        for victim in victims:
            os.kill(victim, signal.SIGKILL)
        errors = process.communicate(timeout=300)[1]
        self.assertEqual(process.returncode, 0, errors)
        rows = read_table(self.folder / "crash" / "designs.csv")
        self.assertEqual([row["outcome"] for row in rows], ["solved", "failed", "solved"])
        self.assertIn("killed by SIGKILL", rows[1]["reason"])

    def test_designs_of_a_file(self):
        (self.folder / "designs.csv").write_text('Geometry/Pin height,"Geometry/Top pin angles + Geometry/Bottom pin angles"\n0.030,"-12, 12"\n',
                                                 encoding="utf-8")
        study = self.run_scene("file", *QUICK, "Designs/Plan=file", "Designs/File=designs.csv")
        (self.folder / "designs.csv").replace(study / "designs.csv.former")
        process = self.call("file/parameters.prm", "--dry-run")
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        rows = read_table(study / "designs.csv")
        self.assertEqual([row["Geometry/Top pin angles + Geometry/Bottom pin angles"] for row in rows], ["-12, 12"])
        self.assertEqual([row["outcome"] for row in rows], ["solved"])

    def test_what_lies_in_the_way_is_left_alone(self):
        for name, text, words in (("letter.txt", "keep me", "contains no unfinished study"),
                                  ("study.key", "squeal designs 1\n",
                                   "`squeal designs 1` there, `squeal designs 4` here")):
            folder = self.folder / "mine.checkpoint"
            folder.mkdir()
            (folder / name).write_text(text, encoding="utf-8")
            self.assert_message(self.call("scene.prm", "--output", "mine", *settings((*STUDY, VARIABLES))), [words])
            self.assertEqual((folder / name).read_text(encoding="utf-8"), text)
            shutil.rmtree(folder)

    def test_designs_that_their_parameters_refuse_need_no_process(self):
        """Contact damping without load is invalid although both values are valid individually."""
        variables = "Designs/Variables=Operation/Load per side = 0, 1000; Operation/Radial dissipation = none, consistent"
        folder = self.run_scene("refused", *QUICK, variables)
        rows = read_table(folder / "designs.csv")
        self.assertEqual([row["outcome"] for row in rows], ["solved", "refused", "solved", "solved"])
        self.assertIn("Operation/Load per side", rows[1]["reason"])
        self.assertFalse((folder / "designs" / "2.prm").exists())

    def test_dry_runs_refuse_what_the_study_would(self):
        self.dry_run_refused(["Real modes/Tolerance", "has no effect"], "Study=geometry",
                             "Designs/Variables=Real modes/Tolerance = 1e-9, 1e-8")
