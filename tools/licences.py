# SPDX-License-Identifier: GPL-2.0-or-later
"""Licences of what this package is built from and calls, as CSV, from Debian's own copyright files.

Linked is what the dynamic linker loads for the programs in BIN and the libraries beside it, libraries of libraries too. Of
headers the code is in our programs; programs are called by name."""
import pathlib
import re
import subprocess

from tools import ROOT, command_line
from tools.errors import BadInput

HEADERS = [
    "libeigen3-dev",
    "libcli11-dev",
    "nlohmann-json3-dev",
    "libtomlplusplus-dev",
    "libhwy-dev",
    "libboost1.74-dev",
]
PROGRAMS = ["liggghts", "openmpi-bin", "snakemake", "nodejs", "ffmpeg", "python3", "xvfb"]
# comes from no Debian package: scripts/get-echarts
FETCHED = "Apache ECharts,{},Apache-2.0,in every report page"


def add_options(parser):
    parser.add_argument("bin", type=pathlib.Path, help="folder of the built programs: build/bin")


def work(options):
    built = sorted(options.bin.glob("*")) + sorted(options.bin.parent.glob("lib/*.so"))
    if not built:
        raise BadInput(f"{options.bin}: holds no programs; build them first")
    print("package,version,licences,use")
    for use, packages in [("linked", sorted(linked_packages(built))), ("headers", HEADERS), ("program", PROGRAMS)]:
        for package in packages:
            if version := ask("dpkg-query", "-W", "-f", "${Version}", package):
                print(f"{package},{version},{licences(package)},{use}")
    print(FETCHED.format(re.search("^version=(.*)$", (ROOT / "scripts/get-echarts").read_text(), re.M)[1]))
    return 0


def ask(*command):
    return subprocess.run(command, capture_output=True, text=True).stdout


def linked_packages(built):
    libraries = {path for program in built for path in re.findall(r"=> (/\S+)", ask("ldd", program))}
    names = {
        name for path in libraries for name in (path, path.removeprefix("/usr"), str(pathlib.Path(path).resolve()))
    }
    # a library's path is known to dpkg with or without /usr, as the package has it
    return {line.split(":")[0] for line in ask("dpkg-query", "-S", *sorted(names)).splitlines()}


def licences(package):
    """The short names of a machine-readable copyright file; of another one the standard texts that it points to."""
    path = pathlib.Path("/usr/share/doc") / package / "copyright"
    text = path.read_text(encoding="utf-8", errors="replace") if path.exists() else ""
    names = re.findall(r"^License: *(\S.*)$", text, re.M) if text.startswith("Format:") else []
    names = names or re.findall(r"/usr/share/common-licenses/([\w.+-]*\w)", text)
    return " · ".join(dict.fromkeys(name.replace(",", ";").strip() for name in names)) or f"see {path}"


def main():
    return command_line.run("licences", __doc__, add_options, work)
