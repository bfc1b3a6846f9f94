# SPDX-License-Identifier: Apache-2.0
"""Triangles of one mesh that cross."""
import numpy as np

from cut import edges


def crossings(points, triangles):
    """Pairs (corners of a triangle with the edge, corners of the triangle that the edge runs through) without a common vertex."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    low, high = np.minimum(np.minimum(a, b), c), np.maximum(np.maximum(a, b), c)
    out, owner = [], {tuple(sorted(map(int, e))): tuple(map(int, t)) for t in triangles for e in edges(t)}
    for (i, j), of in sorted(owner.items()):
        p, d = points[i], points[j] - points[i]
        near = ((low <= np.maximum(p, p + d)) & (high >= np.minimum(p, p + d))).all(1)
        near &= ~((triangles == i) | (triangles == j)).any(1)
        for k in np.flatnonzero(near):
            e1, e2 = b[k] - a[k], c[k] - a[k]
            h = np.cross(d, e2)
            det = e1 @ h
            if abs(det) < 1e-12:
                continue
            u = (p - a[k]) @ h / det
            q = np.cross(p - a[k], e1)
            v, t = d @ q / det, e2 @ q / det
            if u > 0 and v > 0 and u + v < 1 and 0 < t < 1:
                out.append((of, tuple(map(int, triangles[k]))))
    return out
