"""Anybody's geometry: what it may do, what is understood of it, what is refused, and what is kept of it."""

import math
import re
import shutil

from blocks import BLOCKS, HEXAHEDRA, SURFACES, VOLUMES
from mesh_file import MeshFile
from program import SOURCE, ProgramTest, read_table, real_frequencies

COARSE = ("Geometry/Disc layers=1", "Geometry/Pin layers=1", "Geometry/Element size=0.04")


class OwnGeometry(ProgramTest):
    @classmethod
    def setUpClass(cls):
        super().setUpClass()
        cls.results = cls.run_scene("results")

    def write(self, name, text):
        path = self.folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        self.addCleanup(path.unlink, missing_ok=True)
        return name

    def dry_run(self, *overrides, file="scene.prm"):
        return self.call(file, "--dry-run", *(word for override in overrides for word in ("--set", override)))

    def understood(self, *overrides, file="scene.prm"):
        process = self.dry_run(*overrides, file=file)
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        return process.stdout

    def refused(self, mentions, *overrides, file="scene.prm"):
        process = self.dry_run(*overrides, file=file)
        self.assertEqual(process.returncode, 1, process.stdout + process.stderr)
        message = process.stderr.strip()
        self.assertTrue(message.startswith("error: "), message)
        for start in ("error: ", "  where:  ", "  change: "):
            self.assertEqual(sum(line.startswith(start) for line in message.splitlines()), 1, message)
        for word in mentions:
            self.assertIn(word, message)

    def geometry_refused(self, mentions, text, *overrides):
        self.refused(mentions, f"Geometry/File={self.write('other.geo', text)}", "Mounts/Elastic mounts=", *overrides)

    # ------------------------------------------------------ what a file may do

    def test_geometry_reaches_nothing_but_the_mesh(self):
        trace = self.folder / "trace"
        for statement in ('SystemCall "touch trace";', 'NonBlockingSystemCall "touch trace";', 'Printf("x") > "trace";', 'CreateDir "trace";',
                          'Point(1) = {0, 0, 0}; Save "trace.msh";', 'Point(1) = {0, 0, 0}; Print "trace.msh";', 'OnelabRun("x", "touch trace");'):
            with self.subTest(statement):
                self.geometry_refused(["The geometry", "other.geo, line 2: " + statement, "Allow shell commands"], "// not line 1\n" + statement)
                self.assertEqual(list(self.folder.glob("trace*")), [])
        self.write("part.geo", 'x = 1;\nSystemCall "touch trace";')
        self.geometry_refused(["starts a program", "part.geo, line 2"], 'Include "part.geo";')
        self.assertFalse(trace.exists())

        # A mesh in name, a script in content
        self.write("script.msh", 'SystemCall "touch trace";')
        self.refused(["starts a program"], "Geometry/File=script.msh")
        self.assertFalse(trace.exists())

    def test_shell_commands_may_be_allowed(self):
        trace = self.folder / "trace"
        self.addCleanup(trace.unlink, missing_ok=True)
        script = BLOCKS + HEXAHEDRA + VOLUMES + SURFACES + f'SystemCall "echo >> {trace}";'
        self.write("other.geo", script)
        self.understood("Geometry/File=other.geo", "Mounts/Elastic mounts=", "Geometry/Allow shell commands=true")
        self.assertEqual(trace.read_text(encoding="utf-8"), "\n")

    def test_geometry_does_not_take_the_program_down(self):
        self.geometry_refused(["Gmsh", "line 2", "'foo'"], "Point(1) = {0, 0, 0};\n" + "foo bar;\n" * 100)
        self.geometry_refused(["ended Gmsh before there was a mesh"], "Exit;")
        self.geometry_refused(["did not finish within 1 s", "Meshing time limit"], "For i In {1 : 1000000000}\n  a = i;\nEndFor\n",
                              "Geometry/Meshing time limit=1")
        self.geometry_refused(["more than 1 GB", "Meshing memory limit"], "l() = {1 : 100000000}; m() = {l(), l()};\n",
                              "Geometry/Meshing memory limit=1")

    # ------------------------------------------------------------ file, format

    def test_formats(self):
        for name in ("bracket.inp", "bracket.bdf", "bracket.unv", "bracket"):
            self.write(name, "*NODE\n")
            self.refused([name, "support" if "." in name else "unknown", ".geo", ".msh"], f"Geometry/File={name}")

    def test_processes_share_one_mesh(self):
        trace = self.folder / "trace"
        self.addCleanup(trace.unlink, missing_ok=True)
        self.write("other.geo", BLOCKS + HEXAHEDRA + VOLUMES + SURFACES + f'SystemCall "echo >> {trace}";')
        overrides = ("--set", "Geometry/File=other.geo", "--set", "Mounts/Elastic mounts=")
        allowed = self.call("scene.prm", "--dry-run", *overrides, "--set", "Geometry/Allow shell commands=true", n_processes=2)
        self.assertEqual(allowed.returncode, 0, allowed.stderr)
        self.assertEqual(trace.read_text(encoding="utf-8"), "\n")
        refused = self.call("scene.prm", "--dry-run", *overrides, n_processes=2)
        self.assertNotEqual(refused.returncode, 0)
        self.assertEqual(refused.stderr.count("error: The geometry starts a program"), 1, refused.stderr)

    def test_file_beside_the_parameter_file_comes_first(self):
        self.addCleanup(shutil.rmtree, self.folder / "apart")
        self.write("apart/own.geo", BLOCKS + HEXAHEDRA + VOLUMES + SURFACES)
        self.write("own.geo", "Exit;")
        self.write("apart/own.prm", "subsection Geometry\n  set File = own.geo\nend\nsubsection Mounts\n  set Elastic mounts =\nend\n")
        self.assertIn("16 hexahedra", self.understood(file="apart/own.prm"))
        self.refused(["missing.geo", "/apart", str(self.folder), "/geometry"], "Geometry/File=missing.geo", file="apart/own.prm")

    def test_variables_of_a_geometry(self):
        shutil.copy(SOURCE / "geometry" / "disc_pad.geo", self.folder / "pad.geo")
        self.addCleanup((self.folder / "pad.geo").unlink)
        area = lambda text: float(re.search(r"pin_top_1: .* high, (\S+) m\^2", text).group(1))
        pad = "Geometry/File=pad.geo"
        wide, narrow = self.understood(pad, *COARSE), self.understood(pad, "Geometry/pad_angle=40", *COARSE)
        self.assertAlmostEqual(area(narrow) / area(wide), 0.8, delta=0.01)
        self.refused(["unknown parameter `Geometry/pad_angel`", "`Geometry/pad_angle`"], pad, "Geometry/pad_angel=40")
        self.refused(["Geometry/pad_angle", "`wide`"], pad, "Geometry/pad_angle=wide")
        self.refused(["unknown parameter `Geometry/pad_angle`"], "Geometry/pad_angle=40")

        folder = self.run_scene("pad", pad, "Geometry/pad_angle=40", "Band/Maximum frequency=700", *COARSE)
        self.addCleanup(shutil.rmtree, folder)
        self.assertEqual((folder / "geometry" / "pad.geo").read_bytes(), (self.folder / "pad.geo").read_bytes())
        again = self.run_scene("again", file=str(folder / "parameters.prm"))
        self.addCleanup(shutil.rmtree, again)
        self.assertEqual((again / "mesh.msh").read_bytes(), (folder / "mesh.msh").read_bytes())

    def test_numbers_of_a_geometry(self):
        script = BLOCKS.replace("0.02}", "h}") + HEXAHEDRA + VOLUMES + SURFACES
        self.write("other.geo", 'h = DefineNumber[ 0.02, Name "Parameters/Height of pin" ];\n' + script)
        overrides = ("Geometry/File=other.geo", "Mounts/Elastic mounts=")
        self.assertIn("pin_1: 0.02 m high", self.understood(*overrides))
        self.assertIn("pin_1: 0.03 m high", self.understood("Geometry/h=0.03", *overrides))

    # ------------------------------------------------------- what is understood

    def test_summary(self):
        text = self.understood()
        self.assertRegex(text, r"disc: radii 0\.150\d* and 0\.3155 m about z, 0\.0463 m thick, 0\.01\d+ m\^3, 8\d\.\d+ kg; bar waves 5172 m/s")
        self.assertRegex(text, r"4 pins like pin_top_1: 0\.0318 m high, 0\.00\d+ m\^2 on the disc")
        self.assertRegex(text, r"expected: \d+ dofs, \S+ GB of memory; \S+ GB are available")
        self.assertNotIn("warning", text)
        text = self.understood("Pin material/Single pins=pin_top_2: 1.9e9, 0.25, 6140")
        self.assertIn("3 pins like pin_top_1", text)
        self.assertRegex(text, r"pin_top_2: 0\.0318 m high.*; bar waves 556\.3 m/s")

    def doubted(self, mentions, *overrides, refused):
        """What was understood is said with its doubts, also where the run is then refused for its waves."""
        process = self.dry_run(*overrides)
        for word in ["disc: radii", "warning: ", *mentions]:
            self.assertIn(word, process.stdout)
        self.assertEqual(process.returncode, 1 if refused else 0)
        self.assertEqual("shear waves" in process.stderr, refused, process.stderr)

    def test_units_are_doubted(self):
        self.doubted(["disc extends 46.3 m along z", "metres"], "Geometry/Disc thickness=46.3", refused=True)
        self.doubted(["Disc material/Density is 7.85 kg/m^3", "bar waves 1.636e+05 m/s"], "Disc material/Density=7.85", refused=False)
        self.doubted(["Pin material/Single pins, pin_top_1/Density is 3e+07"], "Pin material/Single pins=pin_top_1: 1e14, 0.25, 3e7", refused=False)
        self.doubted(["Disc material: sqrt(E/rho) is 0.1636 m/s", "Pa"], "Disc material/Young modulus=210", refused=True)

    def test_mesh_in_millimetres(self):
        mesh = self.mesh()
        for node in list(mesh.nodes):
            mesh.move(node, [1000 * x for x in mesh.nodes[node][1]])
        mesh.write(self.folder / "changed.msh")
        self.doubted(["the disc has an outer radius of 315.5 m; lengths are in metres"], "Geometry/File=changed.msh", refused=True)

    def test_memory_is_known_beforehand(self):
        self.refused(["e+08 hexahedra", "dofs", "GB of memory", "GB are available", "Disc layers"], "Geometry/Disc layers=1000000")
        self.refused(["hexahedra", "GB of memory", "Element size"], "Geometry/Element size=1e-6", "Geometry/Pairing tolerance=1e-7")

    # ------------------------------------------------------------------- axis

    def mesh(self):
        self.addCleanup((self.folder / "changed.msh").unlink, missing_ok=True)
        return MeshFile(self.results / "mesh.msh")

    def moved_refused(self, mentions, motion):
        mesh = self.mesh()
        for node in list(mesh.nodes):
            mesh.move(node, motion(*mesh.nodes[node][1]))
        mesh.write(self.folder / "changed.msh")
        self.refused([*mentions, "Translate and Rotate"], "Geometry/File=changed.msh")

    def test_disc_off_its_axis(self):
        self.moved_refused(["axis through (0.01, 0, 0) m in direction (0, 0, 1)"], lambda x, y, z: [x + 0.01, y, z])
        self.moved_refused(["in direction (1, "], lambda x, y, z: [z, x, y])
        c, s = math.cos(0.01), math.sin(0.01)
        self.moved_refused(["in direction (0, 0.01, 1)"], lambda x, y, z: [x, c * y + s * z, c * z - s * y])

    def test_disc_that_is_not_round(self):
        self.write("other.geo", BLOCKS + HEXAHEDRA + VOLUMES + SURFACES)
        self.assertIn("warning: the disc is not round about the z axis", self.understood("Geometry/File=other.geo", "Mounts/Elastic mounts="))

    # ------------------------------------------------------------------ bodies

    def test_bodies(self):
        other_pin = "Box(3) = {0.1, 0.5, 0, 0.1, 0.1, 0.02};\n"
        self.geometry_refused(["'pin_1' is in 2 pieces", "8, 8 elements"],
                              BLOCKS + other_pin + HEXAHEDRA + VOLUMES.replace("{2}", "{2, 3}") + SURFACES)
        self.geometry_refused(["'pin_2' has no face on 'pin_contact'", "touches nothing"],
                              BLOCKS + other_pin + HEXAHEDRA + VOLUMES + 'Physical Volume("pin_2") = {3};' + SURFACES)
        self.geometry_refused(["'pin_2' has no face on 'pin_clamp'", "nothing holds it"],
                              BLOCKS + "Box(3) = {0.1, 0.2, 0, 0.1, 0.1, 0.02};\n" + HEXAHEDRA + VOLUMES + 'Physical Volume("pin_2") = {3};' +
                              SURFACES.replace("{11}", "{11, 17}"))
        self.geometry_refused(["'pin_1' touches the disc with its face on 'pin_clamp'", "exchange"],
                              BLOCKS + HEXAHEDRA + VOLUMES + SURFACES.replace("{11}", "{0}").replace("{12}", "{11}").replace("{0}", "{12}"))
        self.geometry_refused(["exchanged"], BLOCKS + HEXAHEDRA + VOLUMES.replace("{1}", "{0}").replace("{2}", "{1}").replace("{0}", "{2}") + SURFACES)

    # -------------------------------------------------- the plan of the program

    def test_scaled_scenes_have_the_same_modes(self):
        """Lengths s times as large: frequencies 1/s times, with mounts 1/s times as stiff per area."""
        expected = real_frequencies(self.results)
        expected_growth = [row["growth rate [1/s]"] for row in read_table(self.results / "complex_modes.csv")]
        for exponent in (-6, -3, 3, 6):
            with self.subTest(exponent):
                s = f"e{exponent}"
                lengths = {"Disc inner radius": "0.1505", "Disc outer radius": "0.3155", "Disc thickness": "0.0463", "Pin diameter": "0.052",
                           "Pin height": "0.0318", "Element size": "0.04", "Pairing tolerance": "1e-6"}
                overrides = [f"Geometry/{name}={float(value + s) if 'e' not in value else float('1e' + str(exponent - 6))!r}"
                             for name, value in lengths.items()]
                overrides += [f"Geometry/{side} pin radii={float('0.2275' + s)!r}, {float('0.2275' + s)!r}" for side in ("Top", "Bottom")]
                back = 10.0 ** -exponent
                overrides += [f"Band/Maximum frequency={5000 * back!r}", f"Mounts/Elastic mounts=disc_bore: 0, {7.8e10 * back!r}, {1.88e10 * back!r}"]
                folder = self.run_scene("scaled", *overrides)
                self.addCleanup(shutil.rmtree, folder, ignore_errors=True)
                found = real_frequencies(folder)
                self.assertEqual(len(found), len(expected))
                for frequency, reference in zip(found, expected):
                    self.assertAlmostEqual(frequency / back / reference, 1, delta=1e-8)
                growth = [float(row["growth rate [1/s]"]) / back for row in read_table(folder / "complex_modes.csv")]
                largest = max(map(float, expected_growth))
                self.assertAlmostEqual(max(growth) / largest, 1, delta=1e-6)

    def test_pins_that_overlap_askew(self):
        layers = ("Geometry/Disc layers=3", "Geometry/Pin layers=1")
        radii = [f"Geometry/{side} pin radii=0.1970, 0.1970, 0.1970, 0.2585, 0.2585, 0.2585" for side in ("Top", "Bottom")]
        bottom = "Geometry/Bottom pin angles=-18.4, 0, 18.4, -18.4, 0, 18.4"
        for size in (0.0115, 0.04):
            for angle in (30, 33):
                with self.subTest(size=size, angle=angle):
                    self.assertIn("12 pins", self.understood(*radii, bottom, *layers, "Geometry/Nodes per pin face=19", f"Geometry/Element size={size}",
                                                             f"Geometry/Top pin angles=-{angle}, 0, {angle}, -{angle}, 0, {angle}"))

    def test_thin_pins(self):
        text = self.understood("Geometry/Pin diameter=0.001")
        self.assertLess(int(re.search(r"(\d+) hexahedra", text).group(1)), 10000)


