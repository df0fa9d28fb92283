# SPDX-License-Identifier: GPL-2.0-or-later
"""Our laws in liggghts against Yade's own: contact by contact (check), and in a stirred drum (bulk)."""
from tools import ROOT

DATA = ROOT / "yade"  # cases, input scripts, results
