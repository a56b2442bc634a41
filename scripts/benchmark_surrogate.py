#!/usr/bin/python3
# SPDX-License-Identifier: GPL-3.0-or-later

"""Compares one reduced model for all samples with polynomial chaos and Kriging surrogates.

    scripts/benchmark_surrogate.py [--fresh 500] [--core 0]

The study of prm/robustness.prm, without Sobol' indices, computes all modes of the samples to a tolerance of 1e-6. These
modes are taken as exact; the first samples are used for training, the last samples for testing. OpenTURNS builds
surrogates of Re lambda and Im lambda of every mode whose name is unique in all training samples: sparse polynomial
chaos (least angle regression, hyperbolic truncation, degree 6) and Kriging (linear trend, Matern 5/2). Errors of lambda
are evaluated for test samples in which the name is also unique. A sample squeals if a divergence rate exceeds 0.01 %.

Times are CPU seconds on one core. The time of a full-order solution is taken from a stability run with the Krylov
solver, from the mode count to the complex modes, without assembly. Requires Debian's python3-openturns.
"""

import os
import pathlib
import tempfile
import time

import benchmarking

os.environ.update(benchmarking.environment())  # before NumPy loads OpenBLAS, which reads these variables

import numpy as np

from squeal import quadratic
from squeal.command_line import Parser, exit_on_error
from squeal.program import SOURCE
from squeal.results import Results

SIZES = (50, 200)  # numbers of training samples, each of which would require a full-order solution
LEAST_RATE = 1e-4  # divergence rate above which a sample squeals


def read_samples(results):
    """Values of the uncertain numbers (n x d), and for each sample a dictionary name -> list of eigenvalues."""
    samples, modes = results.table("samples"), results.table("sample_modes")
    names = samples.columns[1:samples.columns.index("unstable modes [-]")]
    numbers = np.array([samples.numbers(name) for name in names]).T
    by_sample = [{} for _ in numbers]
    for sample, label, value in zip(modes.numbers("sample [-]"), modes.texts("label"), modes.eigenvalues()):
        by_sample[int(sample) - 1].setdefault(label, []).append(value)
    return numbers, by_sample


def chaos(ot, inputs, outputs, distribution):
    """Sparse polynomial chaos, selected by the corrected leave-one-out error."""
    dimension = inputs.getDimension()
    enumeration = ot.HyperbolicAnisotropicEnumerateFunction(dimension, 0.6)
    basis = ot.OrthogonalProductPolynomialFactory([distribution.getMarginal(i) for i in range(dimension)], enumeration)
    n_terms = enumeration.getStrataCumulatedCardinal(6)
    selection = ot.LeastSquaresMetaModelSelectionFactory(ot.LARS(), ot.CorrectedLeaveOneOut())
    algorithm = ot.FunctionalChaosAlgorithm(inputs, outputs, distribution, ot.FixedStrategy(basis, n_terms), ot.LeastSquaresStrategy(selection))
    algorithm.run()
    return algorithm.getResult().getMetaModel()


def kriging(ot, inputs, outputs, _distribution):
    """A Gaussian process for each output."""
    models = []
    for j in range(outputs.getDimension()):
        covariance = ot.MaternModel([1.0] * inputs.getDimension(), 2.5)
        algorithm = ot.KrigingAlgorithm(inputs, outputs.getMarginal(j), covariance, ot.LinearBasisFactory(inputs.getDimension()).build())
        algorithm.run()
        models.append(algorithm.getResult().getMetaModel())
    return lambda x: np.hstack([np.array(model(x)) for model in models])


def trained(ot, make, numbers, by_sample, n_train):
    """Name -> eigenvalues of all samples, computed by one surrogate per name, and the CPU seconds of training."""
    lower, upper = numbers.min(axis=0), numbers.max(axis=0)
    scaled = 2 * (numbers - lower) / (upper - lower) - 1
    distribution = ot.ComposedDistribution([ot.Uniform(-1, 1)] * numbers.shape[1])
    labels = [label for label in by_sample[0] if all(len(modes.get(label, [])) == 1 for modes in by_sample[:n_train])]
    start, result = time.process_time(), {}
    for label in labels:
        values = np.array([modes[label][0] for modes in by_sample[:n_train]])
        scale = np.array([max(np.abs(values.real).max(), 1e-9), values.imag.std() or 1.0])
        middle = values.imag.mean()
        outputs = np.column_stack([values.real / scale[0], (values.imag - middle) / scale[1]])
        found = np.tile(outputs.mean(axis=0), (len(scaled), 1))
        varied = np.flatnonzero(outputs.std(axis=0) > 0.)  # growth rates of neutral modes are constant
        if varied.size:
            model = make(ot, ot.Sample(scaled[:n_train]), ot.Sample(outputs[:, varied]), distribution)
            found[:, varied] = np.array(model(ot.Sample(scaled)))
        result[label] = found[:, 0] * scale[0] + 1j * (found[:, 1] * scale[1] + middle)
    return result, time.process_time() - start


def squeals(modes):
    """True if a divergence rate exceeds LEAST_RATE; `modes` consists of lists of eigenvalues."""
    return any(value.real / abs(value.imag) > LEAST_RATE for values in modes for value in values)


def wrong_verdicts(exact, found):
    """Percentage of samples that squeal in only one of the two models."""
    return 100 * np.mean([squeals(modes.values()) != squeals(others) for modes, others in zip(exact, found)])


def row_of(pairs):
    """Median, 95 % quantile and maximum of the relative errors of pairs of exact and approximate eigenvalues."""
    exact, found = np.array(pairs).T
    errors = abs(found - exact) / abs(exact)
    return f"{np.median(errors):.1e} | {np.quantile(errors, 0.95):.1e} | {errors.max():.1e}"


@exit_on_error()
def main():
    parser = Parser(__doc__)
    parser.add_argument("--fresh", type=int, default=500, help="number of test samples (default: %(default)s)")
    parser.add_argument("--core", type=int, default=0, help="the core to run on (default: %(default)s)")
    arguments = parser.parse_args()
    import openturns as ot
    ot.Log.Show(ot.Log.NONE)
    print(benchmarking.describe_machine(arguments.core), flush=True)

    def run(name, *settings):
        file = SOURCE / "prm" / "robustness.prm"
        return benchmarking.run_squeal([arguments.core], file, directory / name, settings), Results(directory / name)

    with tempfile.TemporaryDirectory() as name:
        directory = pathlib.Path(name)
        full, _ = run("full", "Study=stability", "Complex modes/Solver=Krylov", "Output/Mode shapes=none")
        solution = benchmarking.cpu_seconds(full, benchmarking.FULL_ORDER)
        print(f"steps of a full-order run: {', '.join(step['name'] for step in full['steps'])}; solution: {solution:.1f} s")
        sampling = (f"Robustness/Number of samples={max(SIZES) + arguments.fresh}", "Robustness/Sobol indices=false",
                    "Robustness/Worst samples=0")
        numbers, by_sample = read_samples(run("exact", "Robustness/Tolerance=1e-6", *sampling)[1])
        record, results = run("reduced", *sampling)
        _, reduced = read_samples(results)
    seconds = benchmarking.cpu_seconds(record)
    print(f"full-order solutions of all {len(numbers)} samples: {solution * len(numbers):.0f} s\n")

    fresh = slice(max(SIZES), None)
    n_names = len({label for modes in by_sample for label in modes})
    print("| surrogate | full-order solutions | training [s] | modes of | relative error of lambda: median | 95 % | largest | wrong verdicts [%] |")
    print("|---|---|---|---|---|---|---|---|")
    # Pair modes by distance, because names of mixed modes may differ between two bases
    pairs = []
    for exact, found in list(zip(by_sample, reduced))[fresh]:
        exact, found = (np.array(sum(modes.values(), [])) for modes in (exact, found))
        rows, columns, _ = quadratic.match(exact, found)
        pairs.extend(zip(exact[rows], found[columns]))
    print(f"| one reduced model, {record['counts']['basis vectors']} vectors | 0; all samples: {seconds:.0f} s | 0 | {n_names} of {n_names} names "
          f"| {row_of(pairs)} | {wrong_verdicts(by_sample[fresh], (modes.values() for modes in reduced[fresh])):.1f} |", flush=True)
    for name, make in (("polynomial chaos", chaos), ("Kriging", kriging)):
        for n_train in SIZES:
            found, seconds = trained(ot, make, numbers, by_sample, n_train)
            pairs = [(modes[label][0], found[label][i]) for i, modes in list(enumerate(by_sample))[fresh] for label in found
                     if len(modes.get(label, [])) == 1]
            tests = range(max(SIZES), len(numbers))
            wrong = wrong_verdicts(by_sample[fresh], ([[values[i]] for values in found.values()] for i in tests))
            print(f"| {name} | {n_train}: {solution * n_train:.0f} s | {seconds:.0f} | {len(found)} of {n_names} names "
                  f"| {row_of(pairs)} | {wrong:.1f} |", flush=True)


if __name__ == "__main__":
    main()
