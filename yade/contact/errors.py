# SPDX-License-Identifier: GPL-2.0-or-later
class BadInput(Exception):
    """What the user gave cannot be used; exit status 2."""


class RunFailed(Exception):
    """An engine did not finish; exit status 1."""
