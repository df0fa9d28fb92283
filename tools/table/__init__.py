# SPDX-License-Identifier: GPL-2.0-or-later
"""Rows of a CSV table chosen and changed by what stands in their columns.

Rows are chosen with --where COLUMN=PATTERN and --without COLUMN=PATTERN, each of which may be repeated: those whose cell is,
as a whole, what every --where says and no --without. A PATTERN is a regular expression: apparatus='mixer|bench'.
"""
import re

from tools import command_line
from tools.errors import BadInput
from tools.table import change, select


def main():
    return command_line.run_subcommands("table", __doc__, {"select": select, "change": change})


def add_choice(parser):
    for word in ("where", "without"):
        parser.add_argument("--" + word, action="append", default=[], metavar="COLUMN=PATTERN")


def columns(options):
    return [text.partition("=")[0] for text in (*options.where, *options.without)]


def chosen(options):
    """A function of a row: whether the options choose it."""
    where, without = ([_pattern(text) for text in texts] for texts in (options.where, options.without))

    def is_chosen(row):
        return all(p.fullmatch(row[c]) for c, p in where) and not any(p.fullmatch(row[c]) for c, p in without)

    return is_chosen


def _pattern(text):
    column, equals, pattern = text.partition("=")
    try:
        if not equals:
            raise re.error("there is no =")
        return column, re.compile(pattern)
    except re.error as e:
        raise BadInput(f"{text}: is no COLUMN=PATTERN ({e}); state for example apparatus='mixer|bench'")
