"""Whether two OBJ files have the same surface: every vertex of each has one of the other nearby.

Programs split and merge vertices as they like, so neither counts nor order can be compared.
"""

import math
import sys


def vertices(path):
    with open(path, encoding="utf-8") as text:
        return [tuple(map(float, line.split()[1:4])) for line in text if line.startswith("v ")]


def farthest(points, others, cell):
    """The largest distance from a point to the nearest other one, as far as two cells tell it."""
    grid = {}
    for other in others:
        grid.setdefault(tuple(math.floor(x / cell) for x in other), []).append(other)
    worst = 0.0
    for point in points:
        at = tuple(math.floor(x / cell) for x in point)
        near = (
            math.dist(point, other)
            for i in (-1, 0, 1)
            for j in (-1, 0, 1)
            for k in (-1, 0, 1)
            for other in grid.get((at[0] + i, at[1] + j, at[2] + k), ())
        )
        worst = max(worst, min(near, default=math.inf))
    return worst


ours, theirs = vertices(sys.argv[1]), vertices(sys.argv[2])
size = max(max(axis) - min(axis) for axis in zip(*ours))
off = max(farthest(ours, theirs, size * 0.01), farthest(theirs, ours, size * 0.01)) / size
print(f"{sys.argv[3]}: {len(ours)} and {len(theirs)} vertices, at most {off:.2e} of the size apart")
# Text formats print six digits.
sys.exit(0 if ours and theirs and off <= 1e-4 else f"expected at most 1e-4 of the size, found {off}")
