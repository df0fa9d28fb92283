# SPDX-License-Identifier: GPL-2.0-or-later
"""Contact by contact: our laws in liggghts against Yade's own, the two-body cases of contact/cases.json.

Every case runs in both engines at its time step, half and a quarter of it; both are extrapolated to a vanishing step and
compared. Writes contact_check.csv and contact_check.png to --out. Ends with 1 if a case differs by more
than the limit of cases.json without an entry there that explains the difference, or more than that entry allows.
"""
import pathlib
import tempfile

from tools import tables
from tools.errors import RunFailed
from tools.progress import Progress
from tools.yade import DATA, cases
from tools.yade.programs import prepare

LEVELS = 3


def add_options(parser):
    parser.add_argument("--case", action="append", metavar="NAME", help="this case only; may be repeated")
    parser.add_argument("--list", action="store_true", help="name the cases and end")
    parser.add_argument("--cases", type=pathlib.Path, default=DATA / "contact/cases.json", metavar="FILE")
    parser.add_argument("--out", type=pathlib.Path, default=DATA / "results", metavar="FOLDER")
    parser.add_argument(
        "--liggghts", metavar="PROGRAM", help="liggghts with our laws (default: build/bin/liggghts, built anew)"
    )
    parser.add_argument("--yade", default="yade", metavar="PROGRAM")


def run_all(opts, book, chosen):
    from tools.yade import engines  # these need packages that prepare() installs
    from tools.yade.compare import compare

    answer = []
    with tempfile.TemporaryDirectory(prefix="vielto-yade-") as name:
        folder = pathlib.Path(name)
        print(f"{len(chosen)} cases, {LEVELS} time steps each, in Yade ...", flush=True)
        runs = [engines.yade_run(c, folder, book["samples"], k) for c in chosen for k in range(LEVELS)]
        theirs = engines.yade(opts.yade, runs, folder)
        progress = Progress("cases compared", len(chosen))
        for i, case in enumerate(chosen):
            ours = [engines.liggghts(opts.liggghts, case, folder, book["samples"], k) for k in range(LEVELS)]
            rows = compare(ours, theirs[LEVELS * i : LEVELS * (i + 1)])
            differs = case.get("differs", {})
            allowed = differs.get("limit", book["limit"])
            worst = max(r["relative"] for r in rows)
            verdict = "FAILED" if worst > allowed else "explained" if worst > book["limit"] else "agrees"
            print(
                f"{case['name']:28} largest difference {100 * worst:.2g} % of the largest value: {verdict}", flush=True
            )
            progress.step()
            answer.append(
                {
                    "case": case,
                    "rows": rows,
                    "worst": worst,
                    "verdict": verdict,
                    "ours": ours[-1],
                    "theirs": theirs[LEVELS * (i + 1) - 1],
                }
            )
    return answer


COLUMNS = [
    "case",
    "law",
    "quantity",
    "unit",
    "largest",
    "difference",
    "relative",
    "relative_same_step",
    "step_error",
    "observed_order",
    "order",
    "difference_order",
    "dt_s",
    "verdict",
]


def write_tables(folder, answer):
    folder.mkdir(parents=True, exist_ok=True)
    rows = []
    for a in answer:
        case = a["case"]
        dt = " ".join(f"{case['step'] / 2**k:.4g}" for k in range(LEVELS))
        for r in a["rows"]:
            numbers = {k: f"{v:.4g}" if isinstance(v, float) else v for k, v in r.items()}
            rows.append(dict(numbers, case=case["name"], law=case["law"], dt_s=dt, verdict=a["verdict"]))
    tables.write(folder / "contact_check.csv", COLUMNS, rows)


def work(opts):
    book, chosen = cases.read(opts.cases, opts.case)
    if opts.list:
        for c in chosen:
            print(f"{c['name']:28} {c['what']}")
        return
    opts.liggghts = prepare(opts.liggghts, opts.yade)
    answer = run_all(opts, book, chosen)
    write_tables(opts.out, answer)
    from tools.yade.contact_picture import draw

    draw(opts.out / "contact_check.png", answer)
    failed = [a["case"]["name"] for a in answer if a["verdict"] == "FAILED"]
    if failed:
        raise RunFailed(f"beyond the limit: {', '.join(failed)}")
