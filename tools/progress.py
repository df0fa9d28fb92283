# SPDX-License-Identifier: GPL-2.0-or-later
"""Progress of long work on standard error, with the time left."""
import sys
import time


class Progress:
    """`12 of 84 cases diagnosed, 5 min left`, once a minute at most; nothing of work that takes less."""

    def __init__(self, what, total, every=60):
        self.what, self.total, self.every = what, total, every
        self.done, self.started, self.told = 0, time.monotonic(), time.monotonic()

    def step(self):
        self.done += 1
        now = time.monotonic()
        if now - self.told >= self.every and self.done < self.total:
            left = (now - self.started) / self.done * (self.total - self.done) / 60
            print(f"{self.done} of {self.total} {self.what}, {left:.0f} min left", file=sys.stderr, flush=True)
            self.told = now
