# SPDX-License-Identifier: GPL-2.0-or-later
"""The directive {results}: a small table on a page, straight from one of the repository's CSV tables.

    ```{results} findings/grain_size/mixer_grain_size.runs.csv
    :where: run = (base|d).*
    :by: grainDiameter
    :show: Grain [mm] = 1000 grainDiameter .3g; Runs = n; Power [W] = power_W .1f; scatter = sd power_W .1f
    ```

A column that stands in columns.csv needs neither label, factor nor format: `speed; max overlap_max; power_W ± power_u_W`;
another has its own name as its label.
Rows whose column matches every `where` (a regular expression for the whole cell; several are divided by `;`) are put
together where their cells of `by` are the same, in the order of their first row or of the numbers of a column `order`; without
`by` each row stands alone. A
column is shown as `LABEL = [mean|sd|u|min|max|n] [FACTOR] COLUMN [FORMAT]`: the mean of the group unless told otherwise,
u the standard deviation over the root of the number of rows; a column of words as it is.
A cell may hold two of them, WHAT ± WHAT; `WHAT ±` has the uncertainty of its own column, which the table calls like it
(`own_u`).
Paths start in the folder of findings/ that is named as the page is, or at the repository's root. Of a JSON file
the list named behind its path is taken, `a.b` for the
keys of an object in it. With

    :across: speed 1/s = relative_gap +.0%

every value of that column, with the unit behind it, is a further column that shows this. `:folded: TITLE` folds the table, without a title as "The numbers".

The directive {values}: the same from JSON files, a row for each template and a column for each file (LABEL = PATH).

    ```{values}
    :files: with bench rows = findings/withheld_drum/score.json; without = findings/withheld_drum/score_without_bench.json
    :rows: closure by simulation = {closure:.2f}
    ```

Files that differ in one word may be written once, `findings/blind_mixer/{X1,X2}/diagnosis.json`; that word is their label.

Names in braces are keys (`a.b` one inside another) of the column's file, in a row's label those of the first file. A
cell whose key is not there or null is a dash. Rows may also stand in the directive's body, a line each.
"""
import functools
import pathlib
import re
import statistics
import string

from docutils import nodes
from docutils.parsers.rst import Directive, directives
from tools import files, tables

ROOT = pathlib.Path(__file__).resolve().parents[2]


FORMAT = re.compile(r"\+?\.\d+[a-z%]")


def spread(values):
    return statistics.stdev(values) if len(values) > 1 else float("nan")


STATISTICS = {
    "mean": statistics.fmean,
    "sd": spread,
    "u": lambda values: spread(values) / len(values) ** 0.5,
    "min": min,
    "max": max,
}


def placed(directive, name):
    """The file of this name in the page's own folder of findings/, or from the repository's root."""
    environment = directive.state.document.settings.env
    own = ROOT / "findings" / environment.docname.rsplit("/", 1)[-1] / name
    path = own if own.exists() else ROOT / name
    environment.note_dependency(str(path))
    return path


@functools.cache
def known_columns():
    """Label, factor and format of the columns that many tables have."""
    path = pathlib.Path(__file__).with_name("columns.csv")
    return {row["column"]: row for row in tables.read(path, ["column", "label", "factor", "format"], "bring it back")}


def column_of(words):
    """The column in `[mean|sd|u|min|max] COLUMN`, without a label."""
    return words.split()[-1]


def own_u(column, row):
    """The column of the standard uncertainty of a column: `power_u_W` of `power_W`, `u_a` of `value_a`, `x_u`, `u_x` or `u`."""
    stem, _, unit = column.rpartition("_")
    for name in (f"{stem}_u_{unit}", f"{column}_u", f"u_{column}", column.replace("value", "u"), f"u_{unit}", "u"):
        if name in row and name != column:
            return name
    raise KeyError(f"u of {column}")


def stated_fully(what):
    """`LABEL = WHAT`; without a label that of columns.csv, with its factor and format, or the column's name."""
    label, _, words = what.strip().rpartition(" = ")
    if label:
        return label, words
    own = words.endswith(" ±")
    parts = words.removesuffix(" ±").split(" ± ")
    known = known_columns().get(column_of(parts[0]))
    if not known:
        *_, column = (word for word in parts[0].split() if not FORMAT.fullmatch(word))
        return column.replace("_", " ").capitalize(), words

    def full(part):
        *statistic, column = part.split()
        return " ".join(filter(None, (*statistic, known["factor"], column, known["format"])))

    return known["label"], "n" if words == "n" else " ± ".join(map(full, parts)) + " ±" * own


def rows_of(path, key=None):
    """The rows of a CSV table, or of the list `key` of a JSON file with `a.b` for nested keys, as words."""
    if not key:
        return tables.read(path, [], "name a table of the repository", may_be_empty=True)

    def flat(value, name=""):
        if not isinstance(value, dict):
            return {name: "" if value is None else str(value)}
        return {k: v for n, inner in value.items() for k, v in flat(inner, f"{name}.{n}".strip(".")).items()}

    return [flat(row) for row in files.read_json(path, "name a result of the repository")[key]]


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
    if what.endswith(" ±"):
        middle = what.removesuffix(" ±")
        column = next(word for word in middle.split() if word in rows[0])
        u = " ".join(own_u(column, rows[0]) if word == column else word.lstrip("+") for word in middle.split())
        what = f"{middle} ± {u}"
    if " ± " in what:
        return "\u00a0±\u00a0".join(shown(rows, part) for part in what.split(" ± "))
    words = what.split()
    if words == ["n"]:
        return str(len(rows))
    named = words[0] in STATISTICS and len(words) > 1 and not words[1].startswith(".")  # else a column of that name
    statistic = STATISTICS[words.pop(0)] if named else statistics.fmean
    factor = float(words.pop(0)) if re.fullmatch(r"[-+.\de]+", words[0]) else 1.0
    form = words.pop() if FORMAT.fullmatch(words[-1]) else ".3g"
    column = " ".join(words)
    cells = [row[column] for row in rows if row[column] != ""]
    try:
        values = [factor * float(cell) for cell in cells]
    except ValueError:
        return ", ".join(dict.fromkeys(cells))
    if not values:
        return "–"
    value = statistic(values)
    return (
        "–"
        if value != value
        else re.sub(r"^-(?=[0.]*%?$)", "", format(value, form)).replace("-", "−").replace("%", "\u00a0%")
    )


class Values(string.Formatter):
    """Fills a template from one JSON file."""

    def __init__(self, content):
        super().__init__()
        self.content = content

    def get_field(self, name, args, kwargs):
        value = self.content
        for key in name.split("."):
            value = value[key]
        if value is None:
            raise KeyError(name)
        return value, name

    def filled(self, template):
        try:
            text = self.format(template)
        except KeyError:
            return "–"
        text = re.sub(r"(?<=\d)%", "\u00a0%", text)
        return re.sub(r"-(?=[\d.])", "−", re.sub(r"-(0(?:\.0+)?)(?![\d.])", r"\1", text))  # no -0.00


def files_named(text):
    """[(label, path)] of `LABEL = PATH; ...`, of one path with the labels in it, or of a path without any."""
    choice = re.fullmatch(r"(.*)\{([^}]+)\}(.*)", text.strip())
    if choice:
        return [(word, f"{choice[1]}{word}{choice[3]}") for word in choice[2].split(",")]
    parts = [file.strip().rpartition(" = ") for file in text.split(";")]
    return [(label.strip(), path.strip()) for label, _, path in parts]


def folded(title, nodes_of_table):
    """What is there for who asks: under its title, closed."""
    if not title:
        return nodes_of_table
    return [
        nodes.raw("", f"<details><summary>{title}</summary>", format="html"),
        *nodes_of_table,
        nodes.raw("", "</details>", format="html"),
    ]


class JsonValues(Directive):
    option_spec = {
        "files": directives.unchanged_required,
        "rows": directives.unchanged,
    }

    has_content = True

    def run(self):
        columns = files_named(self.options["files"])
        contents = []
        for _, path in columns:
            try:
                contents.append(Values(files.read_json(placed(self, path), "name a result of the repository")))
            except (OSError, ValueError) as fault:
                raise self.error(f"{path}: {fault!r}") from fault
        body = []
        rows = [row for row in self.options.get("rows", "").split(";") if row.strip()]
        rows += [line for line in self.content if line.strip()]
        for row in rows:
            label, template = (part.strip() for part in row.split("=", 1))
            cells = [content.filled(template) for content in contents]
            if set(cells) == {"–"}:
                raise self.error(f"{template}: no file holds this")
            body.append([contents[0].filled(label), *cells])
        return [table(["", *(label for label, _ in columns)], body)]


class Results(Directive):
    required_arguments = 1
    optional_arguments = 1
    option_spec = {
        "across": directives.unchanged,
        "order": directives.unchanged,
        "where": directives.unchanged,
        "by": directives.unchanged,
        "show": directives.unchanged_required,
        "folded": lambda title: title or "The numbers",
    }

    def run(self):
        path = placed(self, self.arguments[0])
        try:
            rows = matching(rows_of(path, *self.arguments[1:]), self.options.get("where", ""))
            if not rows:
                raise self.error(f"{path.name}: no row is left under `where`")
            if "order" in self.options:
                rows.sort(key=lambda row: float(row[self.options["order"]]))
            columns = [stated_fully(part) for part in self.options["show"].split(";")]
            by = self.options.get("by", "").split()
            spread_out, across = across_columns(self.options.get("across"), rows)
            cells = [
                [shown(group, what) for _, what in columns] + [across(group, value) for _, value in spread_out]
                for group in groups(rows, by)
            ]
        except (OSError, KeyError, ValueError) as fault:
            raise self.error(f"{self.arguments[0]}: {fault!r}") from fault
        head = [label for label, _ in columns] + [label for label, _ in spread_out]
        return folded(self.options.get("folded"), [table(head, cells)])


def across_columns(option, rows):
    """[(label, value)] of the further columns, and what writes a cell of one."""
    if not option:
        return [], None
    head, what = option.split("=", 1)
    column, *unit = head.split()
    values = list(dict.fromkeys(row[column] for row in rows))
    try:
        values.sort(key=float)
    except ValueError:
        pass  # words stand in the order of the table

    def cell(group, value):
        there = [row for row in group if row[column] == value]
        return shown(there, what) if there else "–"

    return [(" ".join([value, *unit]), value) for value in values], cell


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
    app.add_directive("values", JsonValues)
    return {"parallel_read_safe": True}
