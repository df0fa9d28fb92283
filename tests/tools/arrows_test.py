#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Who may include whom: doc/develop/arrows.txt holds for every C++ file of the rooms it names.

A line is `room -> rooms`: files of a room may include that room's own headers and those of the rooms it
names, and of no other. The arrows make no circle. A file belongs to the deepest room it lies in.
"""
import pathlib
import re
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = "doc/develop/arrows.txt"
# The compiler's include path, as the CMakeLists.txt state it; an include of none of these is another package's header.
PATHS = (".", "postproc", "liggghts_addons", "liggghts_addons/law", "liggghts_addons/plugin/styles")


def allowed_arrows(page, root=ROOT):
    """{room: rooms it may include}; ROOM/* stands for each folder of it."""
    arrows = {}
    for line in page.splitlines():
        room, arrow, others = line.partition("->")
        for name in expanded(room.strip(), root):
            if not arrow or name in arrows:
                raise ValueError(f"{PAGE}: '{line}' is no arrow of its own; write `room -> rooms`, a line a room")
            arrows[name] = {other for word in others.split() for other in expanded(word, root)}
    return arrows


def expanded(name, root):
    if not name.endswith("/*"):
        return [name]
    return sorted(path.relative_to(root).as_posix() for path in (root / name[:-2]).iterdir() if path.is_dir())


def circle(arrows):
    """A room that can be reached from itself, or none."""
    for start in arrows:
        seen, front = set(), set(arrows[start])
        while front:
            room = front.pop()
            if room == start:
                return start
            if room not in seen:
                seen.add(room)
                front |= arrows.get(room, set())
    return None


def room_of(path, rooms):
    inside = [room for room in rooms if path.startswith(room + "/")]
    return max(inside, key=len, default=None)


def faults(root, arrows):
    """What the sources below `root` do against the arrows, a line each."""
    found = [f"{room} is no folder" for room in arrows if not (root / room).is_dir()]
    found += [f"{room} -> {to}: {to} is no room" for room in arrows for to in arrows[room] if to not in arrows]
    tops = sorted({room.split("/")[0] for room in arrows})
    sources = [path for top in tops for end in ("*.h", "*.cpp") for path in sorted((root / top).rglob(end))]
    for source in sources:
        name = source.relative_to(root).as_posix()
        room = room_of(name, arrows)
        if room is None:
            found.append(f"{name} lies in no room of {PAGE}")
            continue
        for line, text in enumerate(source.read_text().splitlines(), 1):
            include = re.match(r'#include "([^"]+)"', text)
            if not include:
                continue
            places = [source.parent / include[1], *(root / path / include[1] for path in PATHS)]
            there = next((place.resolve() for place in places if place.is_file()), None)
            if there is None:
                continue
            other = room_of(there.relative_to(root.resolve()).as_posix(), arrows)
            if other not in (room, None) and other not in arrows[room]:
                found.append(f"{name}, line {line}: {room} may not include {include[1]} of {other}")
    return found


class Arrows(unittest.TestCase):
    def test_the_sources_keep_to_the_arrows(self):
        arrows = allowed_arrows((ROOT / PAGE).read_text())
        self.assertGreater(len(arrows), 15)
        self.assertIsNone(circle(arrows))
        self.assertEqual(faults(ROOT, arrows), [])

    def test_a_forbidden_include_is_found(self):
        with tempfile.TemporaryDirectory() as name:
            root = pathlib.Path(name)
            for room in ("postproc/core", "gap/verdict", "gap"):
                (root / room).mkdir(parents=True, exist_ok=True)
            (root / "postproc/core/csv.h").write_text('#include <vector>\n#include "fmt/format.h"\n')
            (root / "gap/verdict/threshold.h").write_text('#include "core/csv.h"\n')
            arrows = {"postproc/core": set(), "gap/verdict": {"postproc/core"}}
            self.assertEqual(faults(root, arrows), [])
            (root / "postproc/core/csv.h").write_text('\n#include "gap/verdict/threshold.h"\n')
            self.assertEqual(
                faults(root, arrows),
                ["postproc/core/csv.h, line 2: postproc/core may not include gap/verdict/threshold.h of gap/verdict"],
            )
            (root / "gap/loose.cpp").write_text("")
            self.assertIn(f"gap/loose.cpp lies in no room of {PAGE}", faults(root, arrows))

    def test_circles_are_found(self):
        self.assertEqual(circle({"a": {"b"}, "b": {"c"}, "c": {"a"}}), "a")
        self.assertIsNone(circle({"a": {"b", "c"}, "b": {"c"}, "c": set()}))


if __name__ == "__main__":
    sys.exit(unittest.main())
