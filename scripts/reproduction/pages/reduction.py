# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/reduction.md, except times"""

from reproduction.numbers import Number, entry, several, table

STUDIES = {"without": ("friction", "studies/friction.prm"), "with": ("friction_damped", "studies/friction_damped.prm")}


def study(runs, dissipation, name):
    return runs(*STUDIES[dissipation]).rows(f"reduction_{name}")


def largest(rows, basis, column, group=None):
    """Largest value in a column for a basis, in one group of modes or in all groups."""
    return max(row[column] for row in rows if row["basis"] == basis and group in (None, row["group"]))


NAMES = {"the same + damping": "real + 1st-ord. two-sided + damping", "POD of μ = 0.05, 0.25, 0.45": "POD", "residual-grown, 10⁻⁴": "residual-grown 0.0001",
         "residual-grown, 10⁻⁶": "residual-grown 1e-06"}


def compared(runs, head, columns, group=None):
    """Errors of bases, compared with a table of the page. A cell contains two numbers, without and with dissipation, if
    they differ. In `columns`, None skips a column."""
    for number, dissipation in enumerate(STUDIES):
        rows = study(runs, dissipation, "errors")
        for basis, *cells in table("reduction", head):
            quoted = {column: cell.split(r" \| ")[-number] for column, cell in zip(columns, cells) if column}
            if "–" not in quoted.values():
                found = [largest(rows, NAMES.get(basis, basis), column, group) for column in quoted]
                yield from several(f"{dissipation}: {basis}, ", quoted, quoted.values(), found)


@entry("reduction", "Overview: sizes and largest errors of all modes, without and with radial dissipation")
def at_one_glance(runs):
    yield from compared(runs, "error of λ", ("n_r [-]", None, "lambda [-]", "div [-]"))


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
    yield from compared(runs, "ε_res | ε_frq", ("res [-]", "frq [-]", "div [-]"), "disc and unstable pins")


@entry("reduction", "Wrong verdicts")
def wrong_verdicts(runs):
    for dissipation, quoted_wrong, quoted_modes in (("without", "2", "1188"), ("with", "0", "1320")):
        rows = study(runs, dissipation, "estimates")
        yield Number(f"{dissipation}: wrong verdicts", quoted_wrong, sum(row["wrong verdicts [-]"] for row in rows))
        yield Number(f"{dissipation}: number of modes", quoted_modes, sum(row["modes [-]"] for row in rows))


@entry("reduction", "Counterparts by eq. (17) that differ from the one-to-one pairing")
def counterparts(runs):
    for dissipation, all_pairs, clustered in (("without", "147", "123"), ("with", "56", "48")):
        differing = [row for row in study(runs, dissipation, "modes") if row["reduced mode [-]"] != row["reduced mode by eq. 17 [-]"]]
        yield Number(f"{dissipation}: other counterparts", all_pairs, len(differing))
        yield Number(f"{dissipation}: other counterparts in clusters", clustered, sum(row["cluster [-]"] > 1 for row in differing))


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
