# SPDX-License-Identifier: GPL-2.0-or-later
"""Trajectories at three time steps -> their limit for a vanishing step, and how far two engines' limits are apart."""
import math

import numpy

QUANTITIES = {"displacement": "m", "velocity": "m/s", "spin": "rad/s", "force": "N", "torque": "N m"}


def parts(states):
    """Arrays [time, sphere, 3] of each quantity. Without t = 0: there a force is what the engine's start makes of it."""
    x = states[:, :, 0:3] - states[:1, :, 0:3]
    rest = [states[:, :, k : k + 3] for k in (3, 6, 9, 12)]
    return {name: a[1:] for name, a in zip(QUANTITIES, [x] + rest)}


def largest(a):
    return float(numpy.linalg.norm(a, axis=-1).max())


def order_of(coarse, fine, scale):
    """p of error ~ dt^p from an error and the one at half the step; None where they are round-off of values of `scale`."""
    return math.log2(coarse / fine) if scale and min(coarse, fine) > 1e-11 * scale else None


def limit(middle, fine, order):
    """Richardson: the error of the finest step is taken off, order as given."""
    return fine + (fine - middle) / (2**order - 1)


def compare(ours, theirs):
    """ours, theirs: states at dt, dt/2, dt/4. One row of numbers a quantity."""
    rows = []
    a, b = [parts(s) for s in ours], [parts(s) for s in theirs]
    for name, unit in QUANTITIES.items():
        scale = max(largest(a[-1][name]), largest(b[-1][name]))
        if scale < 1e-12:  # round-off in both engines: this quantity is zero in this case
            scale = 0.0
        p = order_of(*(largest(a[k][name] - a[k + 1][name]) for k in (0, 1)), scale)
        # Both schemes are of first order (a dashpot's velocity is half a step late; caps and contact ends fall on
        # steps) or, where all is smooth, of second: the nearer of the two.
        order = 2 if p is not None and p > 1.5 else 1
        end_a, end_b = (limit(s[-2][name], s[-1][name], order) for s in (a, b))
        apart = [largest(s[name] - t[name]) for s, t in zip(a, b)]  # at equal steps
        gone = largest(end_a - end_b)
        step = largest(a[-1][name] - end_a)
        ratio = (lambda d: d / scale) if scale else (lambda d: 0.0)
        rows.append(
            {
                "quantity": name,
                "unit": unit,
                "largest": scale,
                "difference": gone,
                "relative": ratio(gone),
                "relative_same_step": ratio(apart[-1]),
                "step_error": ratio(step),
                "observed_order": p,
                "order": order,
                "difference_order": order_of(apart[-2], apart[-1], scale),
            }
        )
    return rows
