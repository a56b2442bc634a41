# SPDX-License-Identifier: GPL-3.0-or-later

"""doc/paper.md, except numbers reproduced for other pages"""

import paper
from reproduction.numbers import Number, entry, of_mode, table

NO_SHAPES = "Output/Mode shapes=none"


@entry("paper", "Table 3: component modes up to 6, 7.5 and 10 kHz")
def truncations(runs):
    results = runs("frictionless_frequency", "studies/frictionless_frequency.prm")
    rows = {row["component modes"]: row for row in results.rows("reduction_truncations")}
    for name, *quoted in (("6000 Hz", "30", "36", "36"), ("7500 Hz", "38", "72", "36"), ("10000 Hz", "53", "120", "60")):
        for column, number in zip(("disc [-]", "pins free [-]", "pins sliding [-]"), quoted):
            yield Number(f"{name}, {column}", number, rows[name][column])


@entry("paper", "Tables 2, 4, 5 and 6: sizes of the bases")
def sizes(runs):
    rows = {row["basis"]: row for row in runs("friction", "studies/friction.prm").rows("reduction_bases")}
    for basis, quoted in (("free", "200"), ("fixed", "368"), ("mixed", "368"), ("free + t.a.m.", "428"), ("free with r.a.m.", "200"),
                          ("fixed + t.a.m.", "596"), ("mixed + t.a.m.", "596"), ("real", "66"), ("real + t.a.m.", "294"),
                          ("real + 1st-ord.", "132")):
        yield Number(basis, quoted, rows[basis]["n_r [-]"])


def solutions(runs):
    return runs(*paper.READINGS[paper.WITHOUT]), runs(*paper.READINGS[paper.WITH])


@entry("paper", "The statements of sections 4.1 to 4.3")
def statements(runs):
    rows = paper.statements(*solutions(runs))

    def here(words):
        return next(row["here"] for row in rows if words in row["statement"])

    for words, quoted in (("bending modes F1 per pin", "2"), ("torsional modes T1 per pin", "1"), ("splits double disc modes", "38.0"),
                          ("spreads the bending modes", "0.60"), ("hardly splits in-plane", "0.03"), ("coupling hardly shifts", "0.002"),
                          ("coupled ones, without C_b", "1.02"), ("coupled ones, with C_b", "0.83"), ("friction hardly shifts", "0.007"),
                          ("unstable disc modes without", "2"), ("unstable pin modes without", "3"), ("stable partner", "0"),
                          ("sum of the divergence rates of A0-4", "-0.01"), ("sum of the divergence rates of A0-5", "-0.12"),
                          ("growing A0-4", "-0.006"), ("growing A0-5", "-0.038"), ("leading F1", "-0.098"),
                          ("second unstable pin mode", "0.087"), ("F1, most damped", "-1.41"), ("F1, least damped", "-0.89"),
                          ("T1, most damped", "-1.80"), ("T1, least damped", "-1.36"), ("unstable modes with C_b", "12")):
        yield Number(words, quoted, here(words))
    for label, quoted in (("A0-4 +", "99"), ("A0-5 +", "96")):
        yield Number(f"{label}: share of the wave that travels one way [%]", quoted, 100 * here(f"{label} looks like a rotating wave"))


@entry("paper", "Statement of section 4: eighteen pins")
def eighteen_pins(runs):
    results = runs("disc_pins_18", "disc_pins_18.prm", NO_SHAPES)
    for label, rate in (("A0-4", "2.06"), ("F1", "1.99")):
        yield from of_mode(label, results.leading(label), None, rate)


@entry("paper", "Rotating waves")
def waves(runs):
    without, damped = ({mode["label"]: mode["wave with rotation [-]"] for mode in results.complex_modes()} for results in solutions(runs))
    for name, *quoted in table("paper", "with the rotation, without C_b"):
        label = name.split(",")[0]
        for what, share, found in zip(("without C_b", "with C_b"), quoted, (without[label], damped[label])):
            yield Number(f"{label}, {what}: share with the rotation", share, found)


@entry("paper", "Bifurcation: thresholds without and with C_b")
def bifurcation(runs):
    results = runs("sweep_damped", "sweep_damped.prm")
    for name, n, quoted in (("thresholds_without_dissipation", "24", {"A0-4": "0.0883", "A0-5": "0.0893", "F1": "0.0172"}),
                            ("thresholds", "12", {"A0-4": "0.0837", "A0-5": "0.0875", "F1": "0.0208"})):
        rows = results.rows(name)
        yield Number(name, n, len(rows))
        for label, mu in quoted.items():
            # The leading pair of F1 modes has a higher frequency than the other pairs
            onset = max((row for row in rows if row["event"] == "onset" and row["label"].startswith(label)), key=lambda row: row["frequency [Hz]"])
            yield Number(f"onset of {label}", mu, onset["mu [-]"])
    rows = results.rows("thresholds_without_dissipation")
    ends = sorted(row["mu [-]"] for row in rows if row["event"] == "restabilisation")
    yield Number("restabilisations of F1", "8", len(ends))
    for place, mu in ((0, "0.0010"), (1, "0.238"), (-1, "0.422")):
        yield Number("  at", mu, ends[place])
    yield Number("onsets of F1", "12", sum(row["event"] == "onset" and row["label"] == "F1" for row in rows))
    yield Number("restabilisations with C_b", "0", sum(row["event"] == "restabilisation" for row in results.rows("thresholds")))


@entry("paper", "Statement of section 5.2: how the errors of free and fixed bases decrease from 6 to 10 kHz")
def decreasing_errors(runs):
    rows = [row for row in runs("frictionless_frequency", "studies/frictionless_frequency.prm").rows("reduction_errors") if row["group"] == "disc"]
    first, last = ({row["basis"]: row for row in rows if row["component modes"] == name} for name in ("6000 Hz", "10000 Hz"))
    for column, quoted in (("res [-]", "208"), ("mac [-]", "2050"), ("frq [-]", "225")):
        yield Number(f"free: {column} falls by", quoted, first["free"][column] / last["free"][column])
    for name, row, quoted in (("6 kHz", first, "0.48"), ("10 kHz", last, "0.61")):
        yield Number(f"fixed, {name}: eps_mac", quoted, row["fixed"]["mac [-]"])


@entry("paper", "Statement of section 7: verdicts of modes with errors of the divergence rate above 0.1 %")
def wrong_verdicts(runs):
    rows = runs("friction", "studies/friction.prm").rows("reduction_modes")
    for is_large, n_modes, n_wrong in ((True, "110", "47"), (False, "1078", "9")):
        modes = [row for row in rows if (row["eps_div [-]"] > 1e-3) == is_large]
        yield Number(f"modes with an error {'above' if is_large else 'up to'} 0.1 %", n_modes, len(modes))
        yield Number("  wrong verdicts", n_wrong,
                     sum((row["divergence rate [%]"] > 0.01) != (row["reference divergence rate [%]"] > 0.01) for row in modes))
