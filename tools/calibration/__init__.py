# SPDX-License-Identifier: GPL-2.0-or-later
"""Calibrates a material on the rigs: a space-filling design, an emulator, a posterior, and a family of its members.

  scripts/calibrate design PLAN.toml --out STUDY.csv      then: scripts/campaign STUDY.csv --out RESULTS
  scripts/calibrate fit PLAN.toml RESULTS/runs.csv --out NAME.posterior.csv

A plan (materials/hulled_millet.calibration.toml) holds the parameters with their priors, the runs of each point, and the
targets with their sources and uncertainties.
"""
from tools import command_line
from tools.calibration import design, fit


def main():
    return command_line.run_subcommands("calibrate", __doc__, {"design": design, "fit": fit})
