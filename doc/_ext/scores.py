# SPDX-License-Identifier: GPL-2.0-or-later
"""The directive {scores}: the marks of a blind check as figure and, folded, as table, with their 95 % intervals.

    ```{scores}
    with bench rows = score.json; without = score_without_bench.json
    ```

A column for each file. Shares of cases are drawn, of the first three files; a mark that no file has is left out.

The directive {answers}: what diagnoses said, a column an answer: verdict, no gap, a gap without a name, and every effect that holds
5 % in one of them. Files as in {values}:

    ```{answers} against the reference
    ./{X1,X2}/with_reference/diagnosis.json
    ```

The directive {ratios} bench/results.json bench/ratios.csv: the ratios of a bench with the meaning of each. Those with a name
under `drawn` are drawn as how many times as fast we are, turned round where `turned` says that the ratio is one of times.
"""
from docutils.parsers.rst import Directive
from plot import draw_lines, figure
from results import files_named, folded, placed, table
from tools import files, tables

SHARES = {
    "false_alarm": "false alarms",
    "wrong_name": "wrong names",
    "removed_named": "taken out, another named",
    "right": "right",
    "in_group": "right or in its group",
    "unknown_found": "unknown cause found",
    "coverage90": "in the 90 % interval",
    "where_f1": "F1 of the regions",
}
OTHERS = {
    "closure": "closure",
    "closure_true_effect": "closed by the true effect itself",
    "placebo": "closure by a placebo",
    "brier": "Brier score",
}


def number(value):
    return f"{value + 0.0:.2f}".replace("-0.00", "0.00").replace("-", "−")


def cell(content, score):
    if content.get(score) is None:
        return "–"
    interval = ",\u00a0".join(number(content[f"{score}_{end}"]) for end in ("low95", "high95"))
    return f"{number(content[score])} [{interval}] of\u00a0{content[f'{score}_n']}"


class Scores(Directive):
    has_content = True

    def run(self):
        columns = files_named(" ".join(self.content))
        contents = []
        for _, name in columns:
            path = placed(self, name)
            try:
                contents.append(files.read_json(path, "name a score of the repository"))
            except (OSError, ValueError) as fault:
                raise self.error(f"{path}: {fault!r}") from fault
        there = [s for s in {**SHARES, **OTHERS} if any(c.get(s) is not None for c in contents)]
        if not there:
            raise self.error("no file has a mark")
        body = [[{**SHARES, **OTHERS}[s], *(cell(c, s) for c in contents)] for s in there]
        shares = [s for s in there if s in SHARES]
        series = [
            (
                label,
                [
                    (k, tuple(content[f"{s}{end}"] for end in ("", "_low95", "_high95")))
                    for k, s in enumerate(shares)
                    if content.get(s) is not None
                ],
            )
            for (label, _), content in list(zip(columns, contents))[:3]
        ]
        words = "share of the cases, 95 % interval"
        svg = draw_lines([SHARES[s] for s in shares], series, words)
        head = ["mark [95\u00a0% interval] of cases", *(label for label, _ in columns)]
        return [figure(svg, words), *folded("The marks as numbers", [table(head, body)])]


def rows_of_answers(answers):
    """Verdict, and every probability that is 5 % in one of the answers; no gap and unknown first."""
    told = [answer["probabilities"] for answer in answers]
    names = sorted({n for p in told for n, share in p.items() if share >= 0.05} - {"no_gap", "unknown"})
    rows = [["answer", *(a["verdict"].replace("_", " ") for a in answers)]]
    for name, label in [("no_gap", "no gap"), ("unknown", "no name"), *((n, n.replace("_", " ")) for n in names)]:
        rows.append([label, *(f"{p[name]:.0%}".replace("%", "\u00a0%") if name in p else "–" for p in told)])
    return rows


class Answers(Directive):
    required_arguments = 1
    final_argument_whitespace = True
    has_content = True

    def run(self):
        columns = files_named(" ".join(self.content))
        answers = []
        for _, path in columns:
            try:
                answers.append(files.read_json(placed(self, path), "name an answer of the repository"))
            except (OSError, ValueError) as fault:
                raise self.error(f"{path}: {fault!r}") from fault
        return [table([self.arguments[0], *(label for label, _ in columns)], rows_of_answers(answers))]


class Ratios(Directive):
    required_arguments = 2

    def run(self):
        results, meanings = (placed(self, path) for path in self.arguments)
        measured = files.read_json(results, "make it with bench/run")
        body, places, points = [], [], []
        for row in tables.read(meanings, ["key", "drawn", "turned", "meaning"], "bring it back"):
            spread = measured[row["key"]]
            median, low, high = (spread[name] for name in ("median", "low", "high"))
            body.append([row["meaning"], f"{median:.2f}", f"{low:.2f} … {high:.2f}"])
            if row["drawn"]:
                turned = (1 / median, 1 / high, 1 / low)
                points.append((len(places), turned if row["turned"] else (median, low, high)))
                places.append(row["drawn"])
        words = "times as fast (log scale)"
        svg = draw_lines(places, [("", points)], words, log="x", mark=("as fast", 1, 0), ticks=[1, 2, 3, 5, 7])
        return [figure(svg, words), table(["ratio", "median", "95 % interval"], body)]


def setup(app):
    app.add_directive("scores", Scores)
    app.add_directive("ratios", Ratios)
    app.add_directive("answers", Answers)
    return {"parallel_read_safe": True}
