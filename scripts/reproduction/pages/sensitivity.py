# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/sensitivity.md"""

from reproduction.numbers import Number, entry, of_mode, table

# In the order of the table in the page
PARAMETERS = ("Geometry/Disc outer radius", "Geometry/Pin height", "Geometry/Disc thickness", "Pin material/Density", "Disc material/Density",
              "Disc material/Young modulus", "Pin material/Young modulus", "Operation/Friction coefficient", "Pin material/Poisson ratio",
              "Geometry/Disc inner radius", "Disc material/Poisson ratio", "Geometry/Pin diameter")


@entry("sensitivity", "Effect of a 1 % increase in each parameter on the fastest growing mode")
def leading_mode(runs):
    rows = [row for row in runs("sensitivity", "studies/sensitivity.prm").rows("sensitivities")
            if row["mode [-]"] == 1 and not row["body"]]
    yield from of_mode("the mode", rows[0], "3569", "1.068")
    for parameter, (_, rate, frequency) in zip(PARAMETERS, table("sensitivity", "parameter increased by 1 %")):
        row = next(row for row in rows if row["parameter"] == parameter)
        yield Number(f"{parameter}, divergence rate [percentage points]", rate, row["divergence rate per 1 % [percentage points]"])
        yield Number("  frequency [Hz]", frequency, row["frequency per 1 % [Hz]"])


@entry("sensitivity", "Changes of thresholds")
def thresholds(runs):
    rows = runs("sensitivity", "studies/sensitivity.prm").rows("sensitivities_thresholds")
    yield Number("without derivatives", "1", sum(row["derivative of"] == "none" for row in rows))
    for label, mu, parameter, change in (("A0-5 +", "0.0893", "Disc material/Density", "0.0094"),
                                         ("A0-4 +", "0.0883", "Disc material/Density", "-0.0001"),
                                         ("A0-4 +", "0.0883", "Disc material/Young modulus", "0.0036")):
        row = next(row for row in rows if row["label"] == label and row["parameter"] == parameter and not row["body"])
        yield Number(f"{label}, mu_c", mu, row["mu [-]"])
        yield Number(f"  one per cent of {parameter}", change, row["mu per 1 % [-]"])
