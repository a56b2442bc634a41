"""doc/designs.md"""

from reproduction.numbers import Number, entry

RATE, HEIGHT = "largest divergence rate [%]", "Geometry/Pin height"
QUOTED = {0.0286: ("0.608", "0.993"), 0.0302: ("0.623", "0.986"), 0.0318: ("0.875", "1.172"), 0.0334: ("0.930", "1.501"),
          0.035: ("0.951", "1.756")}


@entry("designs", "Fifty designs of the default scene")
def fifty(runs):
    rows = runs("designs", "studies/designs.prm").table("designs.csv")
    yield Number("designs", "50", len(rows))
    yield Number("of which the pins flutter first", "48", sum(row["label at 0.01 %"] == "F1" for row in rows))
    for height, (least, greatest) in QUOTED.items():
        rates = [row[RATE] for row in rows if abs(float(row[HEIGHT]) - height) < 1e-9]
        yield Number(f"height {height} m, least", least, min(rates))
        yield Number("  greatest", greatest, max(rates))
    yield Number("modes", "66", rows[0]["modes [-]"])
