#!/usr/bin/python3
"""The whole table of doc/benchmarks.md: charts, one friction coefficient and the default run, on one core and on two.

    scripts/benchmark_table.py [--runs 3] [--cores 0,1] [--rows chart,damped,one,default]

Each row is a run of squeal from the mesh to its tables and, in the same round, SLEPc in the formulation that is fastest for the problem:

    chart    prm/sweep.prm, 90 friction coefficients without dissipation: 90 times the mean of SLEPc's times at five of them
    damped   prm/sweep_damped.prm without its count, 90 with dissipation and 90 without: 90 times the sum of both means
    one      one friction coefficient from the assembled matrices, real modes and the count included, without and with dissipation
    default  prm/disc_pins.prm with all its fields; no peer

On one core, times are processor seconds and ratios those of one core against one core. On two cores the same run is timed by the clock
with one thread and with two, one after the other; their ratio is what the second core gains. Medians of all rounds, with the smallest and
the largest. Needs SLEPc (scripts/setup.sh peers) for all rows but the last.
"""

import argparse
import pathlib
import statistics
import tempfile

import benchmarking
import slepc_modes
from benchmark_sweep import coefficients
from squeal.command_line import exit_on_error
from squeal.errors import Error

PRM = benchmarking.SOURCE / "prm"
NO_FIELDS = ["Output/Mode shapes=none"]
MATRICES = ["Study=stability", "Output/Write matrices=true", *NO_FIELDS]
DISSIPATION = "Operation/Radial dissipation=consistent"


class Rounds:
    """What the rounds of a row measured, by the name of the quantity."""

    def __init__(self, title):
        self.title, self.values = title, {}

    def add(self, name, value):
        self.values.setdefault(name, []).append(value)

    def print(self):
        print(f"\n{self.title}")
        for name, values in self.values.items():
            print(f"  {name:<62} {benchmarking.spread(values, 2)}", flush=True)


def gain_of_cores(rounds, cores, parameter_file, folder, settings):
    """Adds what a second core gains by the clock."""
    if len(cores) < 2:
        return
    one, two = (benchmarking.run_squeal(chosen, parameter_file, folder / "by_the_clock", settings)["wall time [s]"]
                for chosen in (cores[:1], cores[:2]))
    rounds.add("by the clock on one core [s]", one)
    rounds.add("by the clock on two cores [s]", two)
    rounds.add("gain of the second core [-]", one / two)


def matrices_of(folder, name, parameter_file, settings, core):
    """The matrices of a scene for SLEPc, and its number of modes; written once."""
    directory = folder / name
    if not directory.exists():
        benchmarking.run_squeal(core, parameter_file, directory, [*settings, *MATRICES])
    return directory, benchmarking.n_rows(directory / "real_modes.csv")


def mean_peer(rounds, core, matrices, chosen):
    """Mean processor seconds of SLEPc over some friction coefficients."""
    directory, n_modes = matrices
    solutions = [benchmarking.run_peer(core, directory, n_modes, friction_coefficient=mu) for mu in chosen]
    for solution in solutions:
        if solution["modes"] != n_modes:
            print(f"  note: SLEPc {solution['formulation']} found {solution['modes']} of {n_modes} modes")
    mean = statistics.mean(solution["CPU time [s]"] for solution in solutions)
    rounds.add(f"SLEPc {solutions[0]['formulation']}, one friction coefficient, CPU [s]", mean)
    return mean


def chart(cores, folder, n_rounds, damped):
    """A sweep beside as many solutions."""
    parameter_file = PRM / ("sweep_damped.prm" if damped else "sweep.prm")
    settings = ["Sweep/Count modes at=", *NO_FIELDS] if damped else NO_FIELDS
    rounds = Rounds(f"{parameter_file.name}{', without its count' if damped else ''}")
    scenes = [matrices_of(folder, "undamped", PRM / "sweep.prm", [], cores[:1])]
    if damped:
        scenes.append(matrices_of(folder, "damped", PRM / "sweep.prm", [DISSIPATION], cores[:1]))
    for _ in range(n_rounds):
        record = benchmarking.run_squeal(cores[:1], parameter_file, folder / "sweep", settings)
        seconds = benchmarking.cpu_seconds(record)
        rounds.add("squeal, the whole run, CPU [s]", seconds)
        number, chosen = coefficients(folder / "sweep")
        peers = sum(mean_peer(rounds, cores[:1], scene, chosen) for scene in scenes)
        rounds.add(f"{number} solutions by SLEPc / the run [-]", number * peers / seconds)
        gain_of_cores(rounds, cores, parameter_file, folder, settings)
    rounds.print()


def one(cores, folder, n_rounds):
    """One friction coefficient from matrices."""
    for damped in (False, True):
        rounds = Rounds(f"one friction coefficient, {'consistent' if damped else 'no'} dissipation, from the assembled matrices")
        scene = matrices_of(folder, "damped" if damped else "undamped", PRM / "sweep.prm", [DISSIPATION] if damped else [], cores[:1])
        settings = [*([DISSIPATION] if damped else []), *NO_FIELDS]
        for _ in range(n_rounds):
            record = benchmarking.run_squeal(cores[:1], PRM / "disc_pins.prm", folder / "one", settings)
            seconds = benchmarking.cpu_seconds(record, {"Mode count", "Factorisation", "Real modes", "Complex modes"})
            rounds.add("squeal, count, factor, real and complex modes, CPU [s]", seconds)
            rounds.add("squeal / SLEPc [-]", seconds / mean_peer(rounds, cores[:1], scene, [0.4]))
        rounds.print()


def default(cores, folder, n_rounds):
    """The default run with its fields."""
    rounds = Rounds("disc_pins.prm with all fields")
    for _ in range(n_rounds):
        record = benchmarking.run_squeal(cores[:1], PRM / "disc_pins.prm", folder / "default")
        rounds.add("squeal, CPU [s]", benchmarking.cpu_seconds(record))
        gain_of_cores(rounds, cores, PRM / "disc_pins.prm", folder, [])
    rounds.print()


ROWS = {"chart": lambda *arguments: chart(*arguments, damped=False), "damped": lambda *arguments: chart(*arguments, damped=True),
        "one": one, "default": default}


@exit_on_error()
def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--runs", type=int, default=3, help="rounds (default: %(default)s)")
    parser.add_argument("--cores", default="0,1", help="one or two cores (default: %(default)s)")
    parser.add_argument("--rows", default=",".join(ROWS), help="rows of the table (default: all)")
    arguments = parser.parse_args()
    rows = arguments.rows.split(",")
    if unknown := [row for row in rows if row not in ROWS]:
        raise Error(f"there is no row {unknown[0]}", "command line", f"give some of {', '.join(ROWS)}")
    if rows != ["default"] and not slepc_modes.available():
        raise slepc_modes.missing()
    cores = [int(core) for core in arguments.cores.split(",")]
    print(benchmarking.describe_machine(cores[0]))
    with tempfile.TemporaryDirectory() as folder:
        for row in rows:
            ROWS[row](cores, pathlib.Path(folder), arguments.runs)


if __name__ == "__main__":
    main()
