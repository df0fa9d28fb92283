# SPDX-License-Identifier: GPL-2.0-or-later
"""Runs all of a study, studies/NAME.csv, on the cores of this machine or on a Slurm cluster.

  scripts/campaign NAME [--cores N] [--slurm]
  scripts/campaign FOLDER/MINE.csv --out results/mine

Killed at any moment it goes on where it was when called again, and ends with the same tables: OUT/observations.csv, a row an
observation, and OUT/runs.csv, a row a run. Runs that stop by themselves (a wedged grain) are named and left out of the
tables; the exit status is then 1. A run that was broken off begins anew, or, where the study gives restartTurns or
restartRows, goes on from its newest restart (then equal to a run in one go only until round-off has grown). Finished runs
of other cards, scripts or settings than there are now are refused; --again makes them anew. Snakemake does the work; this
command builds, frees what a kill has left, and shows progress with the time left.
"""
