#!/usr/bin/python3
"""Times an error-controlled sweep on one core beside full-order solutions by SLEPc, with the same BLAS kernels.

    scripts/benchmark_sweep.py PRM [--set "Section/Name=value"]... [--runs 3] [--core 0]

PRM is a parameter file with Study = sweep; the settings are handed to squeal. SLEPc solves the problem in the formulation that is
fastest for it: without damping the linear one in lambda^2 (scripts/slepc_modes.py).

Processor seconds: of squeal, the whole run from the mesh to the tables; of SLEPc, the solution from the assembled matrices at
friction coefficients spread over the sweep, of which the mean stands for all. Both run in turn: in every run a sweep, then five solutions.
Where the sweep makes the chart without dissipation besides, that is counted to squeal alone.
"""

import pathlib
import statistics
import tempfile

import benchmarking
from squeal.command_line import exit_on_error

PARTS = (0.1, 0.3, 0.5, 0.7, 0.9)


def coefficients(directory):
    """Number of friction coefficients of a sweep, and those of them that SLEPc is asked for."""
    number, first, last = (float(benchmarking.parameter(directory, f"Sweep/{name}"))
                           for name in ("Number of friction coefficients", "First friction coefficient", "Last friction coefficient"))
    return int(number), [first + part * (last - first) for part in PARTS]


@exit_on_error()
def main():
    parser = benchmarking.sweep_parser(__doc__)
    arguments = parser.parse_args()

    print(benchmarking.describe_machine(arguments.core), flush=True)
    sweeps, solutions, ratios = [], [], []
    with tempfile.TemporaryDirectory() as folder:
        directory = pathlib.Path(folder)
        benchmarking.run_squeal(arguments.core, arguments.parameter_file, directory / "matrices",
                                [*arguments.settings, "Study=stability", "Output/Write matrices=true", "Output/Mode shapes=none"])
        n_modes = benchmarking.n_rows(directory / "matrices" / "real_modes.csv")
        for run in range(1, arguments.runs + 1):
            record = benchmarking.run_squeal(arguments.core, arguments.parameter_file, directory / "sweep", arguments.settings)
            number, chosen = coefficients(directory / "sweep")
            names = dict.fromkeys(step["name"] for step in record["steps"])
            steps = {name: benchmarking.cpu_seconds(record, {name}) for name in names}
            print(f"run {run}: squeal {sum(steps.values()):.1f} s for {number} friction coefficients: "
                  + ", ".join(f"{name} {seconds:.1f}" for name, seconds in steps.items()), flush=True)
            times = []
            for friction_coefficient in chosen:
                solution = benchmarking.run_peer(arguments.core, directory / "matrices", n_modes, friction_coefficient=friction_coefficient)
                times.append(solution["CPU time [s]"])
                print(f"  SLEPc {solution['formulation']}, mu = {friction_coefficient:.3f}: {times[-1]:.1f} s, {solution['modes']} modes",
                      flush=True)
            sweeps.append(sum(steps.values()))
            solutions += times
            ratios.append(number * statistics.mean(times) / sweeps[-1])
    print(f"\nmedian CPU [s]: sweep {benchmarking.spread(sweeps)}; one solution by SLEPc {benchmarking.spread(solutions)}")
    print(f"{number} solutions take {benchmarking.spread(ratios)} times as long as the sweep")


if __name__ == "__main__":
    main()
