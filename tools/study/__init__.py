# SPDX-License-Identifier: GPL-2.0-or-later
"""What a study's runs tell: means over seeds, what single changes do, lines through sizes and loads.

A campaign (scripts/campaign NAME) writes results/studies/NAME/observations.csv, a row an observation, and runs.csv, a row a
run; these commands read them, or the tables of both kinds that are kept in cases/ and findings/.
"""
from tools import command_line
from tools.study import seeds, sensitivity, size_effect, triangles, yield_locus

COMMANDS = {
    "seeds": seeds,
    "sensitivity": sensitivity,
    "size-effect": size_effect,
    "triangles": triangles,
    "yield-locus": yield_locus,
}


def main():
    return command_line.run_subcommands("study", __doc__, COMMANDS)
