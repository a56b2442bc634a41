#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""The whole table of doc/benchmarks.md: charts, one friction coefficient and the default run, on one core and on two.

    scripts/benchmark_table.py [--runs 3] [--cores 0,1] [--rows chart,damped,one,default]

Each row is a run of squeal from the mesh to its tables and, in the same round, SLEPc in its fastest formulation for the problem:

    chart    prm/sweep.prm, 90 friction coefficients without dissipation: 90 times the mean of SLEPc's times at five of them
    damped   prm/sweep_damped.prm without mode count, 90 with dissipation and 90 without: 90 times the sum of both means
    one      one friction coefficient from the assembled matrices, including real modes and mode count, without and with dissipation
    default  prm/disc_pins.prm with all fields, without SLEPc

Times on one core are CPU seconds. On two cores the same run is timed by wall clock with one and two threads; the ratio is the speed-up.
Prints medians of all rounds with the smallest and largest values. All rows except the last require SLEPc (scripts/setup.sh peers).
"""

import pathlib
import tempfile

import benchmarking
import slepc_modes
from benchmarking import Rounds
from squeal.command_line import Parser, exit_on_error
from squeal.errors import Error

PRM = benchmarking.SOURCE / "prm"
NO_FIELDS = ["Output/Mode shapes=none"]
DISSIPATION = "Operation/Radial dissipation=consistent"


def gain_of_cores(rounds, cores, parameter_file, folder, settings):
    """Adds the speed-up by a second core."""
    if len(cores) < 2:
        return
    one, two = (benchmarking.run_squeal(chosen, parameter_file, folder / "by_the_clock", settings)["wall time [s]"]
                for chosen in (cores[:1], cores[:2]))
    rounds.add("wall time on one core [s]", one)
    rounds.add("wall time on two cores [s]", two)
    rounds.add("speed-up by the second core [-]", one / two)


def model_of(folder, damped, core):
    return benchmarking.matrices_of(folder / ("damped" if damped else "undamped"), PRM / "sweep.prm", [DISSIPATION] if damped else [], core)


def chart(cores, folder, n_rounds, damped):
    """A sweep and the same number of solutions by SLEPc."""
    parameter_file = PRM / ("sweep_damped.prm" if damped else "sweep.prm")
    settings = ["Sweep/Count modes at=", *NO_FIELDS] if damped else NO_FIELDS
    rounds = Rounds(f"{parameter_file.name}{', without mode count' if damped else ''}")
    models = [model_of(folder, of_damped, cores[:1]) for of_damped in ((False, True) if damped else (False,))]
    for _ in range(n_rounds):
        benchmarking.compare_sweep(rounds, cores[:1], parameter_file, settings, folder / "sweep", models)
        gain_of_cores(rounds, cores, parameter_file, folder, settings)
    rounds.print()


def one(cores, folder, n_rounds):
    """One friction coefficient from the assembled matrices."""
    for damped in (False, True):
        rounds = Rounds(f"one friction coefficient, {'consistent' if damped else 'no'} dissipation, from the assembled matrices")
        model = model_of(folder, damped, cores[:1])
        for _ in range(n_rounds):
            record = benchmarking.run_squeal(cores[:1], PRM / "disc_pins.prm", folder / "one", [*NO_FIELDS, *([DISSIPATION] if damped else [])])
            seconds = benchmarking.cpu_seconds(record, {"Mode count", "Factorisation", "Real modes", "Complex modes"})
            rounds.add("squeal, count, factor, real and complex modes, CPU [s]", seconds)
            rounds.add("squeal / SLEPc [-]", seconds / benchmarking.mean_peer(rounds, cores[:1], model, [0.4]))
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
    parser = Parser(__doc__)
    parser.add_argument("--runs", type=int, default=3, help="rounds (default: %(default)s)")
    parser.add_argument("--cores", default="0,1", help="one or two cores (default: %(default)s)")
    parser.add_argument("--rows", default=",".join(ROWS), help="rows of the table (default: all)")
    arguments = parser.parse_args()
    rows = arguments.rows.split(",")
    if unknown := [row for row in rows if row not in ROWS]:
        raise Error(f"there is no row {unknown[0]}", "command line", f"choose from {', '.join(ROWS)}")
    if rows != ["default"] and not slepc_modes.available():
        raise slepc_modes.missing()
    cores = [int(core) for core in arguments.cores.split(",")]
    print(benchmarking.describe_machine(cores[0]))
    with tempfile.TemporaryDirectory() as folder:
        for row in rows:
            ROWS[row](cores, pathlib.Path(folder), arguments.runs)


if __name__ == "__main__":
    main()
