# SPDX-License-Identifier: GPL-3.0-or-later

"""Page of a study of uncertain parameters: the probability of squeal."""

from squeal.reporting.charts import confidence, digits, number

TABLES = ("probabilities",)
TITLES = {"probabilities": "Probability of squeal by frequency band", "mode_distributions": "Modes over all samples",
          "onset_distributions": "Onsets of modes", "sobol_indices": "Influence of the parameters: Sobol' indices"}


def verdict(results):
    row = results.table("probabilities").rows[0]
    value, undecided = number(row["probability of squeal [%]"]), number(row["undecided samples [%]"])
    level = "unstable" if value > 0. else "none" if undecided > 0. else "stable"
    return level, (f"Squeal in {digits(value, 3)} % of {results.record['counts']['independent samples']} samples ({confidence(row)}); "
                   f"{digits(undecided, 3)} % are undecided.")


def checks(results):
    counts = results.record["counts"]
    return [("samples, including those for Sobol' indices", str(counts["samples"])), ("basis vectors", str(counts["basis vectors"]))]
