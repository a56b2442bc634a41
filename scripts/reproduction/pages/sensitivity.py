# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/sensitivity.md"""

from reproduction.numbers import Number, entry, of_mode

# What one per cent changes of the divergence rate [percentage points] and of the frequency [Hz] of F1 at 3569 Hz
QUOTED = {"Geometry/Disc outer radius": ("-0.1276", "-19.8"),
          "Geometry/Pin height": ("0.0654", "-28.8"),
          "Geometry/Disc thickness": ("0.0301", "7.6"),
          "Pin material/Density": ("0.0281", "-12.6"),
          "Disc material/Density": ("-0.0281", "-5.3"),
          "Disc material/Young modulus": ("0.0232", "5.0"),
          "Pin material/Young modulus": ("-0.0230", "12.9"),
          "Operation/Friction coefficient": ("0.0084", "-0.05"),
          "Pin material/Poisson ratio": ("0.0051", "-1.7"),
          "Geometry/Disc inner radius": ("-0.0032", "-0.6"),
          "Disc material/Poisson ratio": ("-0.0026", "-0.4"),
          "Geometry/Pin diameter": ("0.0003", "4.3")}


@entry("sensitivity", "What one per cent of each parameter changes of the mode that grows most")
def leading_mode(runs):
    rows = [row for row in runs("sensitivity", "studies/sensitivity.prm").rows("sensitivities")
            if row["mode [-]"] == 1 and not row["body"]]
    yield from of_mode("the mode", rows[0], "3569", "1.068")
    for parameter, (rate, frequency) in QUOTED.items():
        row = next(row for row in rows if row["parameter"] == parameter)
        yield Number(f"{parameter}, divergence rate [percentage points]", rate, row["divergence rate per 1 % [percentage points]"])
        yield Number("  frequency [Hz]", frequency, row["frequency per 1 % [Hz]"])


@entry("sensitivity", "How far thresholds move")
def thresholds(runs):
    rows = runs("sensitivity", "studies/sensitivity.prm").rows("sensitivities_thresholds")
    yield Number("without derivatives", "1", sum(row["derivative of"] == "none" for row in rows))
    for label, mu, parameter, change in (("A0-5 +", "0.0893", "Disc material/Density", "0.0094"),
                                         ("A0-4 +", "0.0883", "Disc material/Density", "-0.0001"),
                                         ("A0-4 +", "0.0883", "Disc material/Young modulus", "0.0036")):
        row = next(row for row in rows if row["label"] == label and row["parameter"] == parameter and not row["body"])
        yield Number(f"{label}, mu_c", mu, row["mu [-]"])
        yield Number(f"  one per cent of {parameter}", change, row["mu per 1 % [-]"])
