#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Runs the program on damaged input and reports failures.

    SQUEAL=build/sanitizers/squeal tests/fuzz/fuzz.py [--cases N] [--first N] [--seed N] [--kind KIND]

For any input, the program must either succeed, or end with exit status 1 and one message that says what happened,
where, and what to change. It must not crash or exceed its time limit, and it must write only complete results. KIND is
parameters (files), settings (of the command line), meshes or scripts. Some small models that pass the dry run are also
run. Seed and N determine case N. If a case fails, its files are kept in build/fuzz, and the exit status is 1.
"""

import argparse
import collections
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
os.environ["SQUEAL"] = os.path.abspath(os.environ.get("SQUEAL", HERE.parents[1] / "build/release/squeal"))
sys.path.insert(0, str(HERE.parent / "program"))

from blocks import BLOCKS, HEXAHEDRA, SURFACES, VOLUMES  # noqa: E402 (found by the path set above)
from program import EXECUTABLE, SCENE, SOURCE, read_table, settings  # noqa: E402

TIME_LIMIT = 120       # time limit of a run on a busy machine [s]
LARGEST_MESSAGE = 6000  # limit of a message, including Gmsh's output [characters]
MEMORY = 16 << 30      # memory limit of a process without sanitizers [byte]
PARTS = ("error: ", "  where:  ", "  change: ")
EXPECTED = re.compile(r"expected: \S+ dofs, ([\d.e+-]+) GB of memory")

# Limits of meshing that keep cases short
LIMITS = ["Geometry/Meshing time limit=10", "Geometry/Meshing memory limit=2"]

NUMBER = re.compile(rb"(?<![\w.])[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?(?![\w.])")

# Limits of number types and ranges, both signs, and texts that are not numbers
NUMBERS = [b"0", b"-0", b"-1", b"1e308", b"-1e308", b"1e309", b"5e-324", b"1e18", b"nan", b"inf", b"-inf", b"2147483647", b"2147483648",
           b"-2147483649", b"4294967296", b"9223372036854775808", b"18446744073709551616", b"1" * 400, b"0x10", b"1e", b"1,5", b"one", b""]

WORDS = [b" ", b"true", b"none", b",", b";;;;", b": :", b"1, 2, 3", b"1; 2", b"pin_top_1: nan, 1, 1", b"pin_top_1: 1: 2", b"1000: 0.01, 500: 0.5",
         b"%s%n%x", b'"', b"{", b"\\", b"$(true)", b"..", b"/dev/zero", b"/dev/stdin", b"/proc/self/mem", b"\xff\xfe", b"\xe2\x82", b"\x1b[2J",
         "μ１".encode(), b"x" * 300, b"x" * 100_000]

# Sections that are not closed, closed twice, nested or unknown; unknown and duplicate names; files that include
# themselves
STRUCTURE = [b"end", b"subsection", b"subsection Geometry", b"subsection Geometry/File", b"set", b"set = 1", b"set Study", b"unknown line",
             b"set Study = sweep\nset Study = stability", b"subsection No section\nend", b"set No parameter = 1", b"\\\n" * 1000,
             b"subsection Geometry\nset Pin layers = 2\nend\n" * 3, b"subsection x\n" * 100_000, b"set Study = \\\nsweep", b"include case.prm",
             b"include missing.prm", b"include .", b"include /dev/zero", b"include " + b"x" * 5000, b"include \xff\xff", b"set " + b"x" * 100_000 + b" = 1"]

STATEMENTS = ["Exit;", "Abort;", 'Error("x");', "For i In {1 : 1000000000}\n  a = i;\nEndFor", "l() = {1 : 100000000}; m() = {l(), l()};",
              'SystemCall "touch trace";', 'Printf("x") > "trace";', 'Save "trace.msh";', 'Include "case.geo";', 'Merge "missing.msh";',
              'Include "/dev/zero";', "Delete Model;", "Mesh 3;", "RefineMesh;", "Mesh.ElementOrder = 2;", "Physical Volume(1) = {99};",
              'Physical Volume("disc") = {};', 'Physical Surface("") = {1};', "Coherence;", "Point(1) = {0/0, 1/0, 1e308};", "\x1b[2J;",
              "Recursive Delete { Volume{:}; }", "Mesh.MeshSizeFactor = 1e-6;", "Mesh.Algorithm = 99;", "Transfinite Curve{:} = 1000000;",
              "General.NumThreads = -1;", "If (1)", "EndIf", "Call y;", "DefineNumber[", "a" * 100_000 + " = 1;", "(" * 10_000, "/*", '"',
              "Dilate {{0, 0, 0}, 0} { Volume{:}; }", "OnelabRun(\"x\", \"touch trace\");", "Plugin(Skin).Run;", "Mesh.Format = 1;"]

Case = collections.namedtuple("Case", "files arguments")  # files by name, including case.prm; additional arguments


def damaged(rng, data):
    """The data with one to three faults in bytes, numbers, lines or the encoding."""
    for _ in range(rng.choice([1, 1, 1, 2, 3])):
        first, length = rng.randrange(len(data) + 1), rng.choice([1, 10, 100, 1000])
        numbers, lines = [match.span() for match in NUMBER.finditer(data)], data.split(b"\n")
        i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
        kind = rng.choice(["cut", "noise", "word", "gap", "repeat", "number", "number", "number", "no line", "line", "long line", "ends", "coding"])
        if kind == "cut":
            data = data[:first]
        elif kind in ("noise", "word"):
            data = data[:first] + (rng.choice(WORDS) if kind == "word" else rng.randbytes(length // 10)) + data[first:]
        elif kind in ("gap", "repeat"):
            data = data[:first] + data[first:first + length] * (0 if kind == "gap" else rng.choice([2, 50])) + data[first + length:]
        elif kind == "number" and numbers:
            begin, end = rng.choice(numbers)
            old = data[begin:end]
            data = data[:begin] + rng.choice([rng.choice(NUMBERS), data[slice(*rng.choice(numbers))], b"-" + old, old + b"0", old + b"e5"]) + data[end:]
        elif kind == "no line":
            data = b"\n".join(lines[:i] + lines[i + length // 10 + 1:])
        elif kind == "line":
            data = b"\n".join([*lines[:i], lines[j], *lines[i:]])
        elif kind == "long line":
            lines[i] += rng.choice([b"x", b" 1", b"\xff", b"(", b"\\", b'"', b"a,"]) * rng.choice([1000, 1_000_000])
            data = b"\n".join(lines)
        elif kind == "ends":
            data = data.replace(b"\n", rng.choice([b"\r\n", b"\r", b"\0\n", b"\v"]))
        else:
            data = rng.choice([data.decode("utf-8", "replace").encode("utf-16"), b"\xef\xbb\xbf" + data, data.upper()])
    return data


def environment(folder):
    """Environment with a separate folder for temporary files, to detect files that are left behind."""
    result = {**os.environ, "TMPDIR": str(folder), "HOME": str(folder)}
    if "sanitizers" in EXECUTABLE:
        result.setdefault("ASAN_OPTIONS", "abort_on_error=1:detect_leaks=0")
        result.setdefault("UBSAN_OPTIONS", "abort_on_error=1:print_stacktrace=1")
    return result


def limit_memory():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if "sanitizers" not in EXECUTABLE:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def call(folder, temporary, arguments):
    """Finished process. If the time limit is exceeded, the process group is killed and None is returned."""
    process = subprocess.Popen([EXECUTABLE, "case.prm", *arguments], cwd=folder, env=environment(temporary), stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.PIPE, preexec_fn=limit_memory, start_new_session=True)
    try:
        out, err = process.communicate(timeout=TIME_LIMIT)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        process.communicate()
        return None
    err = b"".join(line for line in err.splitlines(keepends=True) if not line.startswith(b"[hwloc"))
    return subprocess.CompletedProcess(process.args, process.returncode, out, err)


def faults_of_message(process):
    """Faults in the message of a rejected run; a successful run must not print a message."""
    text = process.stderr.decode("utf-8", "replace")
    if process.returncode == 0:
        return [f"exit status 0 with a message: {text!r}"] if text.strip() else []
    if process.returncode != 1:
        return [f"exit status {process.returncode}: {text[-3000:]}"]
    lines = text.strip().split("\n")
    faults = {"not one message in three parts": [sum(line.startswith(part) and len(line) > len(part) for line in lines)
                                                 for part in PARTS] != [1, 1, 1],
              "message too long": len(text) > LARGEST_MESSAGE,
              "control characters in the message": any(ord(c) < 0x20 and c != "\n" or 0x7F <= ord(c) < 0xA0 for c in text),
              "the message reports a defect": "defect of the program" in text}
    return [f"{fault}: {text[:3000]!r}" for fault, is_there in faults.items() if is_there]


def faults_of_results(folder):
    """Faults in the results: no record of the run, or numbers that are not finite."""
    if not (folder / "run.json").exists():
        return ["exit status 0, but run.json is missing"]
    return [f"{text} in {path.name}" for path in folder.glob("*.csv") for row in read_table(path) for text in row.values()
            if isinstance(text, str) and text.strip().lower() in ("nan", "-nan", "inf", "-inf")]


def names_below(folder):
    """Paths of all files and folders, without the session folders (ompi.*) that Open MPI 5 keeps."""
    paths = (path.relative_to(folder) for path in folder.rglob("*"))
    return sorted(str(path) for path in paths if not path.parts[0].startswith("ompi."))


def try_case(case, is_whole):
    """Runs a case; returns the outcome and the faults."""
    with tempfile.TemporaryDirectory() as place, tempfile.TemporaryDirectory() as temporary:
        folder, temporary = pathlib.Path(place), pathlib.Path(temporary)
        for name, content in case.files.items():
            (folder / name).write_bytes(content)
        before = names_below(folder)
        for options in (["--dry-run"], []) if is_whole else (["--dry-run"],):
            process = call(folder, temporary, ["--output", "results", *case.arguments, *options])
            if process is None:
                return "hangs", [f"not finished within {TIME_LIMIT} s"]
            outcome = {0: "dry run" if options else "run", 1: "rejected" if options else "rejected late"}.get(process.returncode, "crash")
            found = faults_of_message(process)
            there = names_below(folder)
            if outcome == "run":
                found += faults_of_results(folder / "results")
                there = [name for name in there if not name.startswith("results")]
            if there != before or names_below(temporary):
                found.append(f"files created or removed: {sorted(set(there) ^ set(before))[:5]}, temporary files left: {names_below(temporary)[:5]}")
            memory = EXPECTED.search(process.stdout.decode("utf-8", "replace"))
            if found or process.returncode != 0 or not memory or float(memory[1]) > 0.5:
                return outcome, found
        return outcome, []


class Fuzzer:
    """Cases of all kinds of input, derived from the parameters and files of the program and a mesh of two blocks."""

    kinds = ["parameters", "settings", "meshes", "scripts"]

    def __init__(self, seed, kinds=()):
        self.seed, self.kinds, self.rng = seed, kinds or self.kinds, None
        listing = subprocess.run([EXECUTABLE, "--print-parameters"], text=True, capture_output=True, check=True).stdout
        self.parameters, sections = [], []  # (sections, name, default value) of each parameter
        for line in listing.splitlines():
            if line.strip().startswith("subsection"):
                sections.append(line.split(maxsplit=1)[1])
            elif line.strip() == "end":
                sections.pop()
            elif setting := re.match(r"\s*set (.*?)\s*=\s*(.*)", line):
                self.parameters.append((sections[:], setting[1], setting[2].encode()))
        self.scenes = [SCENE.encode()] * 3 + [path.read_bytes() for path in sorted((SOURCE / "prm").rglob("*.prm"))]
        blocks = (BLOCKS + HEXAHEDRA + VOLUMES + SURFACES).encode()
        self.scripts = [blocks, *(path.read_bytes() for path in sorted((SOURCE / "geometry").glob("*.geo")))]
        with tempfile.TemporaryDirectory() as place:
            folder = pathlib.Path(place)
            (folder / "case.prm").write_text(SCENE, encoding="utf-8")
            (folder / "case.geo").write_bytes(blocks)
            call(folder, folder, ["--output", "results", *settings(["Geometry/File=case.geo", "Mounts/Elastic mounts="])])
            self.mesh = (folder / "results" / "mesh.msh").read_bytes()

    def assignment(self):
        """Sections and name of a random parameter, with an unusual or damaged value."""
        sections, name, value = self.rng.choice(self.parameters)
        return sections, name.encode(), self.rng.choice([self.rng.choice(NUMBERS), self.rng.choice(WORDS), damaged(self.rng, value)])

    def parameter_file(self):
        scene = self.rng.choice(self.scenes)
        kind = self.rng.choice(["damaged", "values", "values", "structure"])
        if kind == "damaged":
            return damaged(self.rng, scene)
        lines = scene.split(b"\n")
        for _ in range(self.rng.choice([1, 1, 2, 3])):
            if kind == "structure":
                lines.insert(self.rng.randrange(len(lines) + 1), self.rng.choice(STRUCTURE))
            else:
                sections, name, value = self.assignment()
                lines += [*(b"subsection " + section.encode() for section in sections), b"set " + name + b" = " + value, *[b"end"] * len(sections)]
        return b"\n".join(lines)

    def script(self):
        lines = self.rng.choice(self.scripts).split(b"\n")
        if self.rng.random() < 0.5:
            return damaged(self.rng, b"\n".join(lines))
        for _ in range(self.rng.choice([1, 1, 2])):
            lines.insert(self.rng.randrange(len(lines) + 1), self.rng.choice(STATEMENTS).encode())
        return b"\n".join(lines)

    def case(self, number):
        """Kind, Case, and whether a small model is run after the dry run; determined by seed and number."""
        self.rng = random.Random(f"{self.seed} {number}")
        kind, arguments = self.kinds[number % len(self.kinds)], settings(LIMITS)
        files = {"case.prm": self.parameter_file() if kind == "parameters" else SCENE.encode()}
        if kind == "settings":
            for _ in range(self.rng.choice([1, 1, 2, 3])):
                sections, name, value = self.assignment()
                # Command-line arguments cannot exceed 128 KiB or contain zero bytes
                arguments += ["--set", b"/".join([*(section.encode() for section in sections), name + b"=" + value]).replace(b"\0", b"")[:100_000]]
        elif kind != "parameters":
            name = "case.msh" if kind == "meshes" else "case.geo"
            files[name] = damaged(self.rng, self.mesh) if kind == "meshes" else self.script()
            arguments += settings([f"Geometry/File={name}", "Mounts/Elastic mounts="])
        return kind, Case(files, arguments), self.rng.random() < 0.3

    def run(self, number):
        kind, case, is_whole = self.case(number)
        return (kind, case, *try_case(case, is_whole))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", action="append", choices=Fuzzer.kinds)
    options = parser.parse_args()
    fuzzer, outcomes, n_failed = Fuzzer(options.seed, options.kind), collections.Counter(), 0
    for number in range(options.first, options.first + options.cases):
        kind, case, outcome, found = fuzzer.run(number)
        outcomes[kind, outcome] += 1
        if found:
            n_failed += 1
            folder = pathlib.Path("build/fuzz") / f"{options.seed}-{number}"
            folder.mkdir(parents=True, exist_ok=True)
            for name, content in case.files.items():
                (folder / name).write_bytes(content)
            print(f"case {number} ({kind}), kept in {folder}: {case.arguments} " + "; ".join(found)[:1500], flush=True)
    for (kind, outcome), n in sorted(outcomes.items()):
        print(f"{kind:12}{outcome:14}{n:6}")
    print(f"{sum(outcomes.values())} cases, {n_failed} failed")
    return 1 if n_failed else 0


if __name__ == "__main__":
    sys.exit(main())
