# SPDX-License-Identifier: GPL-3.0-or-later

"""Runs a case and judges the outcome: right, refused with a reason, wrong, or not judged."""

import dataclasses
import json
import math
import re
import resource
import subprocess

import numpy as np

from extremes import oracle
from extremes.cases import BASE, RIGHT
from squeal import exported_matrices, parameter_file, quadratic
from squeal.program import find_program, words_of
from squeal.results import Table

# Largest acceptable relative difference of eigenvalues from the oracle
TOLERANCE = 1e-6
# Largest acceptable residual of a complex mode if the run does not warn of lost digits
LARGEST_RESIDUAL = 1e-8
# Relative rounding error of tables, which have 12 digits
PRINTED = 1e-11
# Relative distance from the end of the band, or from the radius, within which eigenvalues may be missing
EDGE = 1e-7
# |lambda| / end of the band up to which eigenvalues are not compared
ZERO = 1e-4
# Largest acceptable difference of dimensionless results from the model in metres
SAME_IN_ALL_UNITS = 1e-8
# Limits of the CPU time and the wall time of a run [s]
CPU_LIMIT, TIME_LIMIT = 300, 1500


@dataclasses.dataclass
class Row:
    """The outcome of a case as a row of the table."""

    group: str
    value: str
    outcome: str = ""
    modes: str = "–"
    residual: str = "–"
    count: str = "–"
    oracle: str = "–"
    deviation: str = "–"
    digits: str = "–"
    remark: str = ""

    @property
    def is_as_expected(self):
        return self.outcome in ("right", "refused")


class Wrong(Exception):
    """Raised if the program behaves incorrectly."""


def call(*arguments, folder):
    """The finished process. Raises Wrong if it exceeds the time limit or ends with a status other than 0 or 1."""
    try:
        process = subprocess.run([find_program(), *arguments], cwd=folder, text=True, capture_output=True, timeout=TIME_LIMIT, check=False,
                                 stdin=subprocess.DEVNULL, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_CPU, (CPU_LIMIT, CPU_LIMIT)))
    except subprocess.TimeoutExpired:
        raise Wrong(f"still running after {TIME_LIMIT} s") from None
    if process.returncode not in (0, 1):
        raise Wrong(f"exit status {process.returncode}: {process.stderr[-300:]}")
    process.stderr = "".join(line for line in process.stderr.splitlines(keepends=True) if not line.startswith("[hwloc"))
    return process


def check_numbers(folder):
    """Raises Wrong if a cell of a table is infinite or NaN."""
    for path in folder.glob("*.csv"):
        for row in Table(path).rows:
            for column, cell in row.items():
                if cell and cell.strip().lower().lstrip("+-") in ("nan", "inf", "infinity"):
                    raise Wrong(f"{path.name} has {cell} in {column}")


def judge(case, folder):
    """Runs a case in a folder; returns its row."""
    row = Row(case.group, case.value)
    (folder / "scene.prm").write_text(BASE, encoding="utf-8")
    try:
        process = call("scene.prm", "--output", "run", *words_of(["Output/Write matrices=true", *case.settings]), folder=folder)
        if process.returncode == 1:
            judge_refusal(case, process, folder, row)
        else:
            judge_results(case, process, folder, row)
            if case.expected != RIGHT:
                raise Wrong(f"{row.outcome}, but should have been refused: {case.expected}")
    except Wrong as wrong:
        row.outcome = "WRONG"
        row.remark = str(wrong)
    return row


def judge_refusal(case, process, folder, row):
    """Checks that the run reports one error with its reason, location and remedy, and writes no files."""
    reason = re.match(r"^error: (.*)\n  where:  .*\n  change: .*\n$", process.stderr.lstrip("\n"))
    if not reason:
        raise Wrong(f"the error output is not one message with reason, location and remedy: {process.stderr[-400:]!r}")
    if (folder / "run").exists():
        raise Wrong("rejected, but a result folder was created")
    row.outcome, row.remark = "refused", reason[1]
    if case.expected == RIGHT or case.expected not in process.stderr:
        raise Wrong(f"refused, but {case.expected!r} was expected: {reason[1]}")


def judge_results(case, process, folder, row):
    run = folder / "run"
    check_numbers(run)
    parameters = parameter_file.read_parameters(run / "parameters.prm")
    band = 2 * math.pi * float(parameters["Band/Maximum frequency"])
    friction_coefficient = float(parameters["Operation/Friction coefficient"])
    modes, path = np.array(Table(run / "complex_modes.csv").eigenvalues(), dtype=complex), run / "real_eigenvalues.csv"
    real = np.array(Table(path).numbers("growth rate [1/s]") if path.exists() else [])
    row.modes = f"{len(modes)}" + (f" + {len(real)} real" if len(real) else "")

    # ------------------------------------------------ self-consistency
    residual = max(Table(run / "complex_modes.csv").numbers("residual [-]"))
    row.residual = f"{residual:.0e}"
    found, counted = map(int, re.search(r"Real modes .* (\d+) found, (\d+) counted by inertia", process.stdout).groups())
    row.count = f"inertia {counted}"
    if found != counted:
        raise Wrong(f"{found} real modes found, {counted} counted")
    if case.argument_count:
        row.count += argument_count(case, folder, modes, band)

    # ------------------------------------------------ an independent solution
    matrices = exported_matrices.read_matrices(run)
    undamped = {**matrices, **{name: 0 * matrices[name] for name in ("C", "C_b", "G")}}
    real_modes = 2j * math.pi * np.array(Table(run / "real_modes.csv").numbers("frequency [Hz]"))
    complex_modes = np.concatenate([modes, real])
    worst, methods, own_error, dense_error = 0.0, [], 0.0, 0.0
    for what, mu, own, actual, radius in (("real modes", 0.0, undamped, real_modes, band),
                                          ("complex modes", friction_coefficient, matrices, complex_modes, 1.01**0.5 * band)):
        solution = oracle.Oracle(own, mu, band / (2 * math.pi)).solve(radius)
        worst = max(worst, compare(what, actual, solution.values, band, radius))
        methods.append(solution.method)
        own_error, dense_error = max(own_error, solution.error), max(dense_error, solution.first_error)
    row.oracle = " / ".join(methods)
    row.deviation = f"{worst:.0e}"
    record = json.loads((run / "run.json").read_text(encoding="utf-8"))
    digits = record["quantities"]["digits of the eigenvalues [-]"]
    row.digits = f"{digits:.0f}"
    has_warned = any("digits" in warning for warning in record["warnings"])
    if residual > LARGEST_RESIDUAL and not has_warned:
        raise Wrong(f"residual {residual:.1e} without a warning")
    if worst > max(10.0 ** (1 - digits), PRINTED):
        raise Wrong(f"eigenvalues differ by {worst:.1e}, but the run reports {digits:.1f} digits")
    if worst > TOLERANCE:
        raise Wrong(f"eigenvalues differ by {worst:.1e} (oracle's own error {own_error:.0e})")
    row.outcome = "right"
    if case.unit:
        compare_units(case, folder, row)
    if own_error > TOLERANCE / 10:
        row.outcome, row.remark = "not judged", f"the oracle's own error is {own_error:.0e}"
    elif dense_error > TOLERANCE:
        row.remark = f"the oracle before refinement is off by {dense_error:.0e}"
    if has_warned:
        row.remark += ("; " if row.remark else "") + "warning of lost digits"


def compare_units(case, folder, row):
    """Compares the tables of a model with the tables of the same model in metres."""
    process = call("scene.prm", "--output", "metres", *words_of(case.unit), folder=folder)
    if process.returncode != 0:
        raise Wrong(f"refused in metres: {process.stderr}")
    largest = max(difference(Table(folder / "metres" / name).rows, Table(folder / "run" / name).rows, case.scale)
                  for name in ("complex_modes.csv", "real_modes.csv", "component_modes.csv"))
    if largest > SAME_IN_ALL_UNITS:
        raise Wrong(f"differs by {largest:.1e} from the model in metres")
    row.remark = f"{largest:.0e} from the model in metres"


def difference(rows, others, scale):
    """Largest difference between tables of modes of a model (`rows`) and of the model with lengths times `scale`
    (`others`): frequencies and growth rates relative to the frequency, dimensionless numbers absolute; infinite if texts
    or numbers of rows differ."""
    largest = 0.0 if len(rows) == len(others) else math.inf
    for row, other in zip(rows, others):
        for column, cell in row.items():
            try:
                one, two = float(cell), float(other[column])
            except ValueError:
                largest = max(largest, 0.0 if cell == other[column] else math.inf)
                continue
            if column in ("frequency [Hz]", "growth rate [1/s]"):
                largest = max(largest, abs(one - scale * two) / (float(row["frequency [Hz]"]) or 1.0))
            else:
                largest = max(largest, abs(one - two) / (100 if "[%]" in column else 1))
    return largest


def compare(what, actual, expected, band, radius):
    """Largest relative difference of eigenvalues. Raises Wrong if the numbers of oscillating or real eigenvalues differ."""
    def certain(values):
        return [value for value in values
                if abs(value) > ZERO * band and abs(abs(value) - radius) > EDGE * radius and abs(value.imag - band) > EDGE * band]

    inside = [value for value in expected if value.imag <= band * (1 + EDGE) and abs(value) <= radius * (1 + EDGE)]
    inside = [complex(value.real, 0) if value.imag <= 1e-7 * abs(value) else value for value in inside]
    actual, inside = certain(actual), certain(inside)
    for kind, of_kind in (("oscillating", lambda value: value.imag > 0), ("real", lambda value: value.imag == 0)):
        n_actual, n_inside = sum(map(of_kind, actual)), sum(map(of_kind, inside))
        if n_actual != n_inside:
            raise Wrong(f"{what}: {n_actual} {kind} eigenvalues in the tables, {n_inside} in the oracle")
    return quadratic.match(actual, inside)[2].max(initial=0.0)


def argument_count(case, folder, modes, band):
    """Counts complex modes by the argument principle in a sweep with one friction coefficient. Relative to the end of the
    band, |Re lambda| is at most 0.1 and Im lambda is 0.001 to 1. Returns the text for the column `count`; raises Wrong if
    the count differs from the modes."""
    parameters = parameter_file.read_parameters(folder / "run" / "parameters.prm")
    mu = parameters["Operation/Friction coefficient"]
    settings = [*case.settings, "Study=sweep", f"Sweep/First friction coefficient={mu}", f"Sweep/Last friction coefficient={mu}",
                "Sweep/Number of friction coefficients=1", f"Sweep/Count modes at={mu}", "Sweep/Compare dissipation=false"]
    process = call("scene.prm", "--output", "count", *words_of(settings), folder=folder)
    if process.returncode != 0:
        return f", argument rejected ({process.stderr.strip().splitlines()[0][7:]})"
    check_numbers(folder / "count")
    counted = int(Table(folder / "count" / "argument_counts.csv").rows[0]["modes counted [-]"])
    n_inside = sum(abs(mode.real) <= 0.1 * band and 1e-3 * band <= mode.imag <= band for mode in modes)
    n_on_edge = sum(abs(mode.imag - band) <= EDGE * band for mode in modes)
    if not n_inside - n_on_edge <= counted <= n_inside:
        raise Wrong(f"argument principle: {counted} modes counted, {n_inside} in the table")
    return f", argument {counted}"
