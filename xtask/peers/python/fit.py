"""Answers fitting jobs with pyransac3d; ../README.md says how they are written.

It has neither constraints nor a stopping rule nor a refit: bounds and confidence are not used.
"""

import random
import sys
import time

import numpy as np
import pyransac3d


def answer(primitive, file, hypotheses, _confidence, threshold, _min, _max, seed, *_point):
    points = np.fromfile(file, dtype="<f4").reshape(-1, 3).astype(np.float64)
    random.seed(int(seed))
    shape = pyransac3d.Sphere() if primitive == "sphere" else pyransac3d.Line()
    start = time.perf_counter()
    shape.fit(points, thresh=float(threshold), maxIteration=int(hypotheses))
    milliseconds = 1e3 * (time.perf_counter() - start)
    if len(shape.inliers) == 0:
        model = []
    elif primitive == "sphere":
        model = [*shape.center, shape.radius]
    else:
        model = [*shape.B, *shape.A]
    return [milliseconds, hypotheses, *(float(number) for number in model)]


# Coplanar samples give spheres without end, which it scores as well.
np.seterr(all="ignore")
for line in sys.stdin:
    print(*answer(*line.split()), flush=True)
