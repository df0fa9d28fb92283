# SPDX-License-Identifier: GPL-2.0-or-later
"""Names the withheld cases that have something to simulate: strong ones with one known effect, unless the answer is "no gap".

  scripts/blind list-strong FOLDER/check/truth FOLDER/answers

The answer is its verdict; what variants of its settings would have said ("sensitivity") does not count.
"""
from tools.blind import cases

add_options = cases.add_options


def work(options):
    print(*cases.strong(options.truths, options.answers))
