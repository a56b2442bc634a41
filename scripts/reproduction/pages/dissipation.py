# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/dissipation.md"""

import paper
from reproduction.numbers import Number, entry, numbers_in, table

NO_SHAPES = "Output/Mode shapes=none"
READINGS = ("equal load consistent [%]", "equal load published [%]", "steady sliding consistent [%]", "steady sliding published [%]")


def rates_with_all_readings(runs):
    return list(paper.readings({reading: runs(*how) for reading, how in paper.READINGS.items()}))


def rates_of(rows, label, column):
    """Divergence rates [%] of the modes of a label, ascending."""
    return sorted(row[column] for row in rows if row["label"].startswith(label) and row[column] is not None)


def of_modes(results, label):
    return sorted(mode["divergence rate [%]"] for mode in results.complex_modes(label))


# For each row of the table: label and positions among the ascending rates; half of the 24 F1 modes bend radially
POSITIONS = (("F1", 0), ("F1", 11), ("T1", 0), ("T1", -1), ("R0-1 +", 0), ("A1-2 +", 0), ("A0-4", 0, -1), ("A0-5", 0, -1), ("F1", -1))


@entry("dissipation", "The table of divergence rates with each form of C_b")
def all_readings(runs):
    rows = rates_with_all_readings(runs)
    for (name, _, _, *cells), (label, *positions) in zip(table("dissipation", "equal, consistent"), POSITIONS, strict=True):
        for column, cell in zip(READINGS, cells, strict=True):
            rates = rates_of(rows, label, column)
            for position, quoted in zip(positions, numbers_in(cell), strict=True):
                yield Number(f"{name}, {column}", quoted, rates[position])


@entry("dissipation", "3. Effect of the mesh of the faces: 7, 19 and 37 nodes")
def meshes(runs):
    for nodes, most, least in ((7, "-2.96", "-2.22"), (19, "-1.80", "-1.36"), (37, "-1.60", "-1.21")):
        results = runs(f"sliding_{nodes}", "sliding.prm", NO_SHAPES, f"Geometry/Nodes per pin face={nodes}")
        rates = of_modes(results, "T1")
        yield Number(f"T1, {nodes} nodes, most damped [%]", most, rates[0])
        yield Number(f"T1, {nodes} nodes, least damped [%]", least, rates[-1])
        yield Number(f"F1, {nodes} nodes, most damped [%]", "-1.4", of_modes(results, "F1")[0])


@entry("dissipation", "At mu = 0.01, divergence rates of F1 modes reach -5.16 % without mu in c_b, -0.05 % with it")
def small_friction(runs):
    for reading, quoted in (("published", "-5.16"), ("consistent", "-0.05")):
        results = runs(f"sliding_{reading}_at_0.01", "sliding.prm", NO_SHAPES, "Operation/Friction coefficient=0.01",
                       f"Operation/Radial dissipation={reading}")
        yield Number(f"most damped F1, {reading} [%]", quoted, of_modes(results, "F1")[0])


@entry("dissipation", "Seven more F1 modes have divergence rates of 0.01 to 0.04 %; rates of the leading pairs decrease by up to 0.15 points")
def destabilised(runs):
    rows = rates_with_all_readings(runs)
    yield Number("F1 modes with divergence rates above 0.001 % without it", "3", sum(rate > 0.001 for rate in rates_of(rows, "F1", "no C_b [%]")))
    for column, least, most in (("equal load consistent [%]", "0.01", "0.02"), ("steady sliding consistent [%]", "0.02", "0.04")):
        further = [rate for rate in rates_of(rows, "F1", column) if rate > 0.001][:-3]
        yield Number(f"further growing modes, {column}", "7", len(further))
        yield Number("  least [%]", least, further[0])
        yield Number("  most [%]", most, further[-1])
    losses = [rates_of(rows, label, "no C_b [%]")[-1] - rates_of(rows, label, column)[-1]
              for label in ("A0-4", "A0-5", "F1") for column in READINGS]
    yield Number("largest loss of a leading pair [%]", "0.15", max(losses), bound=True)
