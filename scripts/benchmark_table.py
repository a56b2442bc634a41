#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Measures the times in the summary of doc/benchmarks.md and in the comparison with SLEPc: charts, one friction
coefficient and the default run, on one core and on two.

    scripts/benchmark_table.py [--runs 3] [--cores 0,1] [--rows chart,damped,one,default]

Each row except the last compares squeal with SLEPc in the same round:

    chart    the whole run of prm/sweep.prm, 90 friction coefficients without dissipation; SLEPc: 90 times the mean time at five of these
    damped   the whole run of prm/sweep_damped.prm without mode count, 90 friction coefficients with dissipation and 90 without; SLEPc: 90
             times the sum of both means
    one      one friction coefficient from the assembled matrices, including real modes and mode count, without and with dissipation;
             SLEPc in every applicable formulation of scripts/slepc_modes.py
    default  prm/disc_pins.prm with all fields, without SLEPc

Times on one core are CPU seconds. SLEPc is given the number of modes; its times cover the solution from the assembled
matrices in memory. With two cores, the wall time of each whole run is measured on one core and on two; the ratio is the
speed-up. Prints medians of all rounds with the smallest and largest values. All rows except the last require SLEPc
(scripts/setup.sh peers).
"""

import json
import pathlib
import statistics
import tempfile

import benchmarking
import slepc_modes
from benchmarking import Rounds
from squeal.command_line import Parser, exit_on_error
from squeal.errors import Error
from squeal.results import Results

PRM = benchmarking.SOURCE / "prm"
NO_FIELDS = ["Output/Mode shapes=none"]
DISSIPATION = "Operation/Radial dissipation=consistent"
PARTS = (0.1, 0.3, 0.5, 0.7, 0.9)  # positions in the range of a sweep at which SLEPc computes modes


def gain_of_cores(rounds, cores, parameter_file, folder, settings):
    """Measures the speed-up by a second core, if one is given, and adds it to the rounds."""
    if len(cores) < 2:
        return
    one, two = (benchmarking.run_squeal(chosen, parameter_file, folder / "by_the_clock", settings)["wall time [s]"]
                for chosen in (cores[:1], cores[:2]))
    rounds.add("wall time on one core [s]", one)
    rounds.add("wall time on two cores [s]", two)
    rounds.add("speed-up by the second core [-]", one / two)


def model_of(folder, damped, core):
    """The results of the default model with its matrices, computed once."""
    folder = folder / ("damped" if damped else "undamped")
    if not folder.exists():
        settings = [*NO_FIELDS, "Study=stability", "Output/Write matrices=true", *([DISSIPATION] if damped else [])]
        benchmarking.run_squeal(core, PRM / "sweep.prm", folder, settings)
    return Results(folder)


def mean_of_slepc(rounds, core, model, options):
    """Mean CPU seconds of solutions by SLEPc, one for each list of options of scripts/slepc_modes.py."""
    solutions = [solution_by_slepc(core, model, own) for own in options]
    mean = statistics.mean(solution["CPU time [s]"] for solution in solutions)
    rounds.add(f"SLEPc {solutions[0]['formulation']}, one friction coefficient, CPU [s]", mean)
    return mean


def solution_by_slepc(core, model, options):
    """The record of one solution by SLEPc."""
    n_modes = len(model.table("complex_modes"))
    with tempfile.NamedTemporaryFile(suffix=".json") as file:
        command = [benchmarking.PEER, model.folder, "--modes", n_modes, "--runs", 1, "--json", file.name, *options]
        benchmarking.run_on_cores(core, command)
        solution, = json.loads(pathlib.Path(file.name).read_text(encoding="utf-8"))
    if solution["modes"] != n_modes:
        print(f"  note: SLEPc {solution['formulation']} found {solution['modes']} of {n_modes} modes", flush=True)
    elif solution.get("largest difference"):
        difference = solution["largest difference"]
        print(f"  SLEPc {solution['formulation']}: all modes, largest difference {difference:.1e}", flush=True)
    return solution


def chart(cores, folder, n_rounds, damped):
    """Measures a sweep and the same number of solutions by SLEPc."""
    parameter_file = PRM / ("sweep_damped.prm" if damped else "sweep.prm")
    settings = ["Sweep/Count modes at=", *NO_FIELDS] if damped else NO_FIELDS
    rounds = Rounds(f"{parameter_file.name}{', without mode count' if damped else ''}")
    models = [model_of(folder, of_damped, cores[:1]) for of_damped in ((False, True) if damped else (False,))]
    for _ in range(n_rounds):
        record = benchmarking.run_squeal(cores[:1], parameter_file, folder / "sweep", settings)
        seconds = benchmarking.cpu_seconds(record)
        rounds.add("squeal, the whole run, CPU [s]", seconds)
        for name in dict.fromkeys(step["name"] for step in record["steps"]):
            rounds.add(f"  {name}", benchmarking.cpu_seconds(record, {name}))
        names = ("Number of friction coefficients", "First friction coefficient", "Last friction coefficient")
        number, first, last = (Results(folder / "sweep").number(f"Sweep/{name}") for name in names)
        chosen = [["--mu", repr(first + part * (last - first))] for part in PARTS]
        of_slepc = number * sum(mean_of_slepc(rounds, cores[:1], model, chosen) for model in models)
        rounds.add(f"{number:.0f} solutions by SLEPc / the run [-]", of_slepc / seconds)
        gain_of_cores(rounds, cores, parameter_file, folder, settings)
    rounds.print()


def one(cores, folder, n_rounds):
    """Measures one friction coefficient, from the assembled matrices."""
    for damped in (False, True):
        rounds = Rounds(f"one friction coefficient, {'consistent' if damped else 'no'} dissipation, from the assembled matrices")
        model = model_of(folder, damped, cores[:1])
        for _ in range(n_rounds):
            settings = [*NO_FIELDS, *([DISSIPATION] if damped else [])]
            record = benchmarking.run_squeal(cores[:1], PRM / "disc_pins.prm", folder / "one", settings)
            seconds = benchmarking.cpu_seconds(record, benchmarking.FULL_ORDER)
            rounds.add("squeal, count, factor, real and complex modes, CPU [s]", seconds)
            for formulation in slepc_modes.FORMULATIONS[damped:]:
                of_slepc = mean_of_slepc(rounds, cores[:1], model, [["--formulation", formulation]])
                rounds.add(f"  squeal / SLEPc {formulation} [-]", seconds / of_slepc)
        rounds.print()


def default(cores, folder, n_rounds):
    """Measures the default run with its fields."""
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
        raise Error(f"there is no row {unknown[0]}", "--rows", f"choose from {', '.join(ROWS)}")
    if rows != ["default"] and not slepc_modes.available():
        raise slepc_modes.missing()
    cores = [int(core) for core in arguments.cores.split(",")]
    print(benchmarking.describe_machine(cores[0]))
    with tempfile.TemporaryDirectory() as folder:
        for row in rows:
            ROWS[row](cores, pathlib.Path(folder), arguments.runs)


if __name__ == "__main__":
    main()
