# SPDX-License-Identifier: GPL-3.0-or-later

"""Custom geometries: permissions, variables, summary, and rejected geometries."""

import re
import shutil

from blocks import BLOCKS, HEXAHEDRA, SURFACES, VOLUMES
from program import SOURCE, ProgramTest, settings

SCRIPT = BLOCKS + HEXAHEDRA + VOLUMES + SURFACES
COARSE = ("Geometry/Disc layers=1", "Geometry/Pin layers=1", "Geometry/Element size=0.04")


class OwnGeometry(ProgramTest):
    def understood(self, *overrides, file="scene.prm"):
        process = self.dry_run(*overrides, file=file)
        self.assertEqual((process.returncode, process.stderr), (0, ""))
        return process.stdout

    def geometry_refused(self, mentions, text, *overrides):
        self.dry_run_refused(mentions, f"Geometry/File={self.write('other.geo', text)}", "Mounts/Elastic mounts=", *overrides)

    # ------------------------------------------------------------- permissions

    def test_geometry_reaches_nothing_but_the_mesh(self):
        """A geometry script can affect only the mesh; tests/geometry/mesher.cc covers more statements, and terminations
        of Gmsh."""
        self.write("part.geo", 'x = 1;\nSystemCall "touch trace";')
        self.geometry_refused(["starts a program", "part.geo, line 2", "Allow shell commands"], 'Include "part.geo";')
        # The file is named like a mesh, but contains a script
        self.write("script.msh", 'SystemCall "touch trace";')
        self.dry_run_refused(["starts a program"], "Geometry/File=script.msh")
        self.assertFalse((self.folder / "trace").exists())
        self.geometry_refused(["did not finish within 1 s", "Meshing time limit"], "For i In {1 : 1000000000}\n  a = i;\nEndFor\n",
                              "Geometry/Meshing time limit=1")

    # ------------------------------------------------------------ file, format

    def test_formats(self):
        for name in ("bracket.inp", "bracket"):
            self.write(name, "*NODE\n")
            self.dry_run_refused([name, "support" if "." in name else "unknown", ".geo", ".msh"], f"Geometry/File={name}")

    def test_processes_share_one_mesh(self):
        trace = self.folder / "trace"
        self.addCleanup(trace.unlink, missing_ok=True)
        self.write("other.geo", SCRIPT + f'SystemCall "echo >> {trace}";')
        overrides = settings(["Geometry/File=other.geo", "Mounts/Elastic mounts="])
        allowed = self.call("scene.prm", "--dry-run", *overrides, "--set", "Geometry/Allow shell commands=true", n_processes=2)
        self.assertEqual(allowed.returncode, 0, allowed.stderr)
        self.assertEqual(trace.read_text(encoding="utf-8"), "\n")
        refused = self.call("scene.prm", "--dry-run", *overrides, n_processes=2)
        self.assertNotEqual(refused.returncode, 0)
        self.assertEqual(refused.stderr.count("error: The geometry starts a program"), 1, refused.stderr)

    def test_file_beside_the_parameter_file_comes_first(self):
        self.addCleanup(shutil.rmtree, self.folder / "apart")
        self.write("apart/own.geo", SCRIPT)
        self.write("own.geo", "Exit;")
        self.write("apart/own.prm", "subsection Geometry\n  set File = own.geo\nend\nsubsection Mounts\n  set Elastic mounts =\nend\n")
        self.assertIn("16 hexahedra", self.understood(file="apart/own.prm"))
        self.dry_run_refused(["missing.geo", "/apart", str(self.folder), "/geometry"], "Geometry/File=missing.geo", file="apart/own.prm")

    def test_variables_of_a_geometry(self):
        shutil.copy(SOURCE / "geometry" / "disc_pad.geo", self.folder / "pad.geo")
        self.addCleanup((self.folder / "pad.geo").unlink)
        area = lambda text: float(re.search(r"pin_top_1: .* high, (\S+) m\^2", text).group(1))
        pad = "Geometry/File=pad.geo"
        wide, narrow = self.understood(pad, *COARSE), self.understood(pad, "Geometry/pad_angle=40", *COARSE)
        self.assertAlmostEqual(area(narrow) / area(wide), 0.8, delta=0.01)
        self.dry_run_refused(["unknown parameter `Geometry/pad_angel`", "`Geometry/pad_angle`"], pad, "Geometry/pad_angel=40")
        self.dry_run_refused(["Geometry/pad_angle", "`wide`"], pad, "Geometry/pad_angle=wide")
        self.dry_run_refused(["unknown parameter `Geometry/pad_angle`"], "Geometry/pad_angle=40")

    def test_a_variable_is_that_of_the_section(self):
        self.write("other.geo", "DefineConstant[ disc_thickness = 0.022 ];\n" + SCRIPT)
        own, note = ("Geometry/File=other.geo", "Mounts/Elastic mounts="), "note: disc_thickness = 0.022 in the script is overridden by 0.0463"
        self.assertIn(note, self.understood(*own))
        self.assertNotIn("overridden", self.understood(*own, "Geometry/Disc thickness=0.03"))

    # ----------------------------------------------------------------- summary

    def test_summary(self):
        text = self.understood()
        self.assertRegex(text, r"disc: radii 0\.150\d* and 0\.3155 m about z, 0\.0463 m thick, 0\.01\d+ m\^3, 8\d\.\d+ kg; bar waves 5172 m/s")
        self.assertRegex(text, r"4 pins like pin_top_1: 0\.0318 m high, 0\.00\d+ m\^2 on the disc")
        self.assertRegex(text, r"expected: \d+ dofs, \S+ GB of memory; \S+ GB are available")
        self.assertNotIn("warning", text)
        text = self.understood("Materials/Volumes=pin_top_2: 1.9e9, 0.25, 6140")
        self.assertIn("3 pins like pin_top_1", text)
        self.assertRegex(text, r"pin_top_2: 0\.0318 m high.*; bar waves 556\.3 m/s")

    def doubted(self, mentions, *overrides, refused):
        """Checks that the summary has warnings, even if the run is rejected because shear waves are not resolved."""
        process = self.dry_run(*overrides)
        for word in ["disc: radii", "warning: ", *mentions]:
            self.assertIn(word, process.stdout)
        self.assertEqual(process.returncode, 1 if refused else 0)
        self.assertEqual("shear waves" in process.stderr, refused, process.stderr)

    def test_units_are_doubted(self):
        self.doubted(["disc extends 46.3 m along z", "metres"], "Geometry/Disc thickness=46.3", refused=True)
        self.doubted(["Materials/Volumes, pin_top_1/Density is 3e+07"], "Materials/Volumes=pin_top_1: 1e14, 0.25, 3e7",
                     refused=False)
        self.doubted(["Disc material: sqrt(E/rho) is 0.1636 m/s", "Pa"], "Disc material/Young modulus=210", refused=True)

    def test_disc_that_is_not_round(self):
        self.write("other.geo", SCRIPT)
        self.assertIn("body of revolution", self.understood("Geometry/File=other.geo", "Mounts/Elastic mounts="))

    def test_axes_that_do_not_turn(self):
        constants = "Materials/Orthotropic=disc: 210e9, 200e9, 190e9, 0.3, 0.3, 0.3, 80e9, 80e9, 80e9, 7850"
        axes, warning = "Materials/Axes=disc: 1, 0, 0, 0, 1, 0", "warning: the axes of disc in Materials/Axes do not turn with the disc"
        self.assertIn(warning, self.understood(constants, axes))
        self.assertNotIn("do not turn", self.understood(constants))
        self.assertNotIn("do not turn", self.understood(constants, axes, "Operation/Sliding direction=1, 0, 0"))
        self.assertNotIn("do not turn", self.understood(constants.replace("disc", "pin_top_1"), axes.replace("disc", "pin_top_1")))

    # ------------------------------------------------------------------ bodies

    def test_bodies(self):
        other_pin = "Box(3) = {0.1, 0.5, 0, 0.1, 0.1, 0.02};\n"
        self.geometry_refused(["'pin_1' consists of 2 disconnected pieces", "8, 8 elements"],
                              BLOCKS + other_pin + HEXAHEDRA + VOLUMES.replace("{2}", "{2, 3}") + SURFACES)
        self.geometry_refused(["'pin_2' has no contact face", "'pin_contact'"],
                              BLOCKS + other_pin + HEXAHEDRA + VOLUMES + 'Physical Volume("pin_2") = {3};' + SURFACES)
        self.geometry_refused(["'pin_2' is not held", "no face on 'pin_clamp'"],
                              BLOCKS + "Box(3) = {0.1, 0.2, 0, 0.1, 0.1, 0.02};\n" + HEXAHEDRA + VOLUMES + 'Physical Volume("pin_2") = {3};' +
                              SURFACES.replace("{11}", "{11, 17}"))
        self.geometry_refused(["The 'pin_clamp' face of 'pin_1' is closer to the contact face of the disc", "exchange"],
                              SCRIPT.replace("{11}", "{0}").replace("{12}", "{11}").replace("{0}", "{12}"))
        swapped = VOLUMES.replace("{1}", "{0}").replace("{2}", "{1}").replace("{0}", "{2}")
        self.geometry_refused(["has a face on", "on the disc only"], BLOCKS + HEXAHEDRA + swapped + SURFACES)

    def test_pins_that_overlap_askew(self):
        layers = ("Geometry/Disc layers=3", "Geometry/Pin layers=1")
        radii = [f"Geometry/{side} pin radii=0.1970, 0.1970, 0.1970, 0.2585, 0.2585, 0.2585" for side in ("Top", "Bottom")]
        bottom = "Geometry/Bottom pin angles=-18.4, 0, 18.4, -18.4, 0, 18.4"
        for size, angle in ((0.0115, 33), (0.04, 30)):
            with self.subTest(size=size, angle=angle):
                top = f"Geometry/Top pin angles=-{angle}, 0, {angle}, -{angle}, 0, {angle}"
                overrides = (*radii, bottom, top, *layers, "Geometry/Nodes per pin face=19", f"Geometry/Element size={size}")
                self.assertIn("12 pins", self.understood(*overrides))
