# SPDX-License-Identifier: GPL-2.0-or-later
"""The directive {results}: a small table on a page, straight from one of the repository's CSV tables.

    ```{results} findings/grain_size/mixer_grain_size.runs.csv
    :where: run = (base|d).*
    :by: grainDiameter
    :show: Grain [mm] = 1000 grainDiameter .3g; Runs = n; Power [W] = power_W .1f; scatter = sd power_W .1f
    ```

Rows whose column matches every `where` (a regular expression for the whole cell; several are divided by `;`) are put
together where their cells of `by` are the same, in the order of their first row; without `by` each row stands alone. A
column is shown as `LABEL = [mean|sd|u|min|max|n] [FACTOR] COLUMN [FORMAT]`: the mean of the group unless told otherwise,
u the standard deviation over the root of the number of rows; a column of words as it is. The path starts at the repository's root.
"""
import csv
import pathlib
import re
import statistics

from docutils import nodes
from docutils.parsers.rst import Directive, directives

ROOT = pathlib.Path(__file__).resolve().parents[2]


def spread(values):
    return statistics.stdev(values) if len(values) > 1 else float("nan")


STATISTICS = {
    "mean": statistics.fmean,
    "sd": spread,
    "u": lambda values: spread(values) / len(values) ** 0.5,
    "min": min,
    "max": max,
}


def matching(rows, where):
    for condition in filter(None, (part.strip() for part in where.split(";"))):
        column, pattern = (part.strip() for part in condition.split("=", 1))
        rows = [row for row in rows if re.fullmatch(pattern, row[column])]
    return rows


def groups(rows, by):
    found = {}
    for row in rows:
        found.setdefault(tuple(row[column] for column in by) if by else len(found), []).append(row)
    return list(found.values())


def shown(rows, what):
    """One cell: `what` as the directive's `show` has it behind the label."""
    words = what.split()
    if words == ["n"]:
        return str(len(rows))
    named = words[0] in STATISTICS and len(words) > 1 and not words[1].startswith(".")  # else a column of that name
    statistic = STATISTICS[words.pop(0)] if named else statistics.fmean
    factor = float(words.pop(0)) if re.fullmatch(r"[-+.\de]+", words[0]) else 1.0
    column, form = words[0], words[1] if len(words) > 1 else ".3g"
    cells = [row[column] for row in rows if row[column] != ""]
    try:
        values = [factor * float(cell) for cell in cells]
    except ValueError:
        return ", ".join(dict.fromkeys(cells))
    if not values:
        return "–"
    value = statistic(values)
    return "–" if value != value else format(value, form).replace("-", "−")


class Results(Directive):
    required_arguments = 1
    option_spec = {
        "where": directives.unchanged,
        "by": directives.unchanged,
        "show": directives.unchanged_required,
    }

    def run(self):
        path = ROOT / self.arguments[0]
        self.state.document.settings.env.note_dependency(str(path))
        try:
            with open(path, newline="", encoding="utf-8") as file:
                rows = matching(list(csv.DictReader(file)), self.options.get("where", ""))
            if not rows:
                raise self.error(f"{path.name}: no row is left under `where`")
            columns = [part.split("=", 1) for part in self.options["show"].split(";")]
            by = self.options.get("by", "").split()
            cells = [[shown(group, what) for _, what in columns] for group in groups(rows, by)]
        except (OSError, KeyError, ValueError) as fault:
            raise self.error(f"{self.arguments[0]}: {fault!r}") from fault
        return [table([label.strip() for label, _ in columns], cells)]


def table(head, body, code=0):
    """Rows of words; the first `code` columns are set as code."""
    group = nodes.tgroup(cols=len(head))
    group += [nodes.colspec(colwidth=1) for _ in head]

    def row(cells, code):
        line = nodes.row()
        for column, cell in enumerate(cells):
            text = nodes.literal(text=cell) if column < code else nodes.Text(cell)
            line += nodes.entry("", nodes.paragraph("", "", text))
        return line

    group += nodes.thead("", row(head, 0))
    group += nodes.tbody("", *(row(cells, code) for cells in body))
    return nodes.table("", group, classes=["words" if code else "results"])


def setup(app):
    app.add_directive("results", Results)
    return {"parallel_read_safe": True}
