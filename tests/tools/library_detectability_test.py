# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/library detectability through its command line: order, bold, what may be taken for what, a set without a result."""
import json
import pathlib
import subprocess
import tempfile

LIBRARY = pathlib.Path(__file__).resolve().parents[2] / "scripts/library"

with tempfile.TemporaryDirectory(prefix="vielto-detectability-") as name:
    folder = pathlib.Path(name)
    for tests, distances in (("few", {"a": 1.04}), ("all", {"a": 4.2, "b": 9.96})):
        (folder / tests).mkdir()
        groups = {"a": ["a", "b"], "b": ["b"]}
        answer = dict(
            effects=list(distances),
            detectable_distance=4,
            summary={e: dict(from_nothing=d, group=groups[e]) for e, d in distances.items()},
        )
        (folder / tests / "isolability.json").write_text(json.dumps(answer))

    def compare(*sets, out=folder / "table.csv"):
        words = [LIBRARY, "detectability", *sets, "--out", out]
        return subprocess.run(words, capture_output=True, text=True)

    few, every = f"few={folder / 'few'}", f"and more={folder / 'all'}"
    told = compare(few, every)
    assert told.returncode == 0, told.stderr
    # the most detectable first
    assert (folder / "table.csv").read_text() == "effect,few,and more,may be taken for\nb,,10.0,\na,1.0,4.2,b\n"
    assert told.stdout.splitlines()[2:] == ["| `b` | – | **10.0** | – |", "| `a` | 1.0 | **4.2** | `b` |"], told.stdout
    for words, fault in (
        ((few, "none"), "'none' is no NAME=FOLDER"),
        ((few, f"none={folder}"), "isolability.json: No such file or directory; make it with vielto gap isolability"),
    ):
        bad = compare(*words, out=folder / "bad.csv")
        assert bad.returncode == 2 and fault in bad.stderr and not (folder / "bad.csv").exists(), bad
