# SPDX-License-Identifier: GPL-2.0-or-later
"""Weighted least squares of y = a + b x, for the commands of this folder."""


def fit(points):
    """points: (x, y, u). Returns a, b, their covariance (aa, ab, bb) from the u alone, and chi^2 per degree of freedom.

    Bevington & Robinson, Data Reduction and Error Analysis, 3rd ed., 2003, eqs. 6.12 and 6.21-6.23. ValueError where
    there are fewer than three points or all x are the same.
    """
    if len(points) < 3 or len({x for x, _, _ in points}) < 2:
        raise ValueError("a line needs three points or more, at two x or more")
    w = [1 / u**2 for _, _, u in points]
    s, sx, sy = sum(w), sum(a * x for a, (x, _, _) in zip(w, points)), sum(a * y for a, (_, y, _) in zip(w, points))
    sxx, sxy = sum(a * x * x for a, (x, _, _) in zip(w, points)), sum(a * x * y for a, (x, y, _) in zip(w, points))
    d = s * sxx - sx**2
    a, b = (sxx * sy - sx * sxy) / d, (s * sxy - sx * sy) / d
    chi2 = sum(k * (y - a - b * x) ** 2 for k, (x, y, _) in zip(w, points)) / (len(points) - 2)
    return a, b, (sxx / d, -sx / d, s / d), chi2
