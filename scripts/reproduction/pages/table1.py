# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/table1.md"""

import paper
from reproduction.numbers import Number, entry, numbers_in, of_mode, table

NO_SHAPES = "Output/Mode shapes=none"
FINE = ("Geometry/Element size=0.008", "Geometry/Disc layers=4", "Geometry/Pin layers=6")
MESHES = (  # folder, parameter file and settings, in the order of the table in the page
    ("mesh_7_nodes", "disc_pins.prm", "Geometry/Nodes per pin face=7"), ("default", "disc_pins.prm"),
    ("mesh_37_nodes", "disc_pins.prm", "Geometry/Nodes per pin face=37"),
    ("mesh_37_nodes_8_mm", "disc_pins.prm", "Geometry/Nodes per pin face=37", *FINE), ("mesh_degree_2", "quadratic.prm"))


def solution(runs, reading):
    return runs(*paper.READINGS[reading])


def table_one(runs):
    return list(paper.table_one(solution(runs, paper.WITHOUT), solution(runs, paper.WITH)))


@entry("table1", "The agreement: component, coupled and complex frequencies, numbers below 5 kHz")
def agreement(runs):
    results, rows = solution(runs, paper.WITHOUT), table_one(runs)
    for name, quoted, of in (("component", "3.2", "34"), ("coupled", "3.0", "34"), ("without C_b", "2.8", "38"), ("with C_b", "2.8", "39")):
        value, number, _, _ = paper.agreement(rows, name)
        yield Number(f"{name}: difference, rms [%]", quoted, value)
        yield Number("  number of modes", of, number)
    counts = results.record["counts"]
    for name, quoted in (("disc modes", "30"), ("sliding pin modes", "36"), ("real modes", "66")):
        yield Number(name, quoted, counts[name])
    yield Number("complex modes", "66", len(results.rows("complex_modes")))


@entry("table1", "Unstable pairs without radial dissipation")
def unstable_pairs(runs):
    modes = solution(runs, paper.WITHOUT).complex_modes()
    growing = sorted((mode for mode in modes if mode["divergence rate [%]"] > 0.01), key=lambda mode: -mode["divergence rate [%]"])
    for place, (label, frequency, rate) in enumerate((("F1", "3569", "1.07"), ("A0-5", "3452", "0.86"), ("A0-4", "2353", "0.68"),
                                                      ("F1", "3548", "0.32"), ("F1", "3542", "0.12"))):
        yield from of_mode(f"{place + 1}. {growing[place]['label']} ({label} in the page)", growing[place], frequency, rate)


@entry("table1", "With C_b, consistent and about steady sliding")
def damped(runs):
    modes = solution(runs, paper.WITH).complex_modes()

    def rates(label):
        return sorted((mode["divergence rate [%]"], mode["frequency [Hz]"]) for mode in modes if mode["label"].startswith(label))

    for label, grows, decays in (("A0-4", ("2353", "0.67"), ("2353", "-0.69")), ("A0-5", ("3455", "0.82"), ("3451", "-0.94"))):
        for (frequency, rate), found in ((grows, rates(label)[-1]), (decays, rates(label)[0])):
            yield Number(f"{label} [%]", rate, found[0])
            yield Number("  [Hz]", frequency, found[1])
    bending = rates("F1")
    for name, place, rate, frequency in (("growing", -1, "0.97", "3566"), ("next damped", 12, "-0.39", "3543"),
                                         ("second next damped", 13, "-0.31", "3521")):
        yield Number(f"F1, {name} [%]", rate, bending[place][0])
        yield Number("  [Hz]", frequency, bending[place][1])
    for name, places, least, most in (("neutral", slice(14, 23), "0.02", "0.09"), ("damped half", slice(0, 12), "-1.41", "-0.89")):
        yield Number(f"F1, {name}, least [%]", least, bending[places][0][0])
        yield Number(f"F1, {name}, most [%]", most, bending[places][-1][0])
    for label, rate in (("T1", "-1.80"), ("R0-1 +", "-0.110"), ("A1-2 +", "-0.123")):
        yield Number(f"{label}, most damped [%]", rate, rates(label)[0][0])
    yield Number("T1, least damped [%]", "-1.36", rates("T1")[-1][0])


@entry("table1", "Differences of more than 7 %")
def large_differences(runs):
    rows = {row["label"]: row for row in table_one(runs)}
    for label, column, quoted in (("C0-0", "component", "-8.0"), ("C0-0", "coupled", "-8.0"), ("R0-1 -", "component", "6.3"),
                                  ("R0-1 -", "coupled", "7.3"), ("A0-2 +", "coupled", "-7.2"), ("A0-2 +", "component", "-6.1")):
        yield Number(f"{label}, {column} [%]", quoted, rows[label][f"{column} difference [%]"])


@entry("table1", "Convergence in the band: A0-4, A0-5 and the leading F1 on five meshes")
def convergence(runs):
    for (folder, parameter_file, *settings), (name, _, *cells) in zip(MESHES, table("table1", "leading F1"), strict=True):
        results = runs(folder, parameter_file, NO_SHAPES, *settings)
        for label, cell in zip(("A0-4", "A0-5", "F1"), cells):
            yield from of_mode(f"{name}: {label}", results.leading(label), *numbers_in(cell))


@entry("table1", "F1 at 3353 Hz: the coupled modes up to this frequency in the paper's table")
def coupled_modes_up_to_f1(runs):
    printed = [row["coupled paper [Hz]"] for row in table_one(runs) if row["coupled paper [Hz]"] is not None]
    yield Number("coupled modes up to 3353 Hz", "18", sum(frequency <= 3353 for frequency in printed))
