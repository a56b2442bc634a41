# SPDX-License-Identifier: GPL-3.0-or-later

"""Meshes and matrices from files of other programs."""
