# SPDX-License-Identifier: GPL-3.0-or-later

"""Plots of the tables of a run; scripts/plot_results.py draws all of them."""
