"""doc/decisions.md"""

import os
import re

from reproduction.numbers import Number, entry


@entry("decisions", "prm/sweep.prm with the OpenBLAS kernels SkylakeX and Haswell: the same thresholds within their uncertainties")
def kernels(runs):
    tables = []
    for name in ("SkylakeX", "Haswell"):
        results = runs(f"sweep_{name}", "sweep.prm", "Output/Mode shapes=none", environment={**os.environ, "OPENBLAS_CORETYPE": name})
        tables.append(results.table("thresholds.csv"))
        yield Number(f"{name}: thresholds", "24", len(tables[-1]))
        text = next(step["result"] for step in results.record["steps"] if step["name"] == "Branches")
        yield Number(f"{name}: refinements", "86", float(re.search(r"(\d+) refinements", text)[1]))
    ratios = [abs(a["mu [-]"] - b["mu [-]"]) / (a["uncertainty [-]"] + b["uncertainty [-]"]) for a, b in zip(*tables)]
    yield Number("largest difference / sum of the uncertainties", "0.1", max(ratios), bound=True)
