# SPDX-License-Identifier: GPL-3.0-or-later

"""README.md"""

from reproduction.numbers import Number, entry, of_mode


@entry("README", "The last lines of the default run")
def default_run(runs):
    results = runs.default()
    yield Number("modes", "66", len(results.complex_modes()))
    yield Number("unstable modes", "9", results.n_unstable())
    yield Number("  below 0.01 %", "4", sum(mode["unstable [-]"] == 1 and mode["divergence rate [%]"] < 0.01 for mode in results.complex_modes()))
    for label, frequency, rate in (("F1", "3569.1", "1.0677"), ("A0-4", "2353.0", "0.6798")):
        yield from of_mode(label, results.leading(label), frequency, rate)
