# SPDX-License-Identifier: GPL-2.0-or-later
"""Response libraries: runs added to one that was made earlier, and what its effects do.

A library is a folder that `vielto gap collect` makes of a campaign's runs (doc/reference/library.md says what is in it).
"""
from tools import command_line
from tools.library import add, design, responses, shares

COMMANDS = {"add": add, "design": design, "responses": responses, "shares": shares}


def main():
    return command_line.run_subcommands("library", __doc__, COMMANDS)
