# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/dissipation.md"""

import paper
from reproduction.numbers import Number, entry

NO_SHAPES = "Output/Mode shapes=none"
READINGS = ("equal load consistent [%]", "equal load published [%]", "steady sliding consistent [%]", "steady sliding published [%]")


def rates_with_all_readings(runs):
    return list(paper.readings({reading: runs(*how) for reading, how in paper.READINGS.items()}))


def ends(rows, label, column):
    """The smallest and largest divergence rate [%] of the modes of a label."""
    values = [row[column] for row in rows if row["label"].startswith(label) and row[column] is not None]
    return min(values), max(values)


def of_modes(results, label):
    rates = sorted(mode["divergence rate [%]"] for mode in results.complex_modes(label))
    return rates


@entry("dissipation", "The table of divergence rates with each reading")
def table(runs):
    rows = rates_with_all_readings(runs)
    quoted = {"F1": (("-2.07", "-5.15", "-1.41", "-3.35"), ("0.947", "0.919", "0.970", "0.934")),
              "T1": (("-1.36", "-3.39", "-1.80", "-4.53"), ("-1.03", "-2.57", "-1.36", "-3.40")),
              "A0-4": (("-0.686", "-0.695", "-0.686", "-0.695"), ("0.674", "0.664", "0.674", "0.665")),
              "A0-5": (("-0.981", "-1.088", "-0.939", "-1.049"), ("0.822", "0.871", "0.819", "0.839"))}
    for label, numbers in quoted.items():
        for place, column in enumerate(READINGS):
            for end, value, text in zip(("smallest", "largest"), ends(rows, label, column), (row[place] for row in numbers)):
                yield Number(f"{label}, {column}, {end}", text, value)
    for place, column in enumerate(READINGS):
        # Half of the 24 F1 modes bends along the radius.
        rates = sorted(row[column] for row in rows if row["label"].startswith("F1"))
        yield Number(f"F1, {column}, least damped of the radial half", ("-1.43", "-3.70", "-0.89", "-2.31")[place], rates[11])
        yield Number(f"R0-1 +, {column}", ("-0.110", "-0.275", "-0.110", "-0.275")[place], ends(rows, "R0-1 +", column)[0])
        yield Number(f"A1-2 +, {column}", ("-0.109", "-0.213", "-0.123", "-0.255")[place], ends(rows, "A1-2 +", column)[0])


@entry("dissipation", "3. What remains is the mesh of the faces: 7, 19 and 37 nodes")
def meshes(runs):
    for nodes, most, least in ((7, "-2.96", "-2.22"), (19, "-1.80", "-1.36"), (37, "-1.60", "-1.21")):
        results = runs(f"sliding_{nodes}", "sliding.prm", NO_SHAPES, f"Geometry/Nodes per pin face={nodes}")
        rates = of_modes(results, "T1")
        yield Number(f"T1, {nodes} nodes, most damped [%]", most, rates[0])
        yield Number(f"T1, {nodes} nodes, least damped [%]", least, rates[-1])
        yield Number(f"F1, {nodes} nodes, most damped [%]", "-1.4", of_modes(results, "F1")[0])


@entry("dissipation", "At mu = 0.01 the F1 modes decay with up to 5.16 % without mu in c_b, with it up to 0.05 %")
def small_friction(runs):
    for reading, quoted in (("published", "-5.16"), ("consistent", "-0.05")):
        results = runs(f"sliding_{reading}_at_0.01", "sliding.prm", NO_SHAPES, "Operation/Friction coefficient=0.01",
                       f"Operation/Radial dissipation={reading}")
        yield Number(f"most damped F1, {reading} [%]", quoted, of_modes(results, "F1")[0])


@entry("dissipation", "Seven F1 modes that hardly grow without it grow by 0.01 to 0.04 %; the leading pairs lose at most 0.15 %")
def destabilised(runs):
    rows = rates_with_all_readings(runs)

    def rates(column):
        return sorted(row[column] for row in rows if row["label"].startswith("F1"))

    yield Number("F1 modes that grow by more than 0.001 % without it", "3", sum(rate > 0.001 for rate in rates("no C_b [%]")))
    for column, least, most in (("equal load consistent [%]", "0.01", "0.02"), ("steady sliding consistent [%]", "0.02", "0.04")):
        further = [rate for rate in rates(column) if rate > 0.001][:-3]
        yield Number(f"further ones that grow, {column}", "7", len(further))
        yield Number("  least [%]", least, further[0])
        yield Number("  most [%]", most, further[-1])
    losses = [max(row["no C_b [%]"] for row in rows if row["label"].startswith(label)) - ends(rows, label, column)[1]
              for label in ("A0-4", "A0-5", "F1") for column in READINGS]
    yield Number("largest loss of a leading pair [%]", "0.15", max(losses), bound=True)
