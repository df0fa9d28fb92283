# SPDX-License-Identifier: GPL-2.0-or-later
"""The CSV tables of workflow/: read and written with one clear line for every fault."""
import csv
import math
import pathlib


class BadInput(Exception):
    pass


def read(path, columns, mend, key=None, seen=None):
    """[(line, row)] of a table that has these columns. `mend` tells what to give instead. With `key` that column names each
    row once, in all tables that share the set `seen`."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file, strict=True)
            rows = [(reader.line_num, row) for row in reader]
            header = reader.fieldnames or []
    except OSError as e:
        raise BadInput(f"{path}: {e.strerror}; {mend}")
    except (UnicodeDecodeError, csv.Error):
        raise BadInput(f"{path}: is no CSV table; {mend}")
    lacking = [c for c in columns if c not in header]
    if lacking:
        raise BadInput(f"{path}:1: has no column {', '.join(lacking)}; {mend}")
    if not rows:
        raise BadInput(f"{path}: holds no row below its header; {mend}")
    names = set() if seen is None else seen
    for line, row in rows:
        if None in row or None in row.values():
            raise BadInput(f"{path}:{line}: has not as many cells as the header; {mend}")
        if key:
            if row[key] in names:
                raise BadInput(f"{path}:{line}: {row[key]} is there twice; state each once")
            names.add(row[key])
    return rows


def number(path, line, row, column, above=None):
    """A finite number, above a limit if one is given."""
    try:
        value = float(row[column])
    except (TypeError, ValueError):
        value = math.nan
    if not math.isfinite(value) or (above is not None and not value > above):
        raise BadInput(
            f"{path}:{line}: {column} is '{row[column]}'; a finite number{'' if above is None else f' above {above:g}'} is needed"
        )
    return value


def write(path, text):
    """Whole or not at all."""
    path = pathlib.Path(path)
    partial = path.with_name(path.name + ".partial")
    try:
        if path.is_dir():
            raise IsADirectoryError(21, "is a folder")
        partial.write_text(text)
        partial.rename(path)
    except OSError as e:
        partial.unlink(missing_ok=True)
        raise BadInput(f"{path}: cannot be written: {e.strerror}; state a file in a folder that is there")
