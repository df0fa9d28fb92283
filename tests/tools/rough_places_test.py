# SPDX-License-Identifier: GPL-2.0-or-later
"""Where programs are run by others: names with blanks, quotes, commands and umlauts, a locale with decimal commas, a folder that is
read only, a disk that is full, two processes in one folder. Each either does its work, with the same bytes as elsewhere, or says in
one line what is wrong, and leaves nothing half written.
   rough_places_test.py BIN    folder of our liggghts and vielto
The disks are mounts in a namespace of the test's own (unshare)."""
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(sys.argv[1]).resolve()
STUB = ROOT / "tests/tools/stub_liggghts.py"

if "VIELTO_OWN_MOUNTS" not in os.environ:
    own = ["unshare", "--mount"] if os.geteuid() == 0 else ["unshare", "--map-root-user", "--mount"]
    if subprocess.run([*own, "true"], capture_output=True).returncode:
        sys.exit(77)
    os.execvpe(own[0], [*own, sys.executable, *sys.argv], dict(os.environ, VIELTO_OWN_MOUNTS="1"))

ENVIRONMENT = dict(os.environ, PATH=f"{BIN}:{os.environ['PATH']}", VIELTO_STUB_SECONDS="0.05")
ENVIRONMENT.pop("DISPLAY", None)
TABLE = (
    "test,role,apparatus,observable,value,u,unit,speed,fill,moisture,normal_stress,shear_velocity,tilt,wall,material\n"
    + "".join(
        f"t{i},fit,mixer,power,{10 + 7 * i}.5,0.5,W,{0.5 + 0.2 * i:.1f},{0.1 + 0.03 * i:.2f},,,,,steel,hulled_millet\n"
        for i in range(5)
    )
)
LOGGER = "t;P\n" + "".join(f"{0.1 * i:.1f};{1200 + (i * 7919) % 13}\n" for i in range(400)).replace(".", ",")


def run(*words, **more):
    return subprocess.run(
        [str(w) for w in words], env={**ENVIRONMENT, **more.pop("env", {})}, capture_output=True, text=True, **more
    )


def make_inputs(folder):
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "t.csv").write_text(TABLE)
    (folder / "log.csv").write_text(LOGGER)
    # the stand-in refuses no blanks
    made = run(STUB, "-in", "in.mixer", "-var", "run", folder / "run", "-var", "speed", "1.2")
    assert made.returncode == 0, made


def commands(inputs, out):
    """Every command that writes, and what it writes, in `out`."""
    return [
        (["vielto", "geometry", ROOT / "cases/mixer/mixer.par", "--out", out / "mesh"], "mesh/drum.stl"),
        (
            [
                "vielto",
                "fit",
                inputs / "t.csv",
                "--material",
                "hulled_millet",
                "--groups",
                "l",
                "--out",
                out / "e.json",
            ],
            "e.json",
        ),
        (
            [
                "vielto",
                "import",
                "logger",
                inputs / "log.csv",
                "--value-column",
                "P",
                "--time-column",
                "t",
                "--speed",
                "1",
            ]
            + ["--test", "a", "--out", out / "o.csv"],
            "o.csv",
        ),
        (
            [
                "vielto",
                "gap",
                "isolability",
                inputs / "t.csv",
                "--library",
                "millet",
                "--draws",
                "100",
                "--out",
                out / "sealed",
            ],
            "sealed/isolability.json",
        ),
        (["vielto", "report", inputs / "run", "--no-plots", "--out", out / "report"], "report/report.html"),
    ]


def contents(folder):
    """Files: an empty folder is no result."""
    return sorted(str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file())


def does_its_work(inputs, out, environment=None):
    """What each command writes."""
    made = {}
    for words, name in commands(inputs, out):
        done = run(*words, env=environment or {})
        assert done.returncode == 0, (words, done)
        made[name] = (out / name).read_text()
    posted = run("vielto", "post", inputs / "run", env=environment or {})
    assert posted.returncode == 0, posted
    made["post"] = (inputs / "run/post/observations.csv").read_text()
    left = [name for name in contents(out) + contents(inputs) if "partial" in name]
    assert not left, left
    return made


def is_refused(inputs, out, *words_told):
    for words, name in commands(inputs, out):
        done = run(*words)
        assert done.returncode in (1, 2), (words, done)
        told = done.stderr.strip().splitlines()
        assert len(told) == 1 and told[0].startswith("vielto: ") and any(w in told[0] for w in words_told), (
            words,
            done.stderr,
        )
        assert contents(out) in ([], ["filler"]), (words, contents(out))


MOUNTED = []


def mount(folder, size):
    MOUNTED.append(folder)
    folder.mkdir(exist_ok=True)
    subprocess.run(["mount", "-t", "tmpfs", "-o", f"size={size}", "none", folder], check=True)


def without_times(made):
    """Without what tells when and where a file was made."""
    keep = {"mesh/drum.stl", "e.json", "o.csv", "post"}
    return {name: text for name, text in made.items() if name in keep}


def test(folder):
    plain = folder / "plain"
    make_inputs(plain)
    plainly = without_times(does_its_work(plain, plain))

    # names
    for awkward in ("two words", 'it\'s "quoted"', "grün-µ-小麦", "$(touch here);touch there&", "-dash", "100%d"):
        place = folder / "names" / awkward
        make_inputs(place)
        made = without_times(does_its_work(place, place))
        made["e.json"] = made["e.json"].replace(str(place).replace('"', '\\"'), str(plain))
        assert made == plainly, awkward
    assert not list(folder.rglob("here")) and not list(folder.rglob("there"))
    refused = run("liggghts", "-in", "in.mixer", "-var", "run", folder / "names/two words/r", cwd=ROOT / "cases/mixer")
    assert refused.returncode and "reads no folder with blanks" in refused.stdout + refused.stderr, refused
    study = folder / "study.csv"
    study.write_text("run,rig,speed\na,mixer,1;touch touched\n")
    refused = run(ROOT / "scripts/campaign", study, "--out", folder / "names/two words/c", "--bin", BIN)
    assert refused.returncode == 2 and "state another with --out" in refused.stderr, refused

    # words of a study are words
    programs = folder / "bin"
    programs.mkdir()
    (programs / "vielto").symlink_to(BIN / "vielto")
    (programs / "liggghts").write_text('#!/bin/sh\nprintf "%s|" "$@" >>"$SEEN"\nexit 1\n')
    (programs / "liggghts").chmod(0o755)
    failed = run(
        ROOT / "scripts/campaign",
        study,
        "--out",
        folder / "campaign",
        "--bin",
        programs,
        env={"SEEN": str(folder / "seen")},
    )
    if "snakemake" not in failed.stderr or failed.returncode != 2:
        assert failed.returncode == 1 and "|-var|speed|1;touch touched|" in (folder / "seen").read_text(), failed
        assert not list(folder.rglob("touched")) and not (ROOT / "cases/mixer/touched").exists()

    # decimal commas
    locales = folder / "locales"
    locales.mkdir()
    made = subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", locales / "de_DE.UTF-8"], capture_output=True)
    if (locales / "de_DE.UTF-8").exists():
        german = {"LOCPATH": str(locales), "LC_ALL": "de_DE.UTF-8", "LANG": "de_DE.UTF-8"}
        comma = subprocess.run(["printf", "%.1f", "1,5"], env={**os.environ, **german}, capture_output=True, text=True)
        assert comma.stdout == "1,5", comma  # or the test would show nothing
        place = folder / "german"
        make_inputs(place)
        made = without_times(does_its_work(place, place, german))
        made["e.json"] = made["e.json"].replace(str(place), str(plain))
        assert made == plainly

    # a disk that is full
    full = folder / "full"
    mount(full, "64k")
    (full / "filler").write_bytes(b"x" * 65536)
    is_refused(plain, full, "space left")
    (full / "filler").unlink()
    # and one that becomes full: the meshes have room, 21600 rows have not
    subprocess.run(["mount", "-o", "remount,size=420k", full], check=True)
    small = [
        "-log",
        "none",
        "-in",
        "in.mixer",
        "-var",
        "fill",
        "0",
        "-var",
        "slicePaddles",
        "2",
        "-var",
        "restartTurns",
        "0",
    ]
    stopped = run("liggghts", *small, "-var", "turns", "60", "-var", "run", full / "run", cwd=ROOT / "cases/mixer")
    assert stopped.returncode and "space left" in stopped.stdout + stopped.stderr, stopped
    assert not (full / "run").exists() and (full / "run.partial").exists()
    for word in (
        ["vielto", "rigs"],
        ["vielto", "fit", plain / "t.csv", "--material", "hulled_millet", "--groups", "l"],
    ):
        with open("/dev/full", "w") as nowhere:
            done = subprocess.run(
                [str(w) for w in word], env=ENVIRONMENT, stdout=nowhere, stderr=subprocess.PIPE, text=True
            )
        assert done.returncode == 1 and "cannot be written" in done.stderr, done

    # a folder that is read only
    locked = folder / "locked"
    mount(locked, "64k")
    subprocess.run(["mount", "-o", "remount,ro", locked], check=True)
    is_refused(plain, locked, "cannot be ", "cannot create")
    stopped = run("liggghts", *small, "-var", "run", locked / "run", cwd=ROOT / "cases/mixer")
    assert stopped.returncode and "cannot make the run folder" in stopped.stdout + stopped.stderr, stopped

    # two processes in one folder: the first goes on, the second is told
    two = folder / "two"
    slow = ["liggghts", *small, "-var", "turns", "4000", "-var", "run", two]
    first = subprocess.Popen(
        [str(w) for w in slow], cwd=ROOT / "cases/mixer", env=ENVIRONMENT, stdout=subprocess.DEVNULL
    )
    while not (folder / "two.partial/torque.csv").exists():
        assert first.poll() is None
    second = run(*slow, cwd=ROOT / "cases/mixer")
    assert first.poll() is None, "the first has ended before the second was started"
    assert second.returncode and "another run is at work in" in second.stdout + second.stderr, second
    first.kill()
    first.wait()
    # what a killed one leaves is taken over
    taken = run("liggghts", *small, "-var", "turns", "0.1", "-var", "run", two, cwd=ROOT / "cases/mixer")
    assert taken.returncode == 0 and (two / "torque.csv").exists() and not (two / "in_use").exists(), taken
    posts = [
        subprocess.Popen(
            ["vielto", "post", plain / "run"], env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
        )
        for _ in range(8)
    ]
    for post in posts:
        assert post.wait() == 0, post.stderr.read().decode()
    assert (plain / "run/post/observations.csv").read_text() == plainly["post"]


with tempfile.TemporaryDirectory(prefix="vielto-rough-") as name:
    try:
        test(pathlib.Path(name))
    finally:
        for place in MOUNTED:
            subprocess.run(["umount", "--lazy", place])
