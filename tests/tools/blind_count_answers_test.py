# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/blind count-answers through its command line: cases counted by hand, and missing answers."""
import json
import pathlib
import subprocess
import tempfile

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / "scripts/blind"

with tempfile.TemporaryDirectory(prefix="vielto-verdicts-") as name:
    truths, answers, table = (pathlib.Path(name) / n for n in ("truth", "answers", "verdicts.csv"))
    truths.mkdir()

    def told():
        words = ["count-answers", truths, answers, "--out", table]
        return subprocess.run([PROGRAM, *words], capture_output=True, text=True)

    assert told().returncode == 2 and "holds no truth" in told().stderr, told()
    for case, effects, verdict, named, group in (
        ("0001", [], "no_gap", [], []),
        ("0002", ["b"], "named", ["b"], []),
        ("0003", ["b"], "ambiguous", [], ["c", "b"]),
        ("0004", ["b"], "ambiguous", [], ["b", "c"]),
    ):
        truth = dict(
            case=case,
            kind="known" if effects else "none",
            level="strong" if effects else "",
            effects=dict.fromkeys(effects, {}),
        )
        (truths / f"{case}.json").write_text(json.dumps(truth))
        if case == "0004":
            missing = told()
        (answers / case).mkdir(parents=True)
        (answers / case / "diagnosis.json").write_text(json.dumps(dict(verdict=verdict, named=named, group=group)))
    assert (
        missing.returncode == 2 and "0004/diagnosis.json" in missing.stderr and missing.stderr.count("\n") == 1
    ), missing
    assert not table.exists()
    assert told().returncode == 0 and table.read_text() == (
        "kind,effect,strength,answer,cases\nknown,b,strong,ambiguous b c,2\nknown,b,strong,named b,1\nnone,,,no_gap,1\n"
    ), told()
