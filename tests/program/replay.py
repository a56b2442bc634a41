#!/usr/bin/python3
"""Replays input that once was lost, misread, endless or refused for the wrong reason, on scenes of full width.

    SQUEAL=build/release/squeal tests/program/replay.py [--list] [--slow] [WORD]...

Every case is a command line and what has to come of it: the exit status, texts that must be printed and texts
that must not. WORDs select the cases whose names contain them. The unit tests beside this file look at the same
behaviour more closely on smaller scenes; this script shows that it holds where it was first seen. It takes one or
two minutes, with --slow some more. The exit status is 1 when a case does not come out as expected.
"""

import argparse
import dataclasses
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import time

COARSE = ["Geometry/Nodes per pin face=7", "Geometry/Pin layers=2", "Geometry/Disc layers=2"]
S = [*COARSE, "Geometry/Element size=0.03"]
S4 = [*COARSE, "Geometry/Element size=0.04"]
NO_SHAPES = ["Output/Mode shapes=none"]
SIXTY_PINS = [f"Geometry/{side} pin {name}={', '.join(values)}" for side in ("Top", "Bottom") for name, values in
              (("radii", ["0.233"] * 60), ("angles", [str(6 * pin - 180) for pin in range(60)]))]
MOUNT = "Mounts/Elastic mounts=disc_bore: "
TIME_LIMIT = 300  # [s]



@dataclasses.dataclass
class Case:
    name: str
    settings: list = dataclasses.field(default_factory=list)
    status: int = 0
    says: list = dataclasses.field(default_factory=list)
    not_says: list = dataclasses.field(default_factory=list)
    options: list = dataclasses.field(default_factory=list)
    files: dict = dataclasses.field(default_factory=dict)
    file: str = "e.prm"
    leaves: list = dataclasses.field(default_factory=list)      # files that must be there afterwards
    leaves_not: list = dataclasses.field(default_factory=list)  # and that must not
    slow: bool = False


ERROR = [r"^error: ", r"^  where:  ", r"^  change: "]

CASES = [
    # -------------------------------------------------- silently wrong
    Case("disc off its axis", [*S, "Geometry/File=off.msh"], 1, [*ERROR, "axis"], files={"off.msh": ("moved", (0.05, 0.0, 0.0))}),
    Case("disc about another axis", [*S, "Geometry/File=turned.msh"], 1, [*ERROR, "axis"], files={"turned.msh": ("turned", None)}),
    Case("thickness in millimetres", ["Geometry/Disc thickness=46.3"], 1, ["warning", *ERROR], options=["--dry-run"]),
    Case("density in g/cm^3", [*S, "Disc material/Density=7.85"], says=["warning"], options=["--dry-run"]),
    Case("modulus in GPa", [*S, "Disc material/Young modulus=210"], 1, ["warning", *ERROR], options=["--dry-run"]),
    Case("mesh in millimetres", ["Geometry/File=mm.msh"], 1, ["warning", *ERROR], options=["--dry-run"], files={"mm.msh": ("scaled", 1000.0)}),
    Case("static divergence at mu = 3", [*S4, *NO_SHAPES, "Operation/Friction coefficient=3"], says=["static divergence", r"\b6\b.*real"],
         not_says=["crossed its end", "e\\+04 %"], leaves=["real_eigenvalues.csv"]),
    Case("mu = 10 by Krylov", [*S4, *NO_SHAPES, "Operation/Friction coefficient=10"], says=["50 found"]),
    Case("mu = 10 by residual iteration", [*S4, *NO_SHAPES, "Operation/Friction coefficient=10", "Complex modes/Solver=residual iteration"],
         says=["50 found"]),
    Case("load and speed without dissipation", [*S4, *NO_SHAPES, "Operation/Load per side=2000", "Operation/Rotation speed=5"],
         says=["Operation/Load per side", "Operation/Rotation speed"]),
    Case("gaps with equal load", [*S4, *NO_SHAPES, "Steady sliding/Gaps=pin_top_1: 1e-5"], says=["Steady sliding/Gaps"]),
    Case("thickness with a mesh", ["Geometry/File=plain.msh", "Geometry/Disc thickness=0.05"], says=["Geometry/Disc thickness"],
         options=["--dry-run"], files={"plain.msh": ("scaled", 1.0)}),
    Case("locking", [*S, *NO_SHAPES, "Pin material/Poisson ratio=0.499"], says=["Pin material/Poisson ratio", "Element"]),
    # ------------------------------------------ crashes, hangs, refusals
    Case("a file that includes itself", status=1, says=ERROR, file="loop.prm", files={"loop.prm": "include loop.prm\n"}),
    Case("a geometry with many errors", ["Geometry/File=errors.geo"], 1, ERROR,
         files={"errors.geo": "".join(f"Point({i}) = {{a{i}, b, c}};\nnonsense {i}\n" for i in range(400))}),
    Case("a geometry that exits", ["Geometry/File=exit.geo"], 1, ERROR, files={"exit.geo": "Exit;\n"}),
    Case("a geometry that runs a command", ["Geometry/File=call.geo"], 1, ERROR, options=["--dry-run"],
         files={"call.geo": 'SystemCall "touch x";\n'}, leaves_not=["../x"]),
    Case("a million layers", ["Geometry/Disc layers=1000000"], 1, [*ERROR, "memory"]),
    Case("soft mount, default mesh", [*NO_SHAPES, MOUNT + "1e6, 1e6, 1e6"], says=["squeal: |stable: "]),
    *(Case(f"soft mount {stiffness}", [*S4, *NO_SHAPES, MOUNT + ", ".join([stiffness] * 3)], says=["squeal: |stable: "])
      for stiffness in ("1e3", "1e5", "1e6", "1e7", "1e8")),
    *(Case(f"top pins askew, elements of {size} m", ["Geometry/Top pin angles=-30,0,30,-30,0,30", f"Geometry/Element size={size}"],
           options=["--dry-run"], not_says=["error"]) for size in ("0.012", "0.015", "0.02", "0.025", "0.03")),
    *(Case(f"Rayleigh beta {beta}", [*S4, *NO_SHAPES, f"Damping/Disc Rayleigh beta={beta}", f"Damping/Pin Rayleigh beta={beta}"], 1,
           [*ERROR, "Rayleigh beta"]) for beta in ("1e-4", "1e-2")),
    Case("soft disc", [*S4, *NO_SHAPES, "Disc material/Young modulus=210e6"], 1, ERROR),
    Case("pins of 1 mm", [*S4, *NO_SHAPES, "Geometry/Pin diameter=0.001"], says=["62 found, 62 counted by inertia"]),
    Case("60 pins on each side", [*S4, *NO_SHAPES, "Geometry/Pin diameter=0.02", *SIXTY_PINS], says=["found, .* counted by inertia"], slow=True),
    Case("100 kHz", [*S4, *NO_SHAPES, "Band/Maximum frequency=100000"], 1, ERROR),
    Case("10 kHz", [*S4, *NO_SHAPES, "Band/Maximum frequency=10000"], says=["counted by inertia"]),
    Case("soft pins", [*S4, *NO_SHAPES, "Pin material/Young modulus=1.9e3"], 1, ERROR),
    Case("heavy pins", [*S4, *NO_SHAPES, "Pin material/Density=3.07e9"], 1, ERROR),
    Case("stiff disc", [*S4, *NO_SHAPES, "Disc material/Young modulus=210e15"], says=["42 found, 42 counted by inertia"]),
    # ------------------------------------------------------------- words
    Case("a value out of its range", ["Operation/Friction coefficient=-0.1"], 1,
         [*ERROR, r"Operation/Friction coefficient.*0.*10"], ["given pattern"]),
    Case("ranges in the list of parameters", options=["--print-parameters"], says=[r"0.*10"]),
    Case("a format that Gmsh may know", ["Geometry/File=model.inp"], 1, [*ERROR, "format"], files={"model.inp": "*HEADING\n"}),
    Case("a format of Nastran", ["Geometry/File=model.bdf"], 1, [*ERROR, "format"], files={"model.bdf": "BEGIN BULK\n"}),
    Case("a byte-order mark", options=["--dry-run"], file="bom.prm",
         files={"bom.prm": b"\xef\xbb\xbfsubsection Operation\n  set Friction coefficient = 0.3\nend\n"}),
    Case("UTF-16", status=1, says=[*ERROR, "UTF-16"], file="wide.prm", files={"wide.prm": "set Study = sweep\n".encode("utf-16")}),
    Case("a NUL byte", status=1, says=ERROR, file="nul.prm", files={"nul.prm": b"set Study = \0sweep\n"}),
    Case("a directory for a parameter file", status=1, says=[*ERROR, "directory|folder"], file="."),
    Case("help", options=["-h"], says=["squeal PRM"]),
    Case("minus zero", [*S4, *NO_SHAPES, "Operation/Friction coefficient=-0"], says=["mu = 0"], not_says=["mu = -0"]),
    Case("a density of 1e-9", [*S4, "Pin material/Density=-1e-9"], 1, ERROR, ["0\\.000000"]),
    Case("a value of 100 kB", ["Geometry/File=" + "x" * 100_000], 1, ERROR, ["x{1000}"]),
]


def transformed_mesh(mesh, change):
    """The text of an ASCII .msh file (version 4.1) with its nodes moved, turned or scaled."""
    kind, amount = change
    lines, result, inside = mesh.splitlines(), [], False
    for line in lines:
        inside = line == "$Nodes" or (inside and line != "$EndNodes")
        words = line.split()
        if inside and len(words) == 3:
            x, y, z = map(float, words)
            if kind == "moved":
                x, y, z = x + amount[0], y + amount[1], z + amount[2]
            elif kind == "scaled":
                x, y, z = amount * x, amount * y, amount * z
            else:
                x, y, z = x, -z, y
            line = f"{x!r} {y!r} {z!r}"
        result.append(line)
    return "\n".join(result) + "\n"


class Replay:
    def __init__(self, executable, folder):
        self.executable, self.folder = executable, folder
        self.mesh = None

    def call(self, *arguments):
        return subprocess.run([self.executable, *arguments], cwd=self.folder, text=True, errors="replace", capture_output=True,
                              timeout=TIME_LIMIT)

    def small_mesh(self):
        """A mesh that the program has made."""
        if self.mesh is None:
            settings = [word for setting in [*S4, *NO_SHAPES, "Band/Maximum frequency=1000"] for word in ("--set", setting)]
            process = self.call("e.prm", "--output", "small", *settings)
            if process.returncode != 0:
                sys.exit(process.stderr)
            self.mesh = (self.folder / "small" / "mesh.msh").read_text(encoding="utf-8")
        return self.mesh

    def prepare(self, case):
        for name, content in {"e.prm": "", **case.files}.items():
            if isinstance(content, tuple):
                content = transformed_mesh(self.small_mesh(), content)
            (self.folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())

    def complaints(self, case):
        """What did not come out as expected."""
        self.prepare(case)
        output = "results"
        settings = [word for setting in case.settings for word in ("--set", setting)]
        try:
            process = self.call(case.file, "--output", output, *settings, *case.options)
        except subprocess.TimeoutExpired:
            return [f"no end within {TIME_LIMIT} s"]
        printed = process.stdout + process.stderr
        found = [] if process.returncode == case.status else [f"exit status {process.returncode} instead of {case.status}"]
        found += [f"`{text}` is not printed" for text in case.says if not re.search(text, printed, re.MULTILINE)]
        found += [f"`{text}` is printed" for text in case.not_says if re.search(text, printed)]
        found += [f"{name} is missing" for name in case.leaves if not (self.folder / output / name).exists()]
        found += [f"{name} is there" for name in case.leaves_not if (self.folder / output / name).exists()]
        return found + ["printed: " + printed[-1500:]] if found else []


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", metavar="WORD", nargs="*")
    parser.add_argument("--list", action="store_true", help="prints the command lines and stops")
    parser.add_argument("--slow", action="store_true", help="also the cases that take more than a minute")
    arguments = parser.parse_args()
    cases = [case for case in CASES if (arguments.slow or not case.slow)
             and (not arguments.words or any(word in case.name for word in arguments.words))]
    if arguments.list:
        for case in cases:
            print(f"{case.name}: squeal {case.file} " + " ".join([*(f'--set "{text[:80]}"' for text in case.settings), *case.options]))
        return 0

    executable = pathlib.Path(os.environ.get("SQUEAL", "build/release/squeal")).resolve()
    n_failed = 0
    for case in cases:
        with tempfile.TemporaryDirectory() as folder:
            start = time.monotonic()
            found = Replay(executable, pathlib.Path(folder)).complaints(case)
            print(f"{'failed' if found else 'passed'}  {time.monotonic() - start:6.1f} s  {case.name}", flush=True)
            for complaint in found:
                print("    " + complaint.replace("\n", "\n    "))
            n_failed += bool(found)
    print(f"{len(cases) - n_failed} passed, {n_failed} failed")
    return 1 if n_failed else 0


if __name__ == "__main__":
    sys.exit(main())
