#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-2.0-or-later
"""Every relative link of every page leads to a file that is there."""
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parents[2]
pages = subprocess.run(
    ["git", "-C", root, "ls-files", "*.md"], check=True, capture_output=True, text=True
).stdout.split()
missing = []
for page in pages:
    text = (root / page).read_text()
    for link in re.findall(r"\]\(([^)#\s]+)[^)]*\)", text):
        if not re.match(r"[a-z]+:", link) and not ((root / page).parent / link).exists():
            missing.append(f"{page}: {link}")
print("\n".join(missing) or f"{len(pages)} pages")
sys.exit(bool(missing) or not pages)
