# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/table through its command line: the rows that are kept and changed, the others byte for byte, bad choices."""
import pathlib
import subprocess
import tempfile

TABLE = pathlib.Path(__file__).resolve().parents[2] / "scripts/table"
TEXT = 'test,role,note\na1,fit,"x, y"\na2,check,\nb1,bench,z\n'


def table(*words):
    return subprocess.run([TABLE, *words], capture_output=True, text=True)


with tempfile.TemporaryDirectory(prefix="vielto-table-") as name:
    folder = pathlib.Path(name)
    source, out = folder / "in.csv", folder / "out.csv"
    source.write_text(TEXT)
    lines = TEXT.splitlines(True)
    for words, kept in (
        (["--where", "role=fit|bench"], [0, 1, 3]),
        (["--without", "role=bench"], [0, 1, 2]),
        (["--where", "test=a.", "--without", "role=fit", "--without", "role=bench"], [0, 2]),
        (["--where", "test=a"], None),  # the whole cell
        (["--where", "role=.*"], [0, 1, 2, 3]),
    ):
        out.unlink(missing_ok=True)
        done = table("select", source, *words, "--out", out)
        if kept is None:
            assert done.returncode == 2 and "no row of 3 is chosen" in done.stderr and not out.exists(), done
        else:
            assert done.returncode == 0 and out.read_text() == "".join(lines[k] for k in kept), (words, done)

    done = table("change", source, "--where", "test=a.", "--set", "role=fit")
    assert done.returncode == 0 and source.read_text() == TEXT.replace("a2,check", "a2,fit"), done
    done = table("select", source, "--without", "test=a1", "--out", source)
    assert done.returncode == 0 and source.read_text() == "test,role,note\na2,fit,\nb1,bench,z\n", done

    before = source.read_text()
    for words, fault in (
        (["select", source, "--where", "roll=fit", "--out", out], ":1: has no column roll; "),
        (["select", source, "--where", "fit", "--out", out], "fit: is no COLUMN=PATTERN"),
        (["select", source, "--where", "role=(", "--out", out], "role=(: is no COLUMN=PATTERN"),
        (["select", folder / "none.csv", "--where", "role=fit", "--out", out], "No such file"),
        (["select", source, "--where", "role=fit", "--out", folder / "none/out.csv"], "cannot be written"),
        (["change", source, "--where", "role=fit", "--set", "role"], "--set role: is no COLUMN=VALUE"),
        (["change", source, "--set", "colour=red"], "has no column colour"),
        (["change", source, "--where", "role=x", "--set", "role=fit"], "no row of 2 is chosen"),
    ):
        bad = table(*words)
        assert bad.returncode == 2 and fault in bad.stderr and bad.stderr.count("\n") == 1, bad
    assert source.read_text() == before and sorted(p.name for p in folder.iterdir()) == ["in.csv", "out.csv"]
