# SPDX-License-Identifier: GPL-3.0-or-later

"""The exception of the module and the scripts."""


class Error(Exception):
    """An error in three parts: what happened, where, and what to change."""

    def __init__(self, what, where, change):
        super().__init__(what, where, change)
        self.what, self.where, self.change = what, where, change

    def __str__(self):
        return f"{self.what}\n  where:  {self.where}\n  change: {self.change}"
