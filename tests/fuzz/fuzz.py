#!/usr/bin/python3
"""Gives the program damaged input for a while, and says which it does not bear.

    SQUEAL=build/sanitizers/squeal tests/fuzz/fuzz.py [--minutes N | --cases N] [--seed N] [--jobs N] [--kind KIND]... [--keep DIR]

Whatever it gets, the program either works or ends with exit status 1 and one message that says what, where and what to change. It does
not crash, runs no longer than it may, and leaves no file but complete results. KIND is parameters (files), settings (of the command
line), meshes or scripts. What is dry-run successfully and small is then run to its end.

Without SQUEAL it is build/release/squeal. The default seed is random, and printed. Case N of a seed always is the same. Failing cases go to DIR: their files, and `arguments`,
one on each line. Those in tests/fuzz/cases once failed; the tests run them all. The exit status is 1 where a case fails.
"""

import argparse
import collections
import concurrent.futures
import itertools
import os
import pathlib
import random
import re
import resource
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
os.environ["SQUEAL"] = os.path.abspath(os.environ.get("SQUEAL", HERE.parents[1] / "build/release/squeal"))
sys.path.insert(0, str(HERE.parent / "program"))

from inputs import Case, Inputs, settings  # noqa: E402 (found by the line before)
from meshes import in_all_formats  # noqa: E402
from blocks import BLOCKS, HEXAHEDRA, SURFACES, VOLUMES  # noqa: E402
from program import EXECUTABLE, SCENE, read_table  # noqa: E402

TIME_LIMIT = 120       # [s] of a run, on a busy machine
LARGEST_MESSAGE = 6000  # [character]: with what Gmsh printed
MEMORY = 16 << 30      # [byte] of a process, where no sanitizer takes its own share
PARTS = ("error: ", "  where:  ", "  change: ")

# What is run to its end
MOST_MODES, MOST_MEMORY = 120, 0.5  # [1], [GB]
EXPECTED = re.compile(r"expected: some (\d+) modes .*, ([\d.e+-]+) GB of memory")


def is_sanitized():
    return "sanitizers" in EXECUTABLE


def environment(folder):
    """Temporary files have a folder of their own, where they are seen."""
    result = {**os.environ, "TMPDIR": str(folder), "HOME": str(folder)}
    if is_sanitized():
        result.setdefault("ASAN_OPTIONS", "abort_on_error=1:detect_leaks=0")
        result.setdefault("UBSAN_OPTIONS", "abort_on_error=1:print_stacktrace=1")
    return result


def limit_memory():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    if not is_sanitized():
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


def call(folder, temporary, arguments):
    """The finished process, or None where it has not ended in time; then neither has what it has started."""
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
    """What is wrong with the message of a run that was refused, or with one that says something though it succeeded."""
    text = process.stderr.decode("utf-8", "replace")
    if process.returncode == 0:
        return [f"success with a message: {text!r}"] if text.strip() else []
    if process.returncode != 1:
        return [f"exit status {process.returncode}: {text[-3000:]}"]
    lines = text.strip().split("\n")
    counts = [sum(line.startswith(part) and len(line) > len(part) for line in lines) for part in PARTS]
    found = []
    if counts != [1, 1, 1] or not lines[0].startswith(PARTS[0]):
        found.append(f"not one message: {text[:3000]!r}")
    if len(text) > LARGEST_MESSAGE:
        found.append(f"a message of {len(text)} characters: {text[:300]!r}")
    if any(ord(c) < 0x20 and c != "\n" or 0x7F <= ord(c) < 0xA0 for c in text):
        found.append(f"control characters in the message: {text[:3000]!r}")
    if "defect of the program" in text:
        found.append(f"a defect: {text[:3000]!r}")
    return found


def names_below(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*"))


def faults_of_results(folder):
    """Results are complete, and every number in them is one."""
    if not (folder / "run.json").exists():
        return ["success without results"]
    return [f"{text} in {path.name}" for path in folder.glob("*.csv") for row in read_table(path) for text in row.values()
            if isinstance(text, str) and text.strip().lower() in ("nan", "-nan", "inf", "-inf")]


def is_small(process):
    found = EXPECTED.search(process.stdout.decode("utf-8", "replace"))
    return found is not None and int(found[1]) <= MOST_MODES and float(found[2]) <= MOST_MEMORY


def try_case(case, is_whole):
    """Runs a case; returns what came of it in a word or two, and what is wrong."""
    with tempfile.TemporaryDirectory() as place, tempfile.TemporaryDirectory() as temporary:
        folder, temporary = pathlib.Path(place), pathlib.Path(temporary)
        case.write(folder)
        before = names_below(folder)
        outcome = ""
        for options in (["--dry-run"], []) if is_whole else (["--dry-run"],):
            process = call(folder, temporary, ["--output", "results", *case.arguments, *options])
            if process is None:
                return "hangs", [f"no end within {TIME_LIMIT} s"]
            outcome = {0: "dry run" if options else "run", 1: "refused" if options else "refused late"}.get(process.returncode, "crash")
            found = faults_of_message(process)
            if process.returncode == 0 and not options:
                found += faults_of_results(folder / "results")
                before = [*before, *names_below(folder / "results")]
                if {name for name in names_below(folder) if not name.startswith("results")} - set(before):
                    found.append("files beside the results")
            elif names_below(folder) != before:
                found.append(f"left behind: {sorted(set(names_below(folder)) ^ set(before))[:5]}")
            if names_below(temporary):
                found.append(f"temporary files: {names_below(temporary)[:5]}")
            if found or process.returncode != 0 or not is_small(process):
                return outcome, found
        return outcome, []


def small_mesh():
    """Two blocks one upon the other, in several formats."""
    with tempfile.TemporaryDirectory() as place:
        folder = pathlib.Path(place)
        Case({"case.prm": SCENE.encode(), "case.geo": (BLOCKS + HEXAHEDRA + VOLUMES + SURFACES).encode()}).write(folder)
        process = call(folder, folder, ["--output", "results", *settings("Geometry/File=case.geo", "Mounts/Elastic mounts=")])
        if process is None or process.returncode != 0:
            sys.exit(f"The undamaged scene fails:\n{process and process.stderr.decode()}")
        return in_all_formats(folder / "results" / "mesh.msh")


def listing():
    return subprocess.run([EXECUTABLE, "--print-parameters"], env=environment("/nonexistent"), text=True, capture_output=True, check=True).stdout


def cases_kept(folder=HERE / "cases"):
    """Cases that once failed, by their names."""
    for path in sorted(folder.iterdir()):
        files = {file.name: file.read_bytes() for file in path.iterdir() if file.name != "arguments"}
        yield path.name, Case(files, (path / "arguments").read_bytes().split(b"\n")[:-1])


def keep(case, folder, found):
    folder.mkdir(parents=True, exist_ok=True)
    case.write(folder)
    (folder / "arguments").write_bytes(b"".join(os.fsencode(word) + b"\n" for word in case.arguments))
    (folder / "found").write_text("\n".join(found) + "\n", encoding="utf-8")


class Fuzzer:
    def __init__(self, seed, kinds):
        self.seed, self.listing, self.meshes = seed, listing(), small_mesh()
        self.kinds = kinds or list(Inputs(random.Random(0), self.listing, self.meshes).kinds)

    def case(self, number):
        """The same for the same seed and number, and whether it is run to its end if it is small."""
        numbers = random.Random(f"{self.seed} {number}")
        kind = self.kinds[number % len(self.kinds)]
        return kind, Inputs(numbers, self.listing, self.meshes).case(kind), numbers.random() < 0.3

    def run(self, number):
        kind, case, is_whole = self.case(number)
        return (number, kind, case, *try_case(case, is_whole))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--minutes", type=float, default=10)
    parser.add_argument("--cases", type=int, help="so many cases, however long they take")
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--seed", type=int, default=random.SystemRandom().randrange(1_000_000))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--kind", action="append", choices=["parameters", "settings", "meshes", "scripts"])
    parser.add_argument("--keep", type=pathlib.Path, default=pathlib.Path("build/fuzz"))
    options = parser.parse_args()

    fuzzer = Fuzzer(options.seed, options.kind)
    end = time.monotonic() + 60 * options.minutes
    outcomes, n_failed = collections.Counter(), 0
    print(f"seed {options.seed}", flush=True)
    numbers = itertools.count(options.first) if options.cases is None else range(options.first, options.first + options.cases)
    in_time = itertools.takewhile(lambda _: options.cases is not None or time.monotonic() < end, numbers)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        waiting = collections.deque(pool.submit(fuzzer.run, number) for number in itertools.islice(in_time, 2 * options.jobs))
        while waiting:
            number, kind, case, outcome, found = waiting.popleft().result()
            waiting.extend(pool.submit(fuzzer.run, number) for number in itertools.islice(in_time, 1))
            outcomes[kind, outcome] += 1
            if found:
                n_failed += 1
                folder = options.keep / f"{options.seed}-{number}-{kind}"
                keep(case, folder, found)
                print(f"case {number} ({kind}), kept in {folder}: " + "; ".join(found)[:1500], flush=True)
    for (kind, outcome), n in sorted(outcomes.items()):
        print(f"{kind:12}{outcome:14}{n:6}")
    print(f"{sum(outcomes.values())} cases, {n_failed} failed")
    return 1 if n_failed else 0


if __name__ == "__main__":
    sys.exit(main())
