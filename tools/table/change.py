# SPDX-License-Identifier: GPL-2.0-or-later
"""Writes a value into a column of the rows that are chosen; the table is changed in place.

  scripts/table change observations.csv --where 'test=l0.15_n(0.48|1.21)' --set role=fit
"""
import pathlib

from tools import table, tables
from tools.errors import BadInput


def add_options(parser):
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("--set", required=True, metavar="COLUMN=VALUE")
    table.add_choice(parser)


def work(options):
    column, equals, value = options.set.partition("=")
    if not equals:
        raise BadInput(f"--set {options.set}: is no COLUMN=VALUE; state for example role=fit")
    is_chosen = table.chosen(options)
    rows = tables.read(options.table, [column, *table.columns(options)], "name a table that has it")
    changed = [row for row in rows if is_chosen(row)]
    if not changed:
        raise BadInput(f"{options.table}: no row of {len(rows)} is chosen; look at --where and --without")
    for row in changed:
        row[column] = value
    tables.write(options.table, rows.header, rows)
