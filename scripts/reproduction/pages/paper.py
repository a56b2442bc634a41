"""doc/paper.md, but for what has a page of its own"""

import paper
from reproduction.numbers import Number, entry

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


@entry("paper", "Figures 7 and 8: where A0-4 and A0-5 coalesce, and pairs of F1 separate again")
def coalescences(runs):
    rows = runs("sweep_without", "sweep.prm", NO_SHAPES).rows("thresholds")
    for label, quoted in (("A0-4", "0.088"), ("A0-5", "0.089")):
        yield Number(f"onset of {label}", quoted, next(row["mu [-]"] for row in rows if row["label"].startswith(label)))
    ends = sorted(row["mu [-]"] for row in rows if row["event"] == "restabilisation" and row["label"] == "F1")
    yield Number("first restabilisation of F1", "0.001", ends[0])
    yield Number("the next one", "0.24", ends[1])
    yield Number("the last one", "0.42", ends[-1])


@entry("paper", "Statements of section 4")
def section_four(runs):
    rows = paper.statements(runs(*paper.READINGS[paper.WITHOUT]), runs(*paper.READINGS[paper.WITH]))

    def here(words):
        return next(row["here"] for row in rows if words in row["statement"])

    for words, quoted in (("bending modes F1 per pin", "2"), ("splits double disc modes", "38.0"), ("spreads the bending modes", "0.60"),
                          ("hardly shifts in-plane", "0.002"), ("real coupled ones, without C_b", "1.02"),
                          ("real coupled ones, with C_b", "0.83"),
                          ("unstable disc modes without", "2"), ("unstable pin modes without", "3"), ("unstable modes with C_b", "12")):
        yield Number(words, quoted, here(words))
    for label, quoted in (("A0-4 +", "99"), ("A0-5 +", "96")):
        yield Number(f"{label}: share of the wave that travels one way [%]", quoted, 100 * here(f"{label} looks like a rotating wave"))
