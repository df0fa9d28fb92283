# SPDX-License-Identifier: GPL-2.0-or-later
"""Scatter between seeds: a handful of them tells little of its own, so that it is pooled over conditions."""
import math


def mean(values):
    return sum(values) / len(values)


def pooled(groups):
    """(relative standard deviation, degrees of freedom) within groups of values that differ in their seed alone.

    s^2 = sum over groups of sum (x/mean - 1)^2 / sum of (n - 1); 0 where no group has two values.
    """
    groups = [values for values in groups if mean(values)]
    freedom = sum(len(values) - 1 for values in groups)
    if not freedom:
        return 0.0, 0
    return math.sqrt(sum((x / mean(values) - 1) ** 2 for values in groups for x in values) / freedom), freedom


def of_ratio(ratio, scatter, n, n_base):
    """u of the ratio of two means over n and n_base runs of one relative scatter."""
    return abs(ratio) * scatter * math.sqrt(1 / n + 1 / n_base)
