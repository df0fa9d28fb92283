# SPDX-License-Identifier: GPL-2.0-or-later
"""A Gaussian process over the unit cube (OpenTURNS: linear trend, squared exponential, lengths by maximum likelihood)."""
import math


def emulate(units, values, u):
    """Gaussian process; returns (function of points -> means, sds) and the leave-one-out standard error."""
    import numpy as np
    import openturns as ot

    ot.Log.Show(ot.Log.NONE)
    dimension = len(units[0])
    centre, scale = float(np.mean(values)), float(np.std(values)) or 1.0
    x, y = ot.Sample(units), ot.Sample([[(v - centre) / scale] for v in values])
    noise = [max(s / scale, 0.02) ** 2 for s in u]  # 2 % of the spread at least: keeps the matrix regular

    def process(keep, lengths=None):
        model = ot.SquaredExponential(list(lengths or [0.7] * dimension))
        method = ot.KrigingAlgorithm(
            ot.Sample([units[i] for i in keep]),
            ot.Sample([list(y[i]) for i in keep]),
            model,
            ot.LinearBasisFactory(dimension).build(),
        )
        method.setNoise([noise[i] for i in keep])
        if lengths:
            method.setOptimizeParameters(False)
        else:
            method.setOptimizationBounds(ot.Interval([0.2] * dimension, [5.0] * dimension))
        method.run()
        return method.getResult()

    everyone = list(range(len(units)))
    whole = process(everyone)
    lengths = list(whole.getCovarianceModel().getScale())
    errors = []
    for i in everyone:
        without = process([k for k in everyone if k != i], lengths)
        errors.append(float(without.getMetaModel()(x[i])[0]) - float(y[i, 0]))
    loo = scale * math.sqrt(sum(e * e for e in errors) / len(errors))

    def at(points):
        sample = ot.Sample(points)
        mean = whole.getMetaModel()(sample)
        sd = [math.sqrt(max(0.0, v[0])) for v in whole.getConditionalMarginalVariance(sample)]
        return centre + scale * np.array(mean).ravel(), scale * np.array(sd)

    return at, loo, lengths
