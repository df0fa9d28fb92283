# SPDX-License-Identifier: GPL-2.0-or-later
"""The directive {plot}: a figure straight from the repository's tables, drawn when the site is built.

    ```{plot} findings/lift_speed/repose_lift.runs.csv
    :x: lift speed [mm/s] = 1000 lift_speed_m_s
    :y: angle [deg] = angle_deg ± angle_u_deg
    :where: base = rough
    :each: fill
    :log: x
    :zero: y
    ```

A dot a row, and a line through the means of the dots at one x, which `:dots:` leaves out. Several columns of `y`, divided by
`;`, are a series each, as is every value of the column `each`. A value is LABEL = [FACTOR] COLUMN, with ± COLUMN or
(COLUMN, COLUMN) for its standard uncertainty or interval (± alone: the u that {results} would take), and `if COLUMN=PATTERN` for some of the rows; a column of
columns.csv needs neither label nor factor. `NAME..` is NAME.value (NAME.low95, NAME.high95), as answers have it. `where`, and
`list`, a list in JSON files, are as in {results}. Several files are LABEL = FILE, divided by `;`: a series each.
`log` and `zero` name the axes that are logarithmic and that begin at 0. `:line:` LABEL = X draws the straight line through the
dots down to X, with its standard uncertainty. With

    :rows: <file>, <strength>

each row has a line of the figure under these words: `x` holds its values, `y` the words of their axis. Then `:mark:`
LABEL = VALUE ± U draws a band; `trends.0.exponent ± trends.0.u of FILE` reads it in a JSON file. `:within:` LOW HIGH cuts
off what is farther out. `:title:` stands above a figure of several y. Words and lines take the colour of the page's text. The
legend stands above the figure, where it meets nothing. Below it the numbers are folded, unless there are more than forty lines
of them or the page says `:bare:`.
"""
import io
import math
import re
import statistics

from docutils import nodes
from docutils.parsers.rst import directives
from from_code import FromFile
from results import ROOT, files_named, folded, known_columns, matching, own_u, placed, rows_of, table
from tools import files, pictures, straight_line

INK = "#010203"  # stands for the page's own colour
COLOURS = ("#3b7dc4", "#e08a1e", "#3f9b4f", "#c4517a", "#8a6bc0")
MARKS = "oDs^v"
HEAD = 0.35  # height of the words above a figure's lines
LOOK = {
    "svg.fonttype": "none",
    "svg.hashsalt": "vielto",
    "font.size": 11,
    **dict.fromkeys(("text.color", "axes.labelcolor", "axes.edgecolor", "xtick.color", "ytick.color"), INK),
}
VALUE = re.compile(r"(?:([-+.\deE]+) )?(.+?)(?:( ±)(?: (?!if )(\S+))?| \((\S+), (\S+)\))?(?: if (\w+)=(\S+))?")


class Value:
    """One `LABEL = [FACTOR] COLUMN ± COLUMN`: its label, and the number and interval of a row."""

    def __init__(self, what):
        label, _, words = re.sub(r"(\S+)\.\.(?=\s|$)", r"\1.value (\1.low95, \1.high95)", what).rpartition(" = ")
        factor, self.column, self.has_u, self.u, self.low, self.high, self.where, self.pattern = VALUE.fullmatch(
            words.strip()
        ).groups()
        known = known_columns().get(self.column)
        if not label and not known:
            raise ValueError(f"'{what.strip()}' has no label and is not in columns.csv")
        self.label = label.strip() or known["label"]
        self.factor = float(factor or (not label and known["factor"]) or 1)
        self.form = (not label and known["format"]) or ".3g"

    def of(self, row):
        """(value, low, high); None if the cell is empty or the row is another's."""
        if not row[self.column] or (self.where and not re.fullmatch(self.pattern, row.get(self.where, ""))):
            return None
        value = self.factor * float(row[self.column])
        if self.has_u:
            u = self.factor * float(row[self.u or own_u(self.column, row)])
            return value, value - u, value + u
        if self.low:
            return value, self.factor * float(row[self.low]), self.factor * float(row[self.high])
        return value, value, value


def series_of(rows, x, ys, each):
    """[(label, [(x, value)])]; with several values of `each` the label is the value."""
    found = {}
    for y in ys:
        for row in rows:
            at, value = (x.of(row) or [None])[0], y.of(row)
            if at is not None and value is not None:
                key = row[each] if each == "file" else f"{each} {row[each]}" if each else y.label
                found.setdefault(key, []).append((at, value))
    return list(found.items())


def lines_of(rows, ys, template):
    """The words of the figure's lines, and [(label, [(line, value)])]."""
    words = [re.sub(r"<(\w+)>", lambda name: row[name[1]], template).strip() for row in rows]
    places = list(dict.fromkeys(words))
    series = [(y.label, [(places.index(w), y.of(r)) for w, r in zip(words, rows) if y.of(r)]) for y in ys]
    return places, series


def spans(points, axis):
    """Values and lengths to both sides, for an error bar; nothing where no value has an interval."""
    middle = [value for _, (value, _, _) in points]
    # rounding may put the end of an interval of no length beyond its value
    away = [
        [max(value - low, 0) for _, (value, low, _) in points],
        [max(high - value, 0) for _, (value, _, high) in points],
    ]
    return middle, {f"{axis}err": away} if any(map(any, away)) else {}


def drawn(size, draw):
    """The SVG of what `draw` puts on the axes."""
    pyplot = pictures.pyplot()
    with pyplot.rc_context(LOOK):
        figure, axes = pyplot.subplots(figsize=size, layout="constrained")
        draw(axes)
        axes.spines[["top", "right"]].set_visible(False)
        out = io.StringIO()
        figure.savefig(out, format="svg", transparent=True, metadata={"Date": None})
        pyplot.close(figure)
    svg = out.getvalue()
    return svg[svg.index("<svg") :].replace(INK, "currentColor")


def numbers_on(axis, at):
    """A logarithmic axis with these numbers, whole words instead of powers."""
    axis.set_ticks(at, [f"{p:g}" for p in at], minor=False)
    axis.set_ticks([], minor=True)


def legend_above(axes, height):
    """The legend in rows of its own at the top of a figure that is as much higher."""
    handles, labels = axes.get_legend_handles_labels()
    columns = max(1, min(3, int(48 / (max(map(len, labels)) + 5))))
    room = HEAD * math.ceil(len(labels) / columns)
    axes.figure.set_figheight(height + room)
    axes.figure.legend(handles, labels, frameon=False, loc="upper right", ncols=columns)
    axes.figure.get_layout_engine().set(rect=(0, 0, 1, 1 - room / (height + room)))


def draw_straight(axes, points, label, end):
    """The line through the dots, every dot of the same weight, from `end` to the last, with its standard uncertainty."""
    a, b, covariance, chi2 = straight_line.fit([(x, value, 1.0) for x, (value, _, _) in points])
    aa, ab, bb = (chi2 * c for c in covariance)
    last = max(x for x, _ in points)
    at = [end + (last - end) * k / 50 for k in range(51)]
    middle = [a + b * x for x in at]
    u = [math.sqrt(aa + 2 * ab * x + bb * x * x) for x in at]
    axes.plot(at, middle, color=COLOURS[1], linewidth=1.2, label="line and its u")
    axes.fill_between(at, *([m + s * v for m, v in zip(middle, u)] for s in (-1, 1)), color=COLOURS[1], alpha=0.25)
    axes.axvline(end, color=COLOURS[3], linewidth=1.2, linestyle=":", label=label)


def draw(series, x, y, log="", zero="", dots=False, line=None):
    height = 3.2

    def on(axes):
        for k, (name, points) in enumerate(series):
            colour = COLOURS[k % len(COLOURS)]
            middle, bars = spans(points, "y")
            axes.errorbar(
                [px for px, _ in points],
                middle,
                fmt=MARKS[k % len(MARKS)],
                markersize=5,
                alpha=0.75,
                color=colour,
                label="a run" if line else name,
                **bars,
            )
            at = sorted({px for px, _ in points})
            means = [statistics.fmean(value for px, (value, _, _) in points if px == p) for p in at]
            if not dots and not line:
                axes.plot(at, means, linewidth=1.2, color=colour)
        if line:
            draw_straight(axes, series[0][1], *line)
        axes.set_xlabel(x)
        axes.set_title(y, loc="left", fontsize=11)
        if "x" in log:
            axes.set_xscale("log")
            at = sorted({px for _, points in series for px, _ in points})
            if len(at) > 8:
                at = [k * 10.0**e for e in range(-6, 9) for k in (1, 2, 5) if at[0] <= k * 10.0**e <= at[-1]]
            numbers_on(axes.xaxis, at)
        if "y" in log:
            axes.set_yscale("log")
        if "x" in zero:
            axes.set_xlim(left=0)
        if "y" in zero:
            axes.set_ylim(bottom=0)
        axes.grid(color="#888888", alpha=0.3, linewidth=0.7)
        if len(series) > 1 or line:
            legend_above(axes, height)

    return drawn((5.2, height), on)


def draw_lines(places, series, x, log="", zero="", mark=None, ticks=None, within=None):
    """A line of the figure for each of the places, from top to bottom."""

    def on(axes):
        apart = 0.5 / max(len(series), 2)
        for k, (name, points) in enumerate(series):
            middle, bars = spans(points, "x")
            at = [-line - apart * (k - (len(series) - 1) / 2) for line, _ in points]
            colour = COLOURS[k % len(COLOURS)]
            label = name if len(series) > 1 else ""
            axes.errorbar(middle, at, fmt=MARKS[k % len(MARKS)], markersize=5, color=colour, label=label, **bars)
        axes.set_yticks([-k for k in range(len(places))], places)
        axes.set_ylim(-len(places) + 0.4, 0.6)
        axes.set_xlabel(x)
        if "x" in log:
            axes.set_xscale("log")
            if ticks:
                numbers_on(axes.xaxis, ticks)
        if "x" in zero:
            axes.set_xlim(left=0)
        if within:
            axes.set_xlim(*within)
        if mark:
            label, value, u = mark
            axes.axvline(value, color="#c4517a", linewidth=1.2, label=label)
            axes.axvspan(value - u, value + u, color="#c4517a", alpha=0.2, linewidth=0)
        axes.grid(axis="x", color="#888888", alpha=0.3, linewidth=0.7)
        axes.tick_params(axis="y", length=0)
        if len(series) > 1 or mark:
            legend_above(axes, height)

    height = 0.6 + 0.3 * len(places)
    return drawn((5.6, height), on)


def figure(svg, words):
    return nodes.raw("", f'<figure class="plot" role="img" aria-label="{words}">{svg}</figure>', format="html")


def written(values, form=".3g"):
    """One cell: the mean of the dots, with the one dot's own uncertainty or what several scatter by."""
    middle = statistics.fmean(value for value, _, _ in values)

    def word(number, form=form):
        return format(number, ".0f" if form.endswith("g") and abs(number) >= 1000 else form).replace("-", "−")

    if len(values) > 1:
        return f"{word(middle)}\u00a0±\u00a0{word(statistics.stdev([v for v, _, _ in values]) / len(values) ** 0.5, '.2g')}"
    _, low, high = values[0]
    if low == high:
        return word(middle)
    if math.isclose(high - middle, middle - low, rel_tol=1e-6):
        return f"{word(middle)}\u00a0±\u00a0{word(high - middle, '.2g')}"
    return f"{word(middle)}\u00a0[{word(low)},\u00a0{word(high)}]"


def numbers(head, places, series, forms):
    """What is drawn as a folded table: a row a place on the axis, a column a series."""
    body = []
    for at, name in places:
        cells = [[value for place, value in points if place == at] for _, points in series]
        many = max(map(len, cells))
        body.append([name, str(many), *(written(c, form) if c else "–" for c, form in zip(cells, forms))])
    if all(row[1] == "1" for row in body):  # no place has several runs
        head, body = [head[0], *head[2:]], [[row[0], *row[2:]] for row in body]
    return folded("The numbers", [table(head, body)]) if len(body) <= 40 else []


def at_path(content, path):
    for key in path.split("."):
        content = content[int(key) if isinstance(content, list) else key]
    return content


def mark_of(text, find=lambda path: ROOT / path):
    """(label, value, u) of LABEL = VALUE ± U [of FILE]."""
    label, value, u, _, path = re.fullmatch(r"(.+?) = (\S+)(?: ± (\S+))?( of (\S+))?", text).groups()
    if path:
        content = files.read_json(find(path), "name a result of the repository")
        return label, at_path(content, value), at_path(content, u) if u else 0
    return label, float(value), float(u or 0)


class Plot(FromFile):
    final_argument_whitespace = True
    option_spec = {
        **dict.fromkeys(
            ("x", "y", "title", "where", "each", "log", "zero", "rows", "list", "mark", "line", "within"),
            directives.unchanged_required,
        ),
        "dots": directives.flag,
        "bare": directives.flag,
    }

    def read(self):
        """Rows of all files; of several, each with its label as `file`."""
        rows = []
        for label, path in files_named(self.arguments[0]):
            rows += [{**row, "file": label} for row in rows_of(placed(self, path), self.options.get("list"))]
        return matching(rows, self.options.get("where", ""))

    def run(self):
        options = self.options
        try:
            rows = self.read()
            if "rows" in options:
                values = [Value(part) for part in options["x"].split(";")]
                places, series = lines_of(rows, values, options["rows"])
                x = options.get("y") or (values[0].label if len(values) == 1 else "")
                mark = mark_of(options["mark"], lambda path: placed(self, path)) if "mark" in options else None
                within = [float(word) for word in options["within"].split()] if "within" in options else None
                log, zero = options.get("log", ""), options.get("zero", "")
                svg = draw_lines(places, series, x, log, zero, mark, within=within)
                words = f"{x or ', '.join(v.label for v in values)} of {', '.join(places)}"
                forms, at = [v.form for v in values], list(enumerate(places))
                heads = ["", "runs", *(name for name, _ in series)]
            else:
                x, ys = Value(options["x"]), [Value(part) for part in options["y"].split(";")]
                each = options.get("each") or ("file" if rows and rows[0]["file"] and len(ys) == 1 else None)
                series = series_of(rows, x, ys, each)
                y = ys[0].label if len(ys) == 1 else options.get("title", "")
                line = mark_of(options["line"])[:2] if "line" in options else None
                svg = draw(series, x.label, y, options.get("log", ""), options.get("zero", ""), "dots" in options, line)
                words = f"{', '.join(v.label for v in ys)} over {x.label}"
                forms = [v.form for v in ys] if len(ys) > 1 and not each else [ys[0].form] * len(series)
                at = [(p, written([(p, p, p)], x.form)) for p in sorted({p for _, points in series for p, _ in points})]
                heads = [x.label, "runs", *((name for name, _ in series) if len(series) > 1 else [y])]
            if not rows or not any(points for _, points in series):
                raise self.error(f"{self.arguments[0]}: no row is left under `where`")
        except (OSError, KeyError, ValueError, AttributeError) as fault:
            raise self.error(f"{self.arguments[0]}: {fault!r}") from fault
        return [figure(svg, words), *([] if "bare" in options else numbers(heads, at, series, forms))]


def setup(app):
    app.add_directive("plot", Plot)
    return {"parallel_read_safe": True}
