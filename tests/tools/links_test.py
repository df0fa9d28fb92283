#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Every relative link of every page leads to a file that is there."""
import pathlib
import re
import sys

root = pathlib.Path(__file__).resolve().parents[2]
made = re.compile(r"(build|results|\.)")  # folders of what is no source
pages = [p for p in map(str, sorted(q.relative_to(root) for q in root.rglob("*.md"))) if not made.match(p)]
missing = []
for page in pages:
    text = (root / page).read_text()
    for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", text):
        if not re.match(r"[a-z]+:", link) and not ((root / page).parent / link).exists():
            missing.append(f"{page}: {link}")
print("\n".join(missing) or f"{len(pages)} pages")
sys.exit(bool(missing) or not pages)
