#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""The site's guides do what they say. What stands after `$` is run, page by page and in order, and the lines under it come
out, in order. Of commands that take longer (blocks marked `sh`, and the findings' programs `again`) the programs, options and -var names are
looked up.

  guides_test.py BIN        folder of vielto
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
BIN = pathlib.Path(sys.argv[1])
PAGES = [ROOT / "README.md", ROOT / "doc/index.md", *sorted((ROOT / "doc").glob("*/*.md"))]
ENVIRONMENT = {**os.environ, "PATH": f"{BIN}:{os.environ['PATH']}"}
FENCE = re.compile(r"^ *```(\w+)\n(.*?)^ *```$", re.M | re.S)
AGAIN = sorted(ROOT.glob("findings/*/again"))


def blocks(page, kind):
    return [text for name, text in FENCE.findall(page.read_text()) if name == kind]


def steps(page):
    """Commands with the lines that must come out."""
    found = []
    for block in blocks(page, "console"):
        for line in map(str.strip, block.splitlines()):
            if line.startswith("$ "):
                found.append((line[2:], []))
            elif line:
                assert found, f"{page}: output without a command: {line}"
                found[-1][1].append(line)
    return found


def run_page(page):
    with tempfile.TemporaryDirectory(prefix="vielto-guide-") as name:
        for entry in ROOT.iterdir():
            if entry.is_dir() and entry.name not in (".git", "build", "results"):
                (pathlib.Path(name) / entry.name).symlink_to(entry)
        for command, expected in steps(page):
            done = subprocess.run(["bash", "-c", command], cwd=name, env=ENVIRONMENT, capture_output=True, text=True)
            said = done.stdout + done.stderr
            assert done.returncode == 0, f"{page}: {command}\n{said}"
            at = 0
            for line in expected:
                found = said.find(line, at)
                assert found >= 0, f"{page}: {command}\nshould say: {line}\nsays:\n{said}"
                at = found + len(line)


def names_of_parameters():
    names = set()
    for file in [*ROOT.glob("cases/*.par"), *ROOT.glob("cases/*/*.par"), *ROOT.glob("materials/*.par")]:
        names |= set(re.findall(r"^variable (\S+) index", file.read_text(), re.M))
    laws = ""  # parameters that one law alone has
    if (BIN / "vielto_laws").exists():
        laws = subprocess.run([BIN / "vielto_laws"], capture_output=True, text=True).stdout
    return names | {f"wall_{name}" for name in names} | set(re.findall(r"^\| `(\w+)` \|", laws, re.M))


def help_of(words):
    """What a command says to --help, and the command as far as its subcommands go."""
    if words[0] == "vielto":
        program = [BIN / "vielto"]
        for word in words[1:3]:
            if (
                re.fullmatch(r"[a-z]+", word)
                and subprocess.run([*program, word, "--help"], capture_output=True).returncode == 0
            ):
                program.append(word)
        return subprocess.run([*program, "--help"], capture_output=True, text=True).stdout
    path = ROOT / words[0]
    text = path.read_text()
    if "python" in text.splitlines()[0]:
        known = [path, *[word for word in words[1:2] if re.fullmatch(r"[a-z-]+", word) and not word.startswith("-")]]
        for call in (known, known[:1]):
            done = subprocess.run([*call, "--help"], capture_output=True, text=True)
            if done.returncode == 0:
                return done.stdout
    return text


def look_up(page, command, parameters):
    words = command.split("#")[0].split()
    while words and (re.fullmatch(r"\w+=\S*", words[0]) or words[0] in ("xvfb-run", "-a", "export")):
        words.pop(0)
    if not words or words[0] in ("cd", "cp", "git", "cmake", "ctest"):
        return 0
    if words[0] == "sbatch":
        words.pop(0)
    if words[0] in ("liggghts", "liggghts-vielto", "mpirun") or words[0].startswith("slurm/"):
        for name in re.findall(r"-var (\w+)", command):
            assert name in parameters, f"{page}: {command}: no rig knows -var {name}"
        for script in re.findall(r"-in (\S+)", command):
            assert list(ROOT.glob(f"cases/*/{script}")), f"{page}: {command}: no {script}"
        return 1
    assert words[0] == "vielto" or (ROOT / words[0]).is_file(), f"{page}: {command}: there is no {words[0]}"
    said = help_of(words)
    for option in re.findall(r"(?<= )--[a-z][\w-]*", command):
        assert option in said, f"{page}: {command}: no option {option}"
    return 1


run = looked_up = 0
parameters = names_of_parameters()
assert len(parameters) > 100, parameters
for page in PAGES:
    commands = steps(page)
    if commands:
        run_page(page)
    run += len(commands)
    for block in blocks(page, "sh"):
        for command in block.replace("\\\n", " ").splitlines():
            looked_up += look_up(page.relative_to(ROOT), command.strip(), parameters)
assert len(AGAIN) > 20, AGAIN
for program in AGAIN:
    for command in program.read_text().replace("\\\n", " ").splitlines():
        command = re.sub(r"\$here", str(program.parent.relative_to(ROOT)), command.split(" || ")[0].strip())
        if re.match(r"(scripts|findings|bench|yade|vielto|liggghts)\b", command):
            looked_up += look_up(program.relative_to(ROOT), command, parameters)
assert run > 20 and looked_up > 20, (run, looked_up)

# the looking up finds what is wrong
for wrong in ("vielto fit --no-such-option", "scripts/no_such", "liggghts -in in.mixer -var noSuchName 1"):
    try:
        look_up("here", wrong, parameters)
    except AssertionError:
        continue
    raise SystemExit(f"not found to be wrong: {wrong}")
print(run, "commands of the guides run,", looked_up, "looked up")
