# SPDX-License-Identifier: GPL-2.0-or-later
"""Speed of the code: against its peers and the hardware (compare), on several ranks (scaling)."""
from tools import ROOT

DATA = ROOT / "bench"  # input scripts, results
