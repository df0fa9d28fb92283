# SPDX-License-Identifier: GPL-2.0-or-later
"""CSV tables: one reader and one writer for all programs of this package."""
import csv
import io
import math

from tools import files
from tools.errors import BadInput


class Row(dict):
    """A row by the names of its columns, all of them text; it knows where it stands."""

    def __init__(self, cells, path, line):
        super().__init__(cells)
        self.path, self.line = path, line

    @property
    def place(self):
        return f"{self.path}:{self.line}"

    def fault(self, what):
        return BadInput(f"{self.place}: {what}")

    def number(self, column, above=None):
        """A finite number, above a limit if one is given."""
        try:
            value = float(self[column])
        except ValueError:
            value = math.nan
        if not math.isfinite(value) or (above is not None and not value > above):
            limit = "" if above is None else f" above {above:g}"
            raise self.fault(f"{column} is '{self[column]}'; a finite number{limit} is needed")
        return value


class Table(list):
    """Rows, and the names of the columns in their order."""

    def __init__(self, header, rows):
        super().__init__(rows)
        self.header = header


def read(path, columns, mend, key=None, seen=None, may_be_empty=False):
    """The table of a file that has these columns. `mend` tells what to give instead. With `key` that column names each
    row once, in all tables that share the set `seen`."""
    try:
        with open(path, newline="", encoding="utf-8") as file:
            reader = csv.DictReader(file, strict=True)
            rows = [Row(cells, path, reader.line_num) for cells in reader]
            header = list(reader.fieldnames or [])
    except OSError as e:
        raise BadInput(f"{path}: {e.strerror}; {mend}")
    except (UnicodeDecodeError, csv.Error):
        raise BadInput(f"{path}: is no CSV table; {mend}")
    lacking = [c for c in columns if c not in header]
    if lacking:
        raise BadInput(f"{path}:1: has no column {', '.join(lacking)}; {mend}")
    if not rows and not may_be_empty:
        raise BadInput(f"{path}: holds no row below its header; {mend}")
    names = set() if seen is None else seen
    for row in rows:
        if None in row or None in row.values():
            raise row.fault(f"has not as many cells as the header; {mend}")
        if key:
            if row[key] in names:
                raise row.fault(f"{row[key]} is there twice; state each once")
            names.add(row[key])
    return Table(header, rows)


def read_record(path):
    """A rig's record: the settings that stand on top, `# name=value`, and the table below them."""
    lines = files.read_text(path, "name a record of a run").splitlines()
    top = next((k for k, line in enumerate(lines) if not line.startswith("#")), len(lines))
    settings = dict(line[1:].strip().partition("=")[::2] for line in lines[:top] if "=" in line)
    reader = csv.DictReader(lines[top:], strict=True)
    rows = [Row(cells, path, top + reader.line_num) for cells in reader]
    if not rows:
        raise BadInput(f"{path}: holds no row; name the record of a run that is complete")
    return settings, Table(list(reader.fieldnames), rows)


def text(header, rows):
    """The table as CSV; a row is a sequence of cells or a mapping."""
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(header)
    writer.writerows([row.get(c, "") for c in header] if isinstance(row, dict) else row for row in rows)
    return out.getvalue()


def write(path, header, rows):
    files.write_text(path, text(header, rows))
