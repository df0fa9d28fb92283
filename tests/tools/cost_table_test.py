# SPDX-License-Identifier: GPL-2.0-or-later
"""scripts/cost-table: rows that are there are not run again, a table of another kind is refused; a row from a record made by
hand. The runs themselves are those of every other test of the mixer."""
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
from tools import cost_table  # noqa: E402


def cost(out):
    return subprocess.run([ROOT / "scripts/cost-table", "--out", out], capture_output=True, text=True)


with tempfile.TemporaryDirectory(prefix="vielto-cost-") as name:
    table, record = pathlib.Path(name, "cost.csv"), pathlib.Path(name, "torque.csv")
    whole = (ROOT / "doc/reference/cost.csv").read_text()
    table.write_text(whole)
    done = cost(table)
    assert (done.returncode, done.stdout, table.read_text()) == (0, "", whole), done

    table.write_text("run,rig\na,mixer\n")
    bad = cost(table)
    assert bad.returncode == 2 and ":1: has no column grain_diameter_m" in bad.stderr, bad
    assert bad.stderr.count("\n") == 1, bad

    record.write_text(
        "# schema=1\n# steps_per_turn=400\nstep,grains,overlap_mean,overlap_max\n10,50,0.001,0.02\n20,50,0.003,0.01\n"
    )
    # a quarter of a turn in 2 s: 8 s a turn, 50 grains by 100 steps in 2 s
    row = cost_table.row_of(("0.01", "1e6", "0.05"), record, 2.0)
    assert list(row.values()) == ["0.01", "1e6", "0.05", 50, 400, "8.0", "2.5e+03", "0.002", "0.02"], row
    record.write_text("# steps_per_turn=400\nstep,grains,overlap_mean,overlap_max\n")
    try:
        cost_table.row_of(("0.01", "1e6", "0.05"), record, 2.0)
    except cost_table.tables.BadInput as e:
        assert "holds no row" in str(e), e
    else:
        raise AssertionError("an empty record makes a row")
