# SPDX-License-Identifier: GPL-2.0-or-later
"""The directive {plot}: a figure straight from one of the repository's CSV tables, drawn when the site is built.

    ```{plot} findings/lift_speed/repose_lift.runs.csv
    :x: lift speed [mm/s] = 1000 lift_speed_m_s
    :y: angle [deg] = angle_deg
    :where: base = rough
    :each: fill
    :log: x
    :zero: y
    ```

A dot a row, and a line through the means of the dots at one x. Several columns of `y`, divided by `;`, are a series each, as is
every value of the column `each`. `x`, `y` and `where` are written as in {results}; `log` and `zero` name the axes that are
logarithmic and that begin at 0. Words and lines take the colour of the page's text.
"""
import io
import re
import statistics

from docutils import nodes
from docutils.parsers.rst import directives
from from_code import FromFile
from results import matching, rows_of
from tools import pictures

INK = "#010203"  # stands for the page's own colour
COLOURS = ("#3b7dc4", "#e08a1e", "#3f9b4f", "#c4517a", "#8a6bc0")
LOOK = {
    "svg.fonttype": "none",
    "svg.hashsalt": "vielto",
    "font.size": 11,
    **dict.fromkeys(("text.color", "axes.labelcolor", "axes.edgecolor", "xtick.color", "ytick.color"), INK),
}


def column(what):
    """(label, factor, column) of LABEL = [FACTOR] COLUMN."""
    label, words = (part.strip() for part in what.split("=", 1))
    factor, name = re.fullmatch(r"(?:([-+.\de]+) )?(.+)", words).groups()
    return label, float(factor or 1), name


def series_of(rows, x, ys, each):
    """[(label, [(x, y)])]; with several values of `each` the label is the value."""
    found = {}
    for label, factor, name in ys:
        for row in rows:
            if row[x[2]] and row[name]:
                key = f"{each} {row[each]}" if each else label
                found.setdefault(key, []).append((x[1] * float(row[x[2]]), factor * float(row[name])))
    return list(found.items())


def draw(series, x, y, log, zero):
    pyplot = pictures.pyplot()
    with pyplot.rc_context(LOOK):
        figure, axes = pyplot.subplots(figsize=(5.2, 3.2), layout="constrained")
        for k, (name, points) in enumerate(series):
            colour = COLOURS[k % len(COLOURS)]
            axes.plot(*zip(*points), "o", markersize=5, alpha=0.75, color=colour, label=name)
            at = sorted({px for px, _ in points})
            axes.plot(
                at, [statistics.fmean(py for px, py in points if px == p) for p in at], linewidth=1.2, color=colour
            )
        axes.set_xlabel(x)
        axes.set_title(y, loc="left", fontsize=11)
        if "x" in log:
            axes.set_xscale("log")
            at = sorted({px for _, points in series for px, _ in points})
            axes.set_xticks(at, [f"{p:g}" for p in at])
            axes.minorticks_off()
        if "y" in log:
            axes.set_yscale("log")
        if "x" in zero:
            axes.set_xlim(left=0)
        if "y" in zero:
            axes.set_ylim(bottom=0)
        axes.spines[["top", "right"]].set_visible(False)
        axes.grid(color="#888888", alpha=0.3, linewidth=0.7)
        if len(series) > 1:
            axes.legend(frameon=False)
        out = io.StringIO()
        figure.savefig(out, format="svg", transparent=True, metadata={"Date": None})
        pyplot.close(figure)
    svg = out.getvalue()
    return svg[svg.index("<svg") :].replace(INK, "currentColor")


class Plot(FromFile):
    option_spec = {
        "x": directives.unchanged_required,
        "y": directives.unchanged_required,
        "where": directives.unchanged,
        "each": directives.unchanged,
        "log": directives.unchanged,
        "zero": directives.unchanged,
    }

    def run(self):
        try:
            rows = matching(rows_of(self.path()), self.options.get("where", ""))
            x, ys = column(self.options["x"]), [column(part) for part in self.options["y"].split(";")]
            series = series_of(rows, x, ys, self.options.get("each"))
            if not series:
                raise self.error(f"{self.arguments[0]}: no row is left under `where`")
        except (OSError, KeyError, ValueError, AttributeError) as fault:
            raise self.error(f"{self.arguments[0]}: {fault!r}") from fault
        y = ys[0][0] if len(ys) == 1 else ""
        svg = draw(series, x[0], y, self.options.get("log", ""), self.options.get("zero", ""))
        words = f"{', '.join(label for label, *_ in ys)} over {x[0]}"
        return [nodes.raw("", f'<figure class="plot" role="img" aria-label="{words}">{svg}</figure>', format="html")]


def setup(app):
    app.add_directive("plot", Plot)
    return {"parallel_read_safe": True}
