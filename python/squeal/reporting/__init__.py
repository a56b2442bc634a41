# SPDX-License-Identifier: GPL-3.0-or-later

"""Content and layout of the page that scripts/report.py writes."""
