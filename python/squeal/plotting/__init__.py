# SPDX-License-Identifier: GPL-3.0-or-later

"""Plots of the tables that a run has left; scripts/plot_results.py draws them all."""
