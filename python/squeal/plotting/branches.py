# SPDX-License-Identifier: GPL-3.0-or-later

"""Frequencies and divergence rates versus the swept parameter, as in figures 7 to 9 of the paper."""

import math

from squeal.results import axis_title
from squeal.plotting import charts, complex_plane, style

FAMILIES_PER_PICTURE = 3
NAME_LENGTH = 0.2  # fraction of the width over which a curve must not cross its label
NAME_MARGIN = 0.1  # space for labels above and below the frequencies of a family, as a fraction of their range

# Line styles of the first and the second series; the first is drawn on top, so the second is wider
LOOKS = ({"color": style.BLACK, "linestyle": "-"}, {"color": style.GREY, "linestyle": (0, (4, 1.5))})
GROWING_LOOKS = ({"color": style.VERMILLION, "linestyle": "-"}, {"color": style.ORANGE, "linestyle": (0, (3, 1))})
WIDTHS, GROWING_WIDTHS = (0.9, 1.5), (2.4, 4.2)  # [points]
EVENTS = {"onset": "^", "restabilisation": "v"}
BREAK = (math.nan, math.nan)


def lines_of(chart, branches, quantity):
    """All points of branches, and their growing points with the adjacent points, as lines broken by NaN; empty if there
    are no points."""
    everything, growing = [], []
    for branch in branches:
        points = chart.curve(branch)
        for before, point, after in zip([None, *points], points, [*points[1:], None]):
            place = (point.mu, getattr(point, quantity)) if point.is_shown else BREAK
            everything.append(place)
            is_near = any(one and one.grows for one in (before, point, after))
            growing.append(place if is_near else BREAK)
            if not point.grows and not (after and after.grows):
                growing.append(BREAK)
        everything.append(BREAK)
        growing.append(BREAK)
    return [[place for before, place in zip([BREAK, *line], line) if not before is place is BREAK] for line in (everything, growing)]


def draw_curves(panel, all_charts, chosen, quantity, width):
    """Draws the chosen branches of each chart, their growing parts and their thresholds."""
    titles = list(dict.fromkeys(chart.title for chart in all_charts))
    for chart, branches in zip(all_charts, chosen):
        number = titles.index(chart.title)
        # A single point needs a marker to be visible
        marks = {"marker": "o", "markersize": 4} if len(chart.mus) == 1 else {}
        everything, growing = lines_of(chart, branches, quantity)
        style.draw_points(panel, everything, label=chart.title, linewidth=WIDTHS[number] * width, zorder=4 - number, **LOOKS[number], **marks)
        style.draw_points(panel, growing, label="growing, " + chart.title, linewidth=GROWING_WIDTHS[number] * width, zorder=4.5 - number,
                          **GROWING_LOOKS[number], **marks)
    for chart, branches in zip(all_charts, chosen):
        number = titles.index(chart.title)
        for event, marker in EVENTS.items():
            places = [(threshold.mu, threshold.frequency if quantity == "frequency" else 0.0)
                      for threshold in chart.thresholds if threshold.event == event and threshold.branch in branches]
            style.draw_points(panel, places, marker=marker, markersize=5.5 * width, color=LOOKS[number]["color"], markerfacecolor="white",
                              zorder=7 - number, label=event + (", " + chart.title if len(titles) > 1 else ""))


def add_names(panel, chart, branches):
    """Labels branches at their starting points above the curve, or below it for the lowest of several branches."""
    labels = [chart.labels[branch] for branch in branches]
    length = NAME_LENGTH * (chart.mus[-1] - chart.mus[0])
    starts = []
    for branch in branches:
        # Omit labels shared by several branches, because they would only repeat the title
        if labels.count(chart.labels[branch]) == 1:
            points = [point for point in chart.curve(branch) if point.is_shown]
            nearby = [point.frequency for point in points if point.mu <= points[0].mu + length]
            starts.append((points[0].frequency, points[0].mu, nearby, chart.labels[branch]))
    for i, (_, mu, nearby, label) in enumerate(sorted(starts)):
        is_below = i == 0 and len(starts) > 1
        panel.annotate(label, (mu, min(nearby) if is_below else max(nearby)), xytext=(4, -4 if is_below else 4), textcoords="offset points",
                       fontsize=style.SMALL, verticalalignment="top" if is_below else "bottom", zorder=8)


def growing_families(all_charts):
    """Families with a growing branch, by the lowest frequency [Hz] at which growth begins."""
    lowest = {}
    for chart in all_charts:
        for branch, label in chart.labels.items():
            start = next((point.frequency for point in chart.curve(branch) if point.grows), None)
            if start is not None:
                name = charts.family(label)
                lowest[name] = min(start, lowest.get(name, math.inf))
    return sorted(lowest, key=lambda name: (lowest[name], name))


def partners_of(all_charts, name):
    """Labels of the branches that coalesce with branches of a family."""
    return {chart.labels[threshold.partner] for chart in all_charts for threshold in chart.thresholds
            if threshold.partner in chart.labels and charts.family(chart.labels[threshold.branch]) == name}


def members(chart, name, partners):
    """Branches of a family, and branches of other families that coalesce with them in one of the charts."""
    labels = list(chart.labels.values())
    result = []
    for branch, label in chart.labels.items():
        # Include unnamed branches only if they grow
        is_member = charts.family(label) == name and (name != charts.NO_LABEL or chart.grows_somewhere(branch))
        # A label shared by several branches does not identify the partner in the other chart
        is_partner = label in partners and labels.count(label) == 1
        meets = any(threshold.partner == branch and charts.family(chart.labels[threshold.branch]) == name for threshold in chart.thresholds)
        if is_member or is_partner or meets:
            result.append(branch)
    return result


def leave_room(panel):
    """Extends the axis for labels above the highest and below the lowest curve."""
    values = [value for line in panel.get_lines() for value in line.get_ydata() if not math.isnan(value)]
    low, high = min(values), max(values)
    if low < high:
        panel.set_ylim(low - NAME_MARGIN * (high - low), high + NAME_MARGIN * (high - low))


def family_picture(all_charts, names):
    """Frequencies of each family, with divergence rates below them (next to them for a single family)."""
    picture = style.Picture("Growing branches and their families", 2 * len(names), len(names) if len(names) > 1 else 2)
    for name, upper, lower in zip(names, picture.panels, picture.panels[len(names):]):
        partners = partners_of(all_charts, name)
        chosen = [members(chart, name, partners) for chart in all_charts]
        style.prepare(upper, name, axis_title(all_charts[0].parameter), style.FREQUENCY)
        style.prepare(lower, name, axis_title(all_charts[0].parameter), style.DIVERGENCE)
        draw_curves(upper, all_charts, chosen, "frequency", 1.0)
        draw_curves(lower, all_charts, chosen, "divergence", 1.0)
        leave_room(upper)
        style.zero_line(lower)
        add_names(upper, all_charts[0], chosen[0])
        set_friction_range((upper, lower), all_charts)
        upper.ticklabel_format(useOffset=False)
    return picture.add_key()


def set_friction_range(panels, all_charts):
    mus = [mu for chart in all_charts for mu in chart.mus]
    for panel in panels if min(mus) < max(mus) else ():
        panel.set_xlim(min(mus), max(mus))


def family_figures(all_charts):
    """Figures of the growing families, at most three per figure."""
    names = growing_families(all_charts)
    parts = [names[i:i + FAMILIES_PER_PICTURE] for i in range(0, len(names), FAMILIES_PER_PICTURE)]
    return {"sweep_families" + (f"_{number}" if len(parts) > 1 else ""): family_picture(all_charts, part)
            for number, part in enumerate(parts, start=1)}


def overview_figure(all_charts, band_end):
    """Figure of all modes in the band."""
    picture = style.Picture("Modes in the band versus " + axis_title(all_charts[0].parameter).split(" [")[0], 2, 2, (5.4, 5.2))
    for panel, title, quantity, label in zip(picture.panels, ("Frequencies", "Divergence rates"), ("frequency", "divergence"),
                                             (style.FREQUENCY, style.DIVERGENCE)):
        style.prepare(panel, title, axis_title(all_charts[0].parameter), label)
        draw_curves(panel, all_charts, [list(chart.labels) for chart in all_charts], quantity, 0.75)
    picture.panels[0].set_ylim(0, band_end)
    style.zero_line(picture.panels[1])
    set_friction_range(picture.panels, all_charts)
    return picture.add_key()


def figures(results):
    all_charts = charts.read_charts(results)
    band_end = results.number("Band/Maximum frequency")
    return {**family_figures(all_charts), "complex_plane": complex_plane.sweep_figure(results, all_charts, band_end),
            "overview": overview_figure(all_charts, band_end)}
