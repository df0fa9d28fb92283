# SPDX-License-Identifier: GPL-2.0-or-later
"""The rows that are chosen, as a table.

  scripts/table select tests.csv --where 'apparatus=mixer|bench' --without role=bench --out mixer.csv
"""
import pathlib

from tools import table, tables
from tools.errors import BadInput


def add_options(parser):
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("--out", type=pathlib.Path, required=True, help="may be the table itself")
    table.add_choice(parser)


def work(options):
    is_chosen = table.chosen(options)
    rows = tables.read(options.table, table.columns(options), "name a table that has it")
    kept = [row for row in rows if is_chosen(row)]
    if not kept:
        raise BadInput(f"{options.table}: no row of {len(rows)} is chosen; look at --where and --without")
    tables.write(options.out, rows.header, kept)
