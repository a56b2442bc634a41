# SPDX-License-Identifier: GPL-3.0-or-later

"""Colours, axes and numbers of the charts of a page."""

import math

UNSTABLE, STABLE, PALE = "#b2182b", "#2166ac", "#b9c2cc"
WEAK = 0.01  # divergence rate [%] up to which growth counts as weak
RATE, DAMPING, FREQUENCY = "divergence rate [%]", "effective damping ratio -2R/omega [%]", "frequency [Hz]"


def number(text):
    return math.nan if text == "" else float(text)


def short(text, n=6):
    """The number in a text, rounded to n digits, for a chart."""
    return float(f"{number(text):.{n}g}")


def digits(value, n=4):
    return f"{value:.{n}g}"


def layout(x, y, **more):
    axis = {"zeroline": False, "gridcolor": "#e8ebee", "linecolor": "#8a939c", "ticks": "outside", "automargin": True, "exponentformat": "power"}
    return {"xaxis": {**axis, "title": {"text": x, "standoff": 6}}, "yaxis": {**axis, "title": y}, "hovermode": "closest",
            "plot_bgcolor": "white", "paper_bgcolor": "white", "margin": {"l": 60, "r": 16, "t": 30, "b": 50}, "legend": {"orientation": "h", "y": 1.02, "yanchor": "bottom", "x": 0},
            "font": {"family": "inherit", "size": 13}, **more}


def points(name, x, y, about=None, mode="markers", **more):
    """A series of points or lines; `about`: hover text of each point."""
    hover = {} if about is None else {"customdata": about, "hovertemplate": "%{customdata}<extra></extra>"}
    return {"type": "scatter", "mode": mode, "name": name, "x": x, "y": y, **hover, **more}


def best_so_far(rows, goal, **more):
    """Series of the best value of a goal versus the number of evaluated designs."""
    return points("best so far", [int(row["design [-]"]) for row in rows], [short(row["best " + goal]) for row in rows], mode="lines",
                  line={"color": "#222", "width": 1.6, "shape": "hv"}, **more)


def name_of_mode(row):
    return f"{row['label']}, {number(row[FREQUENCY]):.0f} Hz, ξ = {digits(number(row[RATE]), 3)} %"


def confidence(row):
    lower, upper = (digits(number(row[f"{end} confidence limit [%]"]), 3) for end in ("lower", "upper"))
    return f"95 % confidence interval {lower} to {upper} %"


def plain(text, n=5):
    """A cell of a table, with numbers rounded to n digits."""
    try:
        return digits(float(text), n).replace("e+0", "e").replace("e+", "e").replace("e-0", "e-")
    except ValueError:
        return text


def names_apart(heights, span, most=8, share=0.05):
    """Keys of the largest heights whose labels do not overlap in a chart with this span."""
    named = []
    for key in sorted(heights, key=heights.get, reverse=True):
        if len(named) < most and all(abs(heights[key] - heights[other]) > share * span for other in named):
            named.append(key)
    return named


def end_of_band(results):
    return f"{results.number('Band/Maximum frequency'):g} Hz"
