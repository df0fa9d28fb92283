# SPDX-License-Identifier: GPL-2.0-or-later
"""Response libraries: runs added to one that was made earlier, what its effects do, and which tests show them.

A library is a folder that `vielto gap collect` makes of a campaign's runs (gap/README.md says what is in it).
"""
from tools import command_line
from tools.library import add, design, detectability, responses, shares

COMMANDS = {"add": add, "design": design, "responses": responses, "detectability": detectability, "shares": shares}


def main():
    return command_line.run_subcommands("library", __doc__, COMMANDS)
