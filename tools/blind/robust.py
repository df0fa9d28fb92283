# SPDX-License-Identifier: GPL-2.0-or-later
"""How an answer changes when what it takes as given is wrong, as a table, with `vielto` on the PATH.

  scripts/blind robust --library LIBRARY --out ROBUST.csv TABLE [OPTIONS of vielto gap diagnose]

One row a change: prior probability of every cause times 0.5 and 2.5, half of the effects' and members' runs, u 1.5 times too
large and too small, the first row off by eight u, each row missing, rows of an observable that share all their error, the
scatter of runs understated by 3. An answer that crashes or holds a number that is not finite makes the program fail; a refusal
stands in the table.
"""
import argparse
import json
import pathlib
import re
import shutil
import subprocess
import tempfile

from tools import tables
from tools.errors import BadInput, RunFailed

COLUMNS = ["change", "verdict", "named", "best", "best_probability", "no_gap", "unknown", "said"]
SHARED = ["test_a", "observable_a", "test_b", "observable_b", "covariance"]


def add_options(parser):
    parser.add_argument("table", type=pathlib.Path)
    parser.add_argument("--library", type=pathlib.Path, required=True)
    parser.add_argument("--out", type=pathlib.Path, required=True, metavar="ROBUST.csv")
    parser.add_argument("options", nargs=argparse.REMAINDER, help="of vielto gap diagnose")


def work(options):
    table = tables.read(options.table, ["test", "role", "observable", "value", "u"], "take an observation table")
    if not any(row["role"] == "fit" for row in table):
        raise BadInput(f"{options.table}: holds no row of role fit; a diagnosis rests on fit rows")
    with tempfile.TemporaryDirectory(prefix="vielto-robust-") as name:
        case = Case(options, table, pathlib.Path(name))
        answers = []
        for change, how in changes(case, table):
            answers.append({"change": change, **case.answer(**how)})
            if answers[0]["verdict"] == "refused":
                said = answers[0]["said"].removeprefix("vielto: ")
                raise BadInput(said.replace(str(case.folder / "table.csv"), str(options.table)))
    tables.write(options.out, COLUMNS, answers)
    first = answers[0]
    same = sum((a["verdict"], a.get("named")) == (first["verdict"], first.get("named")) for a in answers[1:])
    print(f"{first['verdict']} {first['named']}".strip() + f"; {same} of {len(answers) - 1} changes leave it so")


def changes(case, table):
    yield "as stated", {}
    yield "prior of causes x0.5", {"files": case.with_prior(0.5)}
    yield "prior of causes x2.5", {"files": case.with_prior(2.5)}
    yield "half of the runs", {"files": case.with_half_the_runs()}
    yield "u x1.5", {"rows": [scaled(row, 1.5) for row in table]}
    yield "u /1.5", {"rows": [scaled(row, 1 / 1.5) for row in table]}
    fit = [k for k, row in enumerate(table) if row["role"] == "fit"]
    off = {**table[fit[0]], "value": f"{table[fit[0]].number('value') + 8 * table[fit[0]].number('u'):.9g}"}
    yield f"outlier {label(table[fit[0]])}", {"rows": [off if k == fit[0] else row for k, row in enumerate(table)]}
    for k in fit if len(fit) > 1 else ():
        yield f"without {label(table[k])}", {"rows": [row for i, row in enumerate(table) if i != k]}
    yield "errors all shared", {"shared": True}
    yield "scatter /3", {"more": ["--runs-per-observation", "9"]}


def label(row):
    return f"{row['test']} {row['observable']}"


def scaled(row, factor):
    return {**row, "u": f"{factor * row.number('u'):.9g}"}


class Case:
    def __init__(self, options, table, folder):
        self.options, self.table, self.folder = options, table, folder
        self.here = options.library.resolve().parent
        self.covariance = options.table.with_suffix(".covariance.csv")

    def with_prior(self, factor):
        """Options for settings in which every cause is so much more probable before the data."""
        text = (self.here / "diagnosis.toml").read_text(encoding="utf-8")
        prior = {k: float(v) for k, v in re.findall(r"^(no_gap|single|pair|unknown) = ([0-9.]+)", text, re.M)}
        for kind in ("single", "pair"):
            prior[kind] *= factor
        total = sum(prior.values())
        for kind, value in prior.items():
            text = re.sub(rf"^{kind} = [0-9.]+", f"{kind} = {value / total:.12g}", text, count=1, flags=re.M)
        path = self.folder / f"settings{factor}" / "diagnosis.toml"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
        shutil.copy(self.here / "next_tests.toml", path.parent)  # they are looked for beside the settings
        return ["--library", self.options.library, "--effects", self.here / "effects", "--settings", path]

    def with_half_the_runs(self):
        """Options for a library without every other run of each effect's and of the members'; the baseline keeps its seeds."""
        half = self.here / f"half_{self.folder.name}"  # beside the library: its inputs are told by their way from it
        shutil.copytree(self.options.library, half)
        self.half = half
        design = tables.read(half / "design.csv", ["test", "effect", "strength"], "take a library")
        parameters = design.header[5:]
        plain = [tuple(row[p] for p in parameters) for row in design if row["effect"] == "none"]
        own = max(set(plain), key=plain.count)
        seen, gone = {}, set()
        for row in design:
            if row["effect"] == "none" and tuple(row[p] for p in parameters) == own:
                continue
            kind = (row["effect"], row["test"].split("_")[0])
            seen[kind] = seen.get(kind, -1) + 1
            if seen[kind] % 2:
                gone.add(row["test"])
        for path in half.glob("*.csv"):
            rows = tables.read(path, [], "take a library", may_be_empty=True)
            if rows.header[:1] == ["test"]:
                tables.write(path, rows.header, [row for row in rows if row["test"] not in gone])
        return ["--library", half, "--effects", self.here / "effects", "--settings", self.here / "diagnosis.toml"]

    def answer(self, files=None, rows=None, shared=False, more=()):
        table, out = self.folder / "table.csv", self.folder / "answer"
        shutil.rmtree(out, ignore_errors=True)
        rows = rows or self.table
        tables.write(table, self.table.header, rows)
        beside = table.with_suffix(".covariance.csv")
        beside.unlink(missing_ok=True)
        if shared:
            tables.write(beside, SHARED, list(all_shared(rows)))
        elif self.covariance.exists():
            kept = {(row["test"], row["observable"]) for row in rows}
            old = tables.read(self.covariance, SHARED, "take the table's shared errors", may_be_empty=True)
            tables.write(
                beside,
                SHARED,
                [r for r in old if {(r["test_a"], r["observable_a"]), (r["test_b"], r["observable_b"])} <= kept],
            )
        words = ["vielto", "gap", "diagnose", table, *(files or ["--library", self.options.library])]
        try:
            done = subprocess.run([*words, *self.options.options, *more, "--out", out], capture_output=True, text=True)
        finally:
            if hasattr(self, "half"):
                shutil.rmtree(self.half)
                del self.half
        if done.returncode == 2:
            return {"verdict": "refused", "said": done.stderr.strip()}
        if done.returncode:
            raise RunFailed(f"{' '.join(map(str, words))}: ended with {done.returncode}: {done.stderr.strip()}")
        try:
            d = json.loads((out / "diagnosis.json").read_text(encoding="utf-8"), parse_constant=not_finite)
        except ValueError as e:
            raise RunFailed(f"{' '.join(map(str, words))}: {e}")
        p = d["probabilities"]
        if any(value is None for value in p.values()):
            raise RunFailed(f"{' '.join(map(str, words))}: a probability is not finite")
        best = max(p, key=p.get)
        shown = {"best_probability": p[best], "no_gap": p["no_gap"], "unknown": p["unknown"]}
        return {
            "verdict": d["verdict"],
            "named": " ".join(d["named"] or d["group"]),
            "best": best,
            **{k: f"{v:.3f}" for k, v in shown.items()},
            "said": "",
        }


def not_finite(text):
    raise ValueError(f"holds {text}")


def all_shared(rows):
    for i, a in enumerate(rows):
        for b in rows[:i]:
            if a["observable"] == b["observable"] and a["apparatus"] == b["apparatus"]:
                covariance = a.number("u") * b.number("u")
                yield dict(zip(SHARED, (a["test"], a["observable"], b["test"], b["observable"], f"{covariance:.12g}")))
