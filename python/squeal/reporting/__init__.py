# SPDX-License-Identifier: GPL-3.0-or-later

"""Content and layout of the page written by scripts/report.py."""
