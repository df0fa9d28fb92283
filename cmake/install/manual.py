#!/usr/bin/python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Manual pages and bash completion of `vielto`, from its own --help: manual.py VIELTO MAN_FOLDER COMPLETION VERSION."""
import gzip
import pathlib
import re
import subprocess
import sys


LIGGGHTS = """liggghts-vielto -in SCRIPT [-log FILE] [-var NAME VALUE...]

The distribution's LIGGGHTS with the contact laws, fixes and the script command of vielto. It takes the options of
liggghts; mpirun runs it on several processors. The stock program does the same with the library preloaded.
"""


def help_of(words):
    return subprocess.run([*words, "--help"], check=True, capture_output=True, text=True).stdout


def commands_of(text):
    """Names and sentences below `Subcommands:`."""
    part = text.partition("Subcommands:\n")[2]
    return re.findall(r"^  (\S+) +(\S.*)$", part, re.M)


def options_of(text):
    return sorted(set(re.findall(r"(?<![\w-])--[a-z][\w-]*", text)))


def page(name, sentence, text, others, version):
    quoted = text.replace("\\", "\\e").replace("-", "\\-")
    quoted = "\n".join("\\&" + line if line[:1] in (".", "'") else line for line in quoted.splitlines())
    see = ", ".join(f"\\fB{other}\\fR(1)" for other in others)
    title = name.replace(" ", "-")
    return (
        f'.TH {title.upper()} 1 "" "vielto {version}" "vielto"\n.SH NAME\n{title} \\- {sentence}\n'
        f".SH DESCRIPTION\n.nf\n{quoted}\n.fi\n" + (f".SH SEE ALSO\n{see}\n" if see else "")
    )


def completion(tree):
    lines = ["# bash completion of vielto, made from its --help", "_vielto() {"]
    lines += ['  local now=${COMP_WORDS[COMP_CWORD]} path="${COMP_WORDS[1]}" words']
    lines += ['  case "$COMP_CWORD" in', f'    1) words="{" ".join(c for c, _ in tree[""][1])} --help" ;;', "    *)"]
    lines += ['      case "$path/${COMP_WORDS[2]}" in']
    for name, (text, subs) in tree.items():
        if name and " " in name:
            lines += [f'        {name.replace(" ", "/")}) words="{" ".join(options_of(text))}" ;;']
    for name, (text, subs) in tree.items():
        if name and " " not in name:
            words = " ".join([c for c, _ in subs] + options_of(text))
            lines += [f'        {name}/*) words="{words}" ;;']
    lines += ["      esac ;;", "  esac"]
    lines += ['  [[ $now == -* || $COMP_CWORD -le 2 ]] && COMPREPLY=($(compgen -W "$words" -- "$now"))']
    lines += ["  [[ ${#COMPREPLY[@]} -gt 0 ]] || compopt -o default", "}", "complete -F _vielto vielto"]
    return "\n".join(lines) + "\n"


def main():
    program, folder, script, version = sys.argv[1:]
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    tree = {}

    def walk(words, name):
        text = help_of(words)
        tree[name] = (text, commands_of(text))
        for command, _ in tree[name][1]:
            walk([*words, command], f"{name} {command}".strip())

    walk([program], "")
    sentences = {f"{name} {c}".strip(): s for name, (_, subs) in tree.items() for c, s in subs}
    for name, (text, subs) in tree.items():
        full = f"vielto {name}".strip()
        sentence = sentences.get(name, "mixing power of granular mixers, and why it differs from measurement")
        others = [f"{full} {c}".replace(" ", "-") for c, _ in subs] or ["vielto"]
        out = page(full, sentence, text.replace(program, "vielto"), others, version)
        stem = folder / full.replace(" ", "-")
        pathlib.Path(f"{stem}.1").write_text(out)
        with gzip.GzipFile(f"{stem}.1.gz", "wb", 9, mtime=0) as packed:
            packed.write(out.encode())
    with gzip.GzipFile(folder / "liggghts-vielto.1.gz", "wb", 9, mtime=0) as packed:
        packed.write(
            page("liggghts-vielto", "LIGGGHTS with the contact laws of vielto", LIGGGHTS, ["vielto"], version).encode()
        )
    pathlib.Path(script).write_text(completion(tree))


main()
