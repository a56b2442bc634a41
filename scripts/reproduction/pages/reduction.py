# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/reduction.md, but for times"""

from reproduction.numbers import Number, entry, several

STUDIES = {"without": ("friction", "studies/friction.prm"), "with": ("friction_damped", "studies/friction_damped.prm")}


def study(runs, dissipation, table):
    return runs(*STUDIES[dissipation]).rows(f"reduction_{table}")


def largest(rows, basis, column, group=None):
    """Of a basis, in one group of modes or in all."""
    return max(row[column] for row in rows if row["basis"] == basis and group in (None, row["group"]))


@entry("reduction", "At one glance: sizes and largest errors of all modes, without and with radial dissipation")
def at_one_glance(runs):
    quoted = {"without": (("free", "200", "1.2e-2", "2.0e-3"), ("fixed", "368", "7.4e-2", "1.7e-2"), ("mixed", "368", "5.9e-3", "3.0e-3"),
                          ("free + t.a.m.", "428", "1.2e-3", "3.8e-4"), ("free with r.a.m.", "200", "1.6e-3", "9.2e-4"),
                          ("fixed + t.a.m.", "596", "1.8e-2", "1.8e-2"), ("mixed + t.a.m.", "596", "1.2e-3", "9.4e-4"),
                          ("real", "66", "6.7e-3", "3.3e-3"), ("real + t.a.m.", "294", "2.2e-3", "1.2e-3"),
                          ("real + 1st-ord.", "132", "1.9e-3", "1.2e-3"), ("real + 1st-ord. two-sided", "198", "8.2e-5", "6.7e-5"),
                          ("real (10000 Hz)", "113", "6.8e-3", "3.3e-3"), ("real + 1st-ord. (10000 Hz)", "226", "1.6e-3", "1.2e-3"),
                          ("POD", "114", "1.7e-5", "3.8e-6"), ("residual-grown 0.0001", "198", "8.2e-5", "6.7e-5"),
                          ("residual-grown 1e-06", "235", "1.0e-6", "7.8e-7")),
              "with": (("free", "200", "1.4e-2", "4.9e-3"), ("fixed", "368", "3.3e-2", "1.7e-2"), ("mixed", "368", "9.3e-3", "2.1e-3"),
                       ("free + t.a.m.", "428", "3.1e-4", "1.8e-4"), ("free with r.a.m.", "200", "3.9e-4", "3.0e-4"),
                       ("fixed + t.a.m.", "596", "7.3e-2", "1.8e-2"), ("mixed + t.a.m.", "596", "1.3e-3", "9.7e-4"),
                       ("real", "66", "6.9e-3", "2.7e-3"), ("real + t.a.m.", "294", "1.0e-3", "8.0e-4"),
                       ("real + 1st-ord.", "132", "9.8e-4", "7.5e-4"), ("real + 1st-ord. two-sided", "198", "4.5e-4", "9.9e-5"),
                       ("real + 1st-ord. two-sided + damping", "264", "5.9e-5", "8.9e-6"),
                       ("POD", "151", "2.4e-5", "2.3e-5"), ("residual-grown 0.0001", "263", "5.8e-5", "9.4e-6"),
                       ("residual-grown 1e-06", "330", "7.3e-7", "5.1e-7"))}
    for dissipation, bases in quoted.items():
        rows = study(runs, dissipation, "errors")
        for basis, *texts in bases:
            columns = ("n_r [-]", "lambda [-]", "div [-]")
            yield from several(f"{dissipation}: {basis}, ", columns, texts, [largest(rows, basis, column) for column in columns])


@entry("reduction", "Groups: share of the disc in A0-5, and errors of disc modes")
def groups(runs):
    modes = [row for row in study(runs, "without", "modes") if row["basis"] == "real" and row["label"].startswith("A0-5")]
    for mode in modes:
        yield Number(f"{mode['label']}, share of the disc [%]", "29", 100 * mode["disc share [-]"])
    rows = study(runs, "without", "errors")
    yield Number("real + 1st-ord., eps_div of disc modes", "9.2e-6", largest(rows, "real + 1st-ord.", "div [-]", "disc"))
    yield Number("mixed, eps_div of disc modes", "6.0e-5", largest(rows, "mixed", "div [-]", "disc"))
    yield Number("mixed + t.a.m., eps_div of disc modes", "3.6e-4", largest(rows, "mixed + t.a.m.", "div [-]", "disc"))


@entry("reduction", "Largest errors over disc and unstable pins")
def disc_and_unstable_pins(runs):
    quoted = {"without": (("free", "2.4e-2", "2.0e-3"), ("fixed", "2.3e-2", "1.7e-2"), ("mixed", "2.8e-2", "2.8e-3"),
                          ("free + t.a.m.", "3.4e-5", "3.8e-4"), ("free with r.a.m.", "6.2e-5", "5.9e-4"),
                          ("fixed + t.a.m.", "3.5e-3", "1.8e-2"), ("mixed + t.a.m.", "6.4e-4", "9.4e-4"), ("real", "2.7e-2", "2.3e-3"),
                          ("real + t.a.m.", "8.8e-5", "1.2e-3"), ("real + 1st-ord.", "3.9e-4", "1.2e-3"),
                          ("real (10000 Hz)", "2.6e-2", "2.3e-3"), ("real + t.a.m. (10000 Hz)", "1.9e-5", "1.2e-3")),
              "with": (("free", "2.4e-2", "2.3e-3"), ("mixed", "2.8e-2", "6.1e-4"), ("free + t.a.m.", "8.3e-5", "7.7e-5"),
                       ("free with r.a.m.", "1.2e-4", "1.4e-4"), ("mixed + t.a.m.", "6.4e-4", "9.7e-4"), ("real", "2.7e-2", "1.1e-3"),
                       ("real + t.a.m.", "1.5e-4", "1.2e-4"), ("real + 1st-ord.", "9.2e-4", "1.3e-4"))}
    for dissipation, bases in quoted.items():
        rows = study(runs, dissipation, "errors")
        for basis, *texts in bases:
            columns = ("res [-]", "div [-]")
            yield from several(f"{dissipation}: {basis}, ", columns, texts, [largest(rows, basis, column, "disc and unstable pins") for column in columns])


@entry("reduction", "Wrong verdicts")
def wrong_verdicts(runs):
    for dissipation, quoted_wrong, quoted_modes in (("without", "2", "1188"), ("with", "0", "1320")):
        rows = study(runs, dissipation, "estimates")
        yield Number(f"{dissipation}: wrong verdicts", quoted_wrong, sum(row["wrong verdicts [-]"] for row in rows))
        yield Number(f"{dissipation}: of so many", quoted_modes, sum(row["modes [-]"] for row in rows))


@entry("reduction", "Counterparts by eq. (17) that differ from one to one")
def counterparts(runs):
    for dissipation, all_pairs, clustered in (("without", "147", "123"), ("with", "56", "48")):
        differing = [row for row in study(runs, dissipation, "modes") if row["reduced mode [-]"] != row["reduced mode by eq. 17 [-]"]]
        yield Number(f"{dissipation}: other counterparts", all_pairs, len(differing))
        yield Number(f"{dissipation}: of modes of clusters", clustered, sum(row["cluster [-]"] > 1 for row in differing))


@entry("reduction", "Section 5: free, fixed and mixed bases by numbers and by frequencies of component modes")
def section_five(runs):
    quoted = {("frictionless", "studies/frictionless.prm"): (
                  ("free", "disc", ("4.3e-4", "3.8e-6", "1.8e-6")), ("free", "F1", ("1.4e-3", "2.7e-5", "1.2e-5")),
                  ("fixed", "disc", ("1.8e-2", "2.9e-3", "2.2e-3"))),
              ("frictionless_frequency", "studies/frictionless_frequency.prm"): (
                  ("free", "disc", ("4.3e-4", "4.5e-6", "1.9e-6")), ("free", "F1", ("1.4e-3", "4.1e-5", "1.4e-5")),
                  ("fixed", "disc", ("1.8e-2", "1.4e-2", "9.8e-3")))}
    for run, bases in quoted.items():
        rows = runs(*run).rows("reduction_errors")
        for basis, group, numbers in bases:
            found = [row for row in rows if row["basis"] == basis and row["group"] == group]
            for row, number in zip(found, numbers, strict=True):
                yield Number(f"{basis}, {row['component modes']}: eps_frq of {group}", number, row["frq [-]"])
