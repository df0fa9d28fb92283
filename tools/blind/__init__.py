# SPDX-License-Identifier: GPL-2.0-or-later
"""The check with withheld cases (gap-withhold makes them, gap-score marks the answers), apart from both.

A withheld case is a table of observations made from a law and effects that the diagnosis is not told. Its truth lies in
FOLDER/check/truth, its answer in FOLDER/answers.
"""
from tools import command_line
from tools.blind import count_answers, diagnose, hide, list_strong, resimulate, robust

COMMANDS = {
    "hide": hide,
    "diagnose": diagnose,
    "list-strong": list_strong,
    "resimulate": resimulate,
    "count-answers": count_answers,
    "robust": robust,
}


def main():
    return command_line.run_subcommands("blind", __doc__, COMMANDS)
