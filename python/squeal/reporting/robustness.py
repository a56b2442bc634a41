# SPDX-License-Identifier: GPL-3.0-or-later

"""The page of a study of uncertain parameters: how probable squeal is. Plots: modes of all samples and influential parameters."""

from squeal.reporting.charts import digits, number

TITLES = {"probabilities": "Probability of squeal by bands of frequencies", "mode_distributions": "Modes over all samples",
          "onset_distributions": "Where modes begin to grow", "sobol_indices": "Influence of the parameters: Sobol' indices"}
REPLACED = ()


def is_of(results):
    return results.has("probabilities")


def verdict(results):
    row = results.table("probabilities").rows[0]
    value, lower, upper = (row[f"{name} [%]"] for name in ("probability of squeal", "lower confidence limit", "upper confidence limit"))
    samples = results.record["counts"]["independent samples"]
    undecided = number(row["undecided samples [%]"])
    level = "unstable" if number(value) > 0. else "none" if undecided > 0. else "stable"
    return level, (f"Squeal in {digits(number(value), 3)} % of {samples} samples (95 % confidence interval {digits(number(lower), 3)} to "
                   f"{digits(number(upper), 3)} %); {digits(undecided, 3)} % are undecided.")


def sections(_results):
    return []


def checks(results):
    counts = results.record["counts"]
    return [("samples, those for Sobol' indices included", str(counts["samples"])), ("basis vectors", str(counts["basis vectors"]))]
