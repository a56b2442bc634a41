"""doc/paper_section4.md"""

import paper
from reproduction.numbers import Number, entry


def solutions(runs):
    return runs(*paper.READINGS[paper.WITHOUT]), runs(*paper.READINGS[paper.WITH])


@entry("paper_section4", "The statements of sections 4.1 to 4.3")
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


@entry("paper_section4", "Rotating waves")
def waves(runs):
    for name, results, quoted in zip(("without C_b", "with C_b"), solutions(runs),
                                     (("0.989", "0.011", "0.961", "0.039"), ("0.989", "0.011", "0.956", "0.034"))):
        modes = {mode["label"]: mode for mode in results.complex_modes()}
        for label, share in zip(("A0-4 +", "A0-4 -", "A0-5 +", "A0-5 -"), quoted):
            yield Number(f"{label}, {name}: share with the rotation", share, modes[label]["wave with rotation [-]"])
        if name == "without C_b":
            yield Number("R0-1 +: share with the rotation", "0.746", modes["R0-1 +"]["wave with rotation [-]"])


@entry("paper_section4", "Bifurcation: thresholds without and with C_b")
def bifurcation(runs):
    results = runs("sweep_damped", "sweep_damped.prm")
    for name, n, quoted in (("thresholds_without_dissipation", "24", {"A0-4": "0.0883", "A0-5": "0.0893", "F1": "0.0172"}),
                            ("thresholds", "12", {"A0-4": "0.0837", "A0-5": "0.0875", "F1": "0.0208"})):
        rows = results.rows(name)
        yield Number(name, n, len(rows))
        for label, mu in quoted.items():
            # The leading pair of F1 lies above the others
            onset = max((row for row in rows if row["event"] == "onset" and row["label"].startswith(label)), key=lambda row: row["frequency [Hz]"])
            yield Number(f"onset of {label}", mu, onset["mu [-]"])
    rows = results.rows("thresholds_without_dissipation")
    ends = sorted(row["mu [-]"] for row in rows if row["event"] == "restabilisation")
    yield Number("restabilisations of F1", "8", len(ends))
    for place, mu in ((0, "0.0010"), (1, "0.238"), (-1, "0.422")):
        yield Number("  at", mu, ends[place])
    yield Number("onsets of F1", "12", sum(row["event"] == "onset" and row["label"] == "F1" for row in rows))
    yield Number("restabilisations with C_b", "0", sum(row["event"] == "restabilisation" for row in results.rows("thresholds")))
