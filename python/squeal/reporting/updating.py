# SPDX-License-Identifier: GPL-3.0-or-later

"""Page of a fit to measured modes."""

from squeal.reporting.charts import digits, number

TABLES = ("updated_parameters",)
TITLES = {"updated_parameters": "Fitted parameters", "fit": "Measured numbers before and after the fit",
          "parameter_correlations": "Correlations of fitted parameters"}


def verdict(results):
    counts, quantities = results.record["counts"], results.record["quantities"]
    before, after = (digits(quantities[f"rms difference of frequencies {when} [%]"], 3) for when in ("at the start", "after the fit"))
    rows = results.table("updated_parameters").rows
    open_ones = [row["parameter"] for row in rows if row["status"] != "determined"]
    remark = f" Not determined or at a limit: {', '.join(open_ones)}." if open_ones else ""
    n = counts['fitted parameters']
    return "none", (f"{n} parameter{'s' if n > 1 else ''} fitted to {counts['measured numbers']} measured numbers: frequencies differ by "
                    f"{after} % rms ({before} % before).{remark}")


def checks(results):
    largest = results.record["quantities"]["largest difference of frequencies after the fit [%]"]
    return [("largest difference of a fitted frequency", f"{digits(number(largest), 3)} %"),
            ("evaluations of the model", str(results.record["counts"]["evaluations"]))]
