# SPDX-License-Identifier: GPL-2.0-or-later
"""What `cmake --install` puts into a prefix works from there, and after the prefix has been moved: programs, cases, cards,
libraries, manual pages, completion, find_package and pkg-config.
   install_test.py BUILD    the build folder"""
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import tempfile

BUILD = pathlib.Path(sys.argv[1])
LAW_PROJECT = """cmake_minimum_required(VERSION 3.25)
project(own LANGUAGES CXX)
find_package(vielto 0.1 REQUIRED)
add_executable(own own.cpp)
target_link_libraries(own PRIVATE vielto::law)
"""
# the normal spring of the booklet, k_n = 2 E R for equal spheres
LAW_PROGRAM = """#include <vielto_law.h>
int main() {
  vielto::Material m;
  m.youngsModulus = 2e6, m.stiffnessRatio = 0.5, m.frictionAngle = 0.4;
  m.normalDamping = m.tangentialDamping = m.rollingStiffnessFactor = m.twistingStiffnessFactor = 0;
  m.rollingResistance = m.twistingResistance = 0;
  const double k = vielto::stiffness(vielto::mix(m, m), 0.004, 0.004, 1e-3).kn;
  return k > 15999.9 && k < 16000.1 ? 0 : 1;
}
"""


def run(words, status=0, **options):
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, **options)
    assert done.returncode == status, (words, done.stdout[-2000:], done.stderr[-2000:])
    return done.stdout + done.stderr


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    run(["cmake", "--install", BUILD, "--prefix", folder / "first"])
    shutil.move(folder / "first", folder / "moved here")  # no path is compiled in
    prefix = folder / "moved here"
    env = dict(os.environ, PATH=f"{prefix / 'bin'}:/usr/bin:/bin", OMPI_ALLOW_RUN_AS_ROOT="1")
    env["OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"] = "1"
    env.pop("LD_LIBRARY_PATH", None)

    assert not (prefix / "bin/liggghts").exists()  # the name of another package's file
    assert "vielto 0." in run(["vielto", "--version"], env=env)
    left = [str(p) for p in prefix.rglob("*") if p.name in ("results", "log.liggghts", "__pycache__")]
    assert not left, left

    # a working copy, and a run in it by the installed program
    work = folder / "my work"
    said = run(["vielto", "copy", work], env=env)
    assert f"first run: cd {shlex.quote(f'{work}/cases/mixer')} && liggghts-vielto -in in.mixer" in said, said
    assert "is there already" in run(["vielto", "copy", work], status=2, env=env)
    mixer = work / "cases/mixer"
    small = (
        "fill 0.05 grainDiameter 0.016 youngsModulus 2e5 wall_youngsModulus 2e5 maxOverlap 0.2 settleTime 0.2 turns 3"
    )
    words = [word for k, word in enumerate(small.split()) for word in (["-var", word] if k % 2 == 0 else [word])]
    run(["liggghts-vielto", "-log", "none", "-in", "in.mixer", *words], cwd=mixer, env=env)
    assert "mixing power" in run(["vielto", "post", mixer / "results/run"], env=env).lower()

    # cards and libraries by name, from anywhere
    text = run(
        ["vielto", "predict", "--thesis", "--material", "hulled_millet", "--speed", "1", "--fill", "0.15"],
        env=env,
        cwd=folder,
    )
    assert "power_W" in text, text
    text = run(
        ["vielto", "gap", "predict", "--library", "millet", "--apparatus", "mixer", "--speed", "1", "--fill", "0.15"],
        env=env,
        cwd=folder,
    )
    assert "power" in text, text
    wrong = run(
        ["vielto", "gap", "predict", "--library", "mullet", "--apparatus", "mixer", "--speed", "1", "--fill", "0.15"],
        status=2,
        env=env,
        cwd=folder,
    )
    assert "mullet" in wrong and wrong.count("\n") == 1, wrong

    # the law's headers in another project
    own = folder / "own"
    own.mkdir()
    (own / "CMakeLists.txt").write_text(LAW_PROJECT)
    (own / "own.cpp").write_text(LAW_PROGRAM)
    run(["cmake", "-S", own, "-B", own / "build", f"-DCMAKE_PREFIX_PATH={prefix}"])
    run(["cmake", "--build", own / "build"])
    run([own / "build/own"])
    if shutil.which("pkg-config"):
        words = run(
            ["pkg-config", "--cflags", "vielto"], env=dict(env, PKG_CONFIG_PATH=str(prefix / "share/pkgconfig"))
        )
        assert "include/vielto" in words, words

    # a manual page for every command, without complaints, and completion that offers the commands
    pages = sorted(p.name for p in (prefix / "share/man/man1").iterdir())
    assert {"vielto.1.gz", "vielto-post.1.gz", "vielto-gap-diagnose.1.gz"} <= set(pages), pages
    script = prefix / "share/bash-completion/completions/vielto"
    asked = f'. "{script}"; COMP_WORDS=(vielto gap dia); COMP_CWORD=2; _vielto; echo "${{COMPREPLY[@]}}"'
    assert run(["bash", "-c", asked]).strip() == "diagnose"
print("installed, moved, used")
