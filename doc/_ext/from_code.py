# SPDX-License-Identifier: GPL-2.0-or-later
"""Pages from the code itself:

    {commands} vielto                       a section for the program and each command that its help names, as deep as they go;
                                            VIELTO_BIN is the program's folder (default: build/bin)
    {program-page} vielto_laws              the Markdown that the program prints, but for its first heading and paragraph
    {parameters} cases/mixer/mixer.par      the lines of a parameter file or card: name, value, unit, (range,) u, source
    {effects} libraries/effects             one row an effect file
    {observables} cases/rigs.toml           one row an observable of the table of rigs
    {csv} records.csv                       a CSV table beside the page, Markdown in its cells, its first line the head
    {rig-parameters} cases/rigs.toml        a section a rig of the table: its title and its own parameter file
"""
import os
import pathlib
import re
import subprocess
import tomllib

from docutils import nodes
from docutils.parsers.rst import Directive
from docutils.statemachine import StringList
from sphinx.directives.patches import CSVTable

from results import table

ROOT = pathlib.Path(__file__).resolve().parents[2]
LINE = re.compile(r"variable\s+(\S+)\s+index\s+(\S+)(?:\s*#\s*(.*))?$")


class FromFile(Directive):
    """A directive of one argument, a path from the repository's root."""

    required_arguments = 1

    def path(self):
        path = ROOT / self.arguments[0]
        if not path.exists():
            raise self.error(f"{self.arguments[0]}: is not in the repository")
        self.state.document.settings.env.note_dependency(str(path))
        return path


class CsvFile(CSVTable):
    """A table with words in its cells."""

    required_arguments = 1

    def run(self):
        self.options |= {"file": self.arguments.pop(), "header-rows": 1}
        return super().run()


class Parameters(FromFile):
    def run(self):
        rows = []
        for line in self.path().read_text(encoding="utf-8").splitlines():
            found = LINE.match(line.strip())
            if found:
                name, value, note = found.groups()
                parts = [part.strip() for part in (note or "").split("|")]
                rows.append([name, value, parts[0], *parts[1:-1], parts[-1] if len(parts) > 1 else ""])
        if not rows:
            raise self.error(f"{self.arguments[0]}: has no `variable NAME index VALUE`")
        width = max(len(row) for row in rows)
        heads = {5: ["name", "value", "unit", "u", "source"], 6: ["name", "value", "unit", "range", "u", "source"]}
        if width not in heads:
            raise self.error(f"{self.arguments[0]}: {width} columns; say in from_code.py what they are")
        rows = [row[:-1] + [""] * (width - len(row)) + row[-1:] for row in rows]
        return [table(heads[width], rows, code=2)]


class Effects(FromFile):
    def run(self):
        rows = []
        for file in sorted(self.path().glob("*.toml")):
            self.state.document.settings.env.note_dependency(str(file))
            text = file.read_text(encoding="utf-8")
            effect = tomllib.loads(text)
            first = re.match(r"#\s*(.*)", text)
            rows.append(
                [
                    effect["name"],
                    first.group(1) if first else "",
                    effect["kind"],
                    f"{effect['prior_low']:g} … {effect['prior_high']:g} {effect['unit']}".replace("-", "−"),
                    effect["source"],
                ]
            )
        if not rows:
            raise self.error(f"{self.arguments[0]}: has no effect file")
        return [table(["effect", "what it is", "kind", "range", "source of the range"], rows, code=1)]


class Observables(FromFile):
    def run(self):
        stated = tomllib.loads(self.path().read_text(encoding="utf-8"))
        any_apparatus = {"any": {"observables": stated.pop("observables")}}
        rows = [
            [apparatus, name, unit, meaning]
            for apparatus, entry in {**stated, **any_apparatus}.items()
            for name, (unit, meaning, *_) in entry["observables"].items()
        ]
        return [table(["apparatus", "observable", "unit", "meaning"], rows, code=2)]


class RigParameters(FromFile):
    def run(self):
        lines = []
        for entry in tomllib.loads(self.path().read_text(encoding="utf-8")).values():
            if "script" in entry:
                path = pathlib.PurePath(self.arguments[0]).parent / entry["parameters"][0]
                title = entry["title"][0].upper() + entry["title"][1:]
                lines += [f"## {title}", "", f"```{{parameters}} {path}", "```", ""]
        holder = nodes.Element()
        self.state.nested_parse(StringList(lines), self.lineno, holder, match_titles=True)
        return holder.children


class FromProgram(Directive):
    """A directive of one argument, a program in build/bin and words for it."""

    required_arguments = 1
    final_argument_whitespace = True

    def said(self, *more):
        """What the program prints; nothing if it is not there."""
        program, *words = self.arguments[0].split()
        path = pathlib.Path(os.environ.get("VIELTO_BIN", ROOT / "build/bin")) / program
        if not path.exists():
            return ""
        done = subprocess.run([program, *words, *more], executable=path, capture_output=True, text=True)
        if done.returncode != 0:
            raise self.error(f"{self.arguments[0]}: {done.stderr.strip()}")
        return done.stdout.rstrip()

    def missing(self):
        text = f"{self.arguments[0].split()[0]} was not built when this page was made (scripts/build release)."
        return [nodes.paragraph(text=text)]


def help_of(program, words):
    done = subprocess.run([program.name, *words, "--help"], executable=program, capture_output=True, text=True)
    if done.returncode != 0:
        raise OSError(f"{' '.join(words)}: {done.stderr.strip()}")
    return done.stdout.rstrip()


def commands_of(program, words=()):
    """[(words, help)] of a program's command and of those below it."""
    text = help_of(program, words)
    found = [(words, text)]
    for name in re.findall(r"^  ([a-z]+)(?:\s|$)", text.partition("\nSubcommands:\n")[2], re.M):
        found += commands_of(program, (*words, name))
    return found


class Commands(FromProgram):
    def run(self):
        name = self.arguments[0]
        program = pathlib.Path(os.environ.get("VIELTO_BIN", ROOT / "build/bin")) / name
        if not program.exists():
            return self.missing()
        try:
            found = commands_of(program)
        except OSError as fault:
            raise self.error(f"{name}: {fault}") from fault
        lines = []
        for words, text in found:
            lines += [f"## {' '.join((name, *words))}", "", "```text", *text.splitlines(), "```", ""]
        holder = nodes.Element()
        self.state.nested_parse(StringList(lines), self.lineno, holder, match_titles=True)
        return holder.children


class ProgramPage(FromProgram):
    def run(self):
        text = self.said()
        if not text:
            return self.missing()
        body = text[text.index("\n## ") :] if "\n## " in text else text
        holder = nodes.Element()
        self.state.nested_parse(StringList(body.splitlines()), self.lineno, holder, match_titles=True)
        return holder.children


def setup(app):
    app.add_directive("csv", CsvFile)
    app.add_directive("parameters", Parameters)
    app.add_directive("effects", Effects)
    app.add_directive("observables", Observables)
    app.add_directive("rig-parameters", RigParameters)
    app.add_directive("commands", Commands)
    app.add_directive("program-page", ProgramPage)
    return {"parallel_read_safe": True}
