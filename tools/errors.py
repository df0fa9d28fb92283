# SPDX-License-Identifier: GPL-2.0-or-later
"""What ends a program, each with one clear line on standard error (command_line.py)."""


class BadInput(Exception):
    """What the user gave cannot be used; says place, fault and mend. Exit status 2."""


class RunFailed(Exception):
    """The work itself did not succeed. Exit status 1."""
