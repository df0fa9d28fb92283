# SPDX-License-Identifier: GPL-2.0-or-later
"""Programs that step when told, so that two of them can take turns; each answers with the seconds it took."""
import json
import os
import pathlib
import re
import subprocess

from tools import ROOT
from tools.errors import RunFailed

BIN = ROOT / "build" / "bin"
ENV = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1", OMP_NUM_THREADS="1")


def build(packages=()):
    """What the benchmark needs; `packages`: lists in scripts/packages beyond those of every part."""
    subprocess.run([ROOT / "scripts" / "install-packages", "demo", "bench", *packages], check=True)
    subprocess.run(
        [ROOT / "scripts" / "build", "release", "vielto", "vielto_run", "vielto_bench", "vielto_triad"],
        check=True,
        stdout=subprocess.DEVNULL,
    )


def command(script, ranks, variables, program=None):
    words = [str(program or BIN / "vielto_bench"), "-in", str(script), "-var", "bench", str(ROOT / "bench")]
    for name, value in variables.items():
        words += ["-var", name, str(value)]
    return (["mpirun", "--oversubscribe", "-np", str(ranks)] if ranks > 1 else []) + words


class Program:
    """Started with these words in this folder; what it says is read line by line."""

    def __init__(self, words, folder, name):
        self.log = open(f"{folder}/log.{name}", "w")
        self.memory = 0.0
        self.process = subprocess.Popen(
            words,
            cwd=folder,
            env=ENV,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self.log,
            text=True,
            errors="replace",
        )

    def until(self, word):
        lines = []
        for line in self.process.stdout:
            lines.append(line)
            memory = re.search(r"Memory usage per processor = ([0-9.]+) Mbytes", line)
            if memory:
                self.memory = float(memory[1])
            if line.startswith(word):
                return line
        raise RunFailed(f"{' '.join(self.process.args)} ended early:\n{''.join(lines[-8:])}")

    def say(self, text):
        try:
            self.process.stdin.write(text)
            self.process.stdin.flush()
        except BrokenPipeError:
            raise RunFailed(f"{' '.join(self.process.args)} ended early; {self.log.name} tells why")

    def quit(self):
        self.process.communicate("quit\n")


class Engine(Program):
    """vielto_bench: liggghts with clocks in the contact law."""

    def __init__(self, folder, ranks=1, script="in.timed", program=BIN / "vielto_bench", **variables):
        words = command(ROOT / "bench" / script, ranks, variables, program)
        name = f"{ranks}.{variables.get('law', 'none')}.{pathlib.Path(script).name}"
        super().__init__(words, folder, name if program == BIN / "vielto_bench" else f"{name}.other")
        self.until("READY")

    def step(self, steps):
        self.say(f"run {steps}\n")
        return json.loads(self.until("TIMED")[len("TIMED ") :])

    def processor_s(self):
        """On the processor so far; other work on the machine counts less than in the clock's time."""
        return 1e-9 * int(pathlib.Path(f"/proc/{self.process.pid}/schedstat").read_text().split()[0])


class Yade(Program):
    def __init__(self, folder):
        super().__init__(
            ["yade", "-n", "-x", "-j1", str(ROOT / "tools/yade/in_yade/stirred.py"), "run.json"], folder, "yade"
        )
        self.until("READY")

    def step(self, steps):
        self.say(f"run {steps}\n")
        return json.loads(self.until("TIMED")[len("TIMED ") :])


class Lammps(Program):
    """The distribution's lmp, fed its script and then `run`s; a pipe would keep its lines back."""

    def __init__(self, folder):
        super().__init__(["stdbuf", "-oL", "lmp", "-log", "none"], folder, "lammps")
        self.say((ROOT / "bench/lammps.packing").read_text() + 'print "READY"\n')
        self.until("READY")

    def step(self, steps):
        self.say(f"run {steps} pre no post no\n")
        return {"run_s": float(self.until("Loop time of").split()[3]), "steps": steps}

    def contacts(self):
        self.say(
            "compute touch all contact/atom\ncompute touches all reduce sum c_touch\nthermo_style custom step c_touches\n"
            'run 0\nprint "DONE"\n'
        )
        values = []
        while not (line := self.until("")).startswith("DONE"):
            if re.fullmatch(r"\s*\d+\s+[0-9.e+]+\s*", line):
                values.append(float(line.split()[1]))
        return values[-1] / 2


def make_bed(folder, geometry=(), **variables):
    """A bed in motion as a data file; the variables that in.timed needs to go on from it."""
    subprocess.run(
        [
            BIN / "vielto",
            "geometry",
            ROOT / "cases/mixer/mixer.par",
            "--out",
            f"{folder}/mesh",
            *(f"--set={g}" for g in geometry),
        ],
        check=True,
        stdout=subprocess.DEVNULL,
    )
    result = subprocess.run(
        command(ROOT / "bench/in.bed", 1, dict(variables, mesh=f"{folder}/mesh")),
        cwd=folder,
        env=ENV,
        input="quit\n",
        capture_output=True,
        text=True,
        errors="replace",
    )
    angle = re.search(r"^ANGLE (\S+)", result.stdout, re.M)
    box = re.search(r"^BOX (\S+) (\S+) (\S+)", result.stdout, re.M)
    if not angle or not box:
        raise RunFailed(f"the bed could not be made:\n{result.stdout[-800:]}")
    lines = pathlib.Path(folder, "bed.dump").read_text().split("ITEM: ATOMS")[-1].splitlines()[1:]
    grains = [line.split() for line in lines]
    length, top, density = box.groups()
    with open(f"{folder}/bed.data", "w") as out:
        out.write(
            f"bed in motion\n\n{len(grains)} atoms\n2 atom types\n\n"
            f"0 {length} xlo xhi\n-0.15 0.15 ylo yhi\n-0.15 {top} zlo zhi\n\nAtoms\n\n"
        )
        for g in grains:
            out.write(f"{g[0]} {g[1]} {2 * float(g[11]):.16g} {density} {g[2]} {g[3]} {g[4]}\n")
        out.write("\nVelocities\n\n")
        for g in grains:
            out.write(f"{g[0]} {' '.join(g[5:11])}\n")
    return dict(mesh=f"{folder}/mesh", d=variables["d"], angle=angle[1], bed=f"{folder}/bed.data")
