# SPDX-License-Identifier: GPL-3.0-or-later

"""Files of a run, and repetition of the run from these files."""

import json
import math
import os
import pathlib
import shlex
import shutil
import subprocess
import unittest
import xml.etree.ElementTree

from program import COMPLEX_COLUMNS, EXECUTABLE, SAME, ProgramTest, distance, eigenvalues, header, numbers, read_table, real_frequencies
from squeal.parameter_file import read_parameters
from squeal.vtu_file import VtuFile

# Resolution of displacements in files [-]
STEP = 1 / 65536

TABLES = ["component_modes.csv", "real_modes.csv", "complex_modes.csv"]
PARAVIEW_MODES = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "paraview_modes.py"


def arrays(path):
    """Names of the fields of a file."""
    file = VtuFile(path)
    return {*file.fields, *file.cell_fields}


class Results(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results", "Output/Mode shapes=unstable")
        cls.record = json.loads((cls.results / "run.json").read_text(encoding="utf-8"))

    def test_files(self):
        for name in [*TABLES, "run.json", "parameters.prm", "mesh.msh"]:
            self.assertTrue((self.results / name).is_file(), name)
        self.assertEqual(sorted(path.name for path in self.folder.iterdir()), ["results", "scene.prm"])

    def test_tables(self):
        self.assertEqual(header(self.results / "complex_modes.csv"), ",".join(COMPLEX_COLUMNS))
        self.assertEqual(header(self.results / "real_modes.csv"), "label,share [-],frequency [Hz],residual [-]")
        self.assertEqual(header(self.results / "component_modes.csv"), "component,contact,label,frequency [Hz],residual [-]")
        for name in TABLES:
            self.assertTrue(read_table(self.results / name), name)
            self.assertTrue(all(math.isfinite(number) for number in numbers(self.results / name)), name)

    def test_modes(self):
        rows = read_table(self.results / "complex_modes.csv")
        frequencies = [float(row["frequency [Hz]"]) for row in rows]
        for row in rows:
            shares = [float(value) for name, value in row.items() if name.startswith("strain energy")]
            self.assertAlmostEqual(sum(shares), 100, places=6)
            self.assertGreaterEqual(min(shares), 0)
        # Frequencies ascend, except for modes that are equal within rounding
        for lower, upper in zip(frequencies, frequencies[1:]):
            self.assertLessEqual(lower, upper * (1 + SAME))
        self.assertLessEqual(frequencies[-1], 5000)
        for row in rows:
            growth, frequency = float(row["growth rate [1/s]"]), float(row["frequency [Hz]"])
            rate, damping = float(row["divergence rate [%]"]), float(row["effective damping ratio -2R/omega [%]"])
            self.assertAlmostEqual(rate, 100 * growth / (2 * math.pi * frequency), delta=1e-9 * abs(rate))
            self.assertAlmostEqual(damping, -2 * rate, delta=1e-9 * abs(rate))
            self.assertLessEqual(float(row["residual [-]"]), 1e-9)
            self.assertTrue(0 < float(row["share [-]"]) <= 1)
        # Without dissipation, every growing mode has a decaying partner with the same frequency
        values = eigenvalues(self.results)
        self.assertLess(distance([-value.conjugate() for value in values], values), 1e-9)

    def test_record(self):
        self.assertEqual(shlex.split(self.record["command"])[:4], [EXECUTABLE, "scene.prm", "--output", "results"])
        self.assertLessEqual({"squeal", "revision", "deal.II", "Trilinos", "MUMPS", "CHOLMOD", "UMFPACK", "Gmsh"},
                             set(self.record["versions"]))
        self.assertLessEqual(sum(step["wall time [s]"] for step in self.record["steps"]), self.record["wall time [s]"])
        counts = self.record["counts"]
        self.assertEqual(counts["contact nodes"], 4 * 7)
        self.assertEqual(counts["coupled dofs"], counts["dofs"] - counts["contact nodes"])
        self.assertEqual(counts["rigid-body modes"], 0)
        self.assertEqual(counts["real modes"], len(read_table(self.results / "real_modes.csv")))
        self.assertEqual(counts["complex modes"], len(read_table(self.results / "complex_modes.csv")))

    def test_fields(self):
        rows = read_table(self.results / "complex_modes.csv")
        unstable = [number for number, row in enumerate(rows, start=1) if float(row["divergence rate [%]"]) > 1e-6]
        self.assertEqual(len(unstable), self.record["counts"]["unstable modes"])
        self.assertEqual([number for number, row in enumerate(rows, start=1) if row["unstable [-]"] == "1"], unstable)
        self.assertGreater(len(unstable), 0)
        for number in unstable:
            fields = sorted((self.results / "modes").glob(f"complex_{number:03d}_*.vtu"))
            self.assertEqual(len(fields), 2)
            volume, contact = sorted(fields, key=lambda path: path.name.endswith("_contact.vtu"))
            self.assertEqual(arrays(volume), {"displacement_real", "displacement_imag", "amplitude", "phase", "component"})
            self.assertEqual(arrays(contact), {"component", "normal_reaction_real", "normal_reaction_imag", "closed", "energy_input"})
            self.assertEqual([set(VtuFile(path).cell_types) for path in (volume, contact)], [{12}, {9}])

        self.assertEqual(len(list((self.results / "modes").iterdir())), 2 * len(unstable))
        names = {path.stem for path in (self.results / "modes").iterdir() if "contact" not in path.stem}
        frames = xml.etree.ElementTree.parse(self.results / "animations" / "unstable_modes.pvd").findall(".//DataSet")
        self.assertEqual([round(3 * float(frame.get("timestep")), 9) for frame in frames], [0, 1, 2])
        for frame in frames:
            picture = self.results / "animations" / frame.get("file")
            self.assertEqual(arrays(picture), {"component"} | names)
            self.assertEqual(set(VtuFile(picture).cell_types), {9})

    def test_energy(self):
        """Contributions of all bodies add up to the divergence rate; work of friction is listed with the pins."""
        rows = read_table(self.results / "energy.csv")
        modes = read_table(self.results / "complex_modes.csv")
        growing = [number for number, row in enumerate(modes, start=1) if row["unstable [-]"] == "1"]
        self.assertEqual(sorted({int(row["mode [-]"]) for row in rows}), growing)
        for number in growing:
            own = [row for row in rows if int(row["mode [-]"]) == number]
            self.assertEqual([row["body"] for row in own], ["disc", "pin_top_1", "pin_top_2", "pin_bottom_1", "pin_bottom_2"])
            rate = float(modes[number - 1]["divergence rate [%]"])
            self.assertAlmostEqual(sum(float(row["total [%]"]) for row in own), rate, delta=1e-8 * max(rate, 1e-4))
            self.assertEqual((own[0]["friction [%]"], float(own[0]["damping [%]"])), ("", 0))
            for row in own[1:]:
                self.assertAlmostEqual(float(row["friction into the disc [%]"]) + float(row["friction into the pin [%]"]),
                                       float(row["friction [%]"]), delta=1e-9 * rate)
        self.assertLess(self.record["quantities"]["largest difference of a divergence rate from the sum of its contributions [-]"], 1e-10)

    def test_parameters_repeat_the_run(self):
        again = self.run_scene("again", file="results/parameters.prm")
        self.addCleanup(shutil.rmtree, again)
        for name in [*TABLES, "parameters.prm", "mesh.msh"]:
            self.assertEqual((again / name).read_bytes(), (self.results / name).read_bytes(), name)

    def test_mesh_repeats_the_run(self):
        again = self.run_scene("again", "Geometry/File=results/mesh.msh")
        self.addCleanup(shutil.rmtree, again)
        self.assert_same_eigenvalues(eigenvalues(again), eigenvalues(self.results))
        for name in ("real_modes.csv", "component_modes.csv"):
            self.assert_same_eigenvalues(real_frequencies(again, name), real_frequencies(self.results, name))
            self.assertEqual([row["label"] for row in read_table(again / name)],
                             [row["label"] for row in read_table(self.results / name)])


# Write unstable complex modes, and all component and real modes
SHAPES = ("Output/Mode shapes=unstable", "Output/Component mode shapes=true", "Output/Real mode shapes=true")


class Repetition(ProgramTest):
    """A run can be repeated from its parameter file, with any file names, and with closed standard streams."""

    BAND = ("--set", "Band/Maximum frequency=1000")

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results", cls.BAND[1])

    def assert_same_results(self, folder):
        for name in [*TABLES, "mesh.msh"]:
            self.assertEqual((self.folder / folder / name).read_bytes(), (self.results / name).read_bytes(), name)

    def complete(self, *arguments):
        process = self.call(*self.BAND, *arguments)
        self.assertEqual((process.returncode, process.stderr), (0, ""), arguments)

    def test_any_name_repeats_the_run(self):
        scene = (self.folder / "scene.prm").read_bytes()
        for name in ("plate #2", " blanks\t", '"a" b"', "back\\slash\\n\\line\nbreak", os.fsdecode(b"-\xff\xfe"), "$HOME *':,;=|"):
            with self.subTest(name):
                mesh = f"{name}.msh"
                written = '"' + mesh.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
                shutil.copy(self.results / "mesh.msh", self.folder / mesh)
                (self.folder / f"{name}.prm").write_bytes(scene + os.fsencode(f"subsection Geometry\n  set File = {written} # why\nend\n"))
                self.complete(f"--output={name}", "--", f"{name}.prm")
                (self.folder / mesh).unlink()
                self.complete("--output", "again", "--", f"{name}/parameters.prm")
                for folder in (name, "again"):
                    self.assertEqual(list((self.folder / folder / "geometry").iterdir()), [self.folder / folder / "geometry" / mesh])
                for table in TABLES:
                    self.assertEqual((self.folder / "again" / table).read_bytes(), (self.folder / name / table).read_bytes())
                self.assertEqual(read_parameters(self.folder / name / "parameters.prm")["Geometry/File"], f"geometry/{mesh}")
                shutil.rmtree(self.folder / "again")

    def test_what_begins_a_comment_is_kept_in_overrides(self):
        shutil.copy(self.results / "mesh.msh", self.folder / "a #1.msh")
        for value in ("a #1.msh", '"a #1.msh"'):
            self.complete("scene.prm", "--output", "numbered", "--set", f"Geometry/File={value}")
            self.complete("numbered/parameters.prm", "--output", "again")
            self.assertTrue((self.folder / "again" / "geometry" / "a #1.msh").is_file())

    def test_closed_streams(self):
        for closed in ("<&-", ">&- 2>&-", "<&- >&- 2>&-"):
            with self.subTest(closed):
                process = subprocess.run(["sh", "-c", f'exec "$0" "$@" {closed}', EXECUTABLE, "scene.prm", *self.BAND, "--output", "closed"],
                                         cwd=self.folder, capture_output=True, check=False, timeout=300)
                self.assertEqual(process.returncode, 0, process.stderr)
                self.assert_same_results("closed")
                shutil.rmtree(self.folder / "closed")


class Shapes(ProgramTest):
    """Files of mode shapes: fields, .pvd lists and pictures by ParaView."""

    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results", *SHAPES)

    def fields_of(self, pattern):
        return {int(path.stem.split("_")[pattern.count("_")]): path for path in sorted((self.results / "modes").glob(pattern))}

    def assert_normalised(self, fields):
        self.assertAlmostEqual(max(abs(u) for vector in fields["displacement"] for u in vector), 1, delta=STEP)
        for displacement, amplitude in zip(fields["displacement"], fields["amplitude"]):
            self.assertAlmostEqual(math.hypot(*displacement), amplitude, delta=1.4 * STEP)  # amplitude and components are rounded

    def test_real_modes(self):
        rows = read_table(self.results / "real_modes.csv")
        files = self.fields_of("real_*.vtu")
        self.assertEqual(list(files), list(range(1, len(rows) + 1)))
        for row, path in zip(rows, files.values()):
            self.assertEqual(path.stem.split("_", 2)[2], file_text(row["label"]))
        self.assertEqual(arrays(files[1]), {"displacement", "amplitude", "component"})
        self.assert_normalised(VtuFile(files[1]).fields)

    def test_component_modes(self):
        rows = read_table(self.results / "component_modes.csv")
        for component, contact, kind in (("disc", "free", "disc"), ("pins", "sliding", "pins_sliding"), ("pins", "free", "pins_free")):
            files = self.fields_of(f"component_{kind}_*.vtu")
            own = [number for number, row in enumerate(rows, start=1) if (row["component"], row["contact"]) == (component, contact)]
            self.assertEqual(list(files), own)
            for number, path in files.items():
                self.assertTrue(path.stem.endswith(f"_{number:03d}_{file_text(rows[number - 1]['label'])}"), path)
            file = VtuFile(files[own[0]])
            self.assertEqual(set(file.cell_fields["component"]), {0} if component == "disc" else {1, 2, 3, 4})
            self.assert_normalised(file.fields)

    def test_lists(self):
        listed = {"modes": ("complex_modes", "complex_*.vtu"), "real_modes": ("real_modes", "real_*.vtu"),
                  **{f"component_modes_{kind}": ("component_modes", f"component_{kind}_*.vtu")
                     for kind in ("disc", "pins_sliding", "pins_free")}}
        record = json.loads((self.results / "run.json").read_text(encoding="utf-8"))
        for name, (table, pattern) in listed.items():
            with self.subTest(name):
                self.assertIn(f"{name}.pvd", record["files [byte]"])
                entries = xml.etree.ElementTree.parse(self.results / f"{name}.pvd").findall(".//DataSet")
                everything = sorted((self.results / "modes").glob(pattern))
                files = [path for path in everything if not path.stem.endswith("_contact")]
                if name == "modes":
                    faces = xml.etree.ElementTree.parse(self.results / "modes_contact.pvd").findall(".//DataSet")
                    self.assertEqual([face.get("timestep") for face in faces], [entry.get("timestep") for entry in entries])
                    self.assertEqual([self.results / face.get("file") for face in faces], [path for path in everything if path not in files])
                self.assertEqual([self.results / entry.get("file") for entry in entries], files)
                # ParaView distinguishes times by their text
                times = [entry.get("timestep") for entry in entries]
                self.assertEqual(len(set(times)), len(times))
                self.assertEqual(sorted(times, key=float), times)
                frequencies = real_frequencies(self.results, f"{table}.csv")
                for path, time in zip(files, times):
                    number = next(int(word) for word in path.stem.split("_") if word.isdigit())
                    # Times of modes with equal frequencies are shifted to make them distinct
                    self.assertAlmostEqual(float(time) / frequencies[number - 1], 1, delta=2e-6 * len(times))

    @unittest.skipUnless(shutil.which("pvpython") and shutil.which("xvfb-run"), "ParaView is not installed")
    def test_paraview(self):
        """Pictures, a film and a session file of the leading mode, and energy pictures of all unstable modes."""
        rows = read_table(self.results / "complex_modes.csv")
        leader = max(range(len(rows)), key=lambda i: float(rows[i]["growth rate [1/s]"]))
        picture, film, session = (self.folder / name for name in ("pictures", "mode.gif", "mode.pvsm"))
        mode = ("--mode", str(leader + 1), "--width", "320")
        for arguments in ((*mode, "--pictures", picture), (*mode, "--view", "faces", "--pictures", self.folder / "faces"),
                          (*mode, "--film", film, "--periods", "1"), (*mode, "--state", session)):
            process = subprocess.run([PARAVIEW_MODES, self.results, *arguments], capture_output=True, text=True, check=False)
            self.assertEqual(process.returncode, 0, process.stderr[-2000:])
        path, = picture.iterdir()
        self.assertTrue(path.name.startswith(f"complex_{leader + 1:03d}_"))
        self.assertEqual(path.read_bytes()[:8], b"\x89PNG\r\n\x1a\n")
        self.assertEqual(film.read_bytes()[:6], b"GIF89a")
        energy = self.folder / "energy"
        process = subprocess.run([PARAVIEW_MODES, self.results, "--view", "energy", "--width", "320", "--pictures", energy], capture_output=True,
                                 text=True, check=False)
        self.assertEqual(process.returncode, 0, process.stderr[-2000:])
        self.assertEqual(len(list(energy.iterdir())), sum(row["unstable [-]"] == "1" for row in rows))
        self.assertIn("ProgrammableFilter", session.read_text(encoding="utf-8"))

def file_text(label):
    """Label in the form used in file names."""
    return label.replace(" -", "_minus").replace(" +", "_plus")
