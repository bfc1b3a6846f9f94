# SPDX-License-Identifier: Apache-2.0
"""What the finished meshes are held against: closed, no crossing triangles, no gap where two segments meet."""
from collections import Counter

import numpy as np

from close import parent_of
from crossing import crossings
from cut import edges


def faults(points, triangles):
    """In words what keeps a mesh from being one closed surface that winds outwards."""
    out = []
    count = Counter(tuple(map(int, e)) for t in triangles for e in edges(t))
    bad = [e for e in count if count[e] != 1 or count.get(e[::-1], 0) != 1]
    if bad:
        out.append(f"{len(bad)} edges without exactly one partner")
    a, b, c = (points[triangles[:, k]] for k in range(3))
    if np.einsum("ij,ij->", a, np.cross(b, c)) <= 0:
        out.append("winds inwards")
    flat = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    if flat.min() < 0.01:
        out.append(f"{(flat < 0.01).sum()} triangles below 0.01 mm2")
    crossing = crossings(points, triangles)
    if crossing:
        out.append(f"{len(crossing)} edges run through a triangle")
    return out


def outside(p, points, triangles):
    """Distance of points from a closed mesh, negative inside."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    square = (normal * normal).sum(1)
    out = np.empty(len(p))
    for n, x in enumerate(p):
        u, v, w = a - x, b - x, c - x
        lu, lv, lw = (np.linalg.norm(y, axis=1) for y in (u, v, w))
        solid = 2 * np.arctan2((u * np.cross(v, w)).sum(1),
                               lu * lv * lw + (u * v).sum(1) * lw + (v * w).sum(1) * lu + (w * u).sum(1) * lv).sum()
        height = (normal * (x - a)).sum(1)
        foot = x - (height / square)[:, None] * normal
        over = np.ones(len(a), bool)
        best = np.inf
        for e0, e1 in ((a, b), (b, c), (c, a)):
            over &= (np.cross(e1 - e0, foot - e0) * normal).sum(1) >= 0
            along = e1 - e0
            t = np.clip(((x - e0) * along).sum(1) / (along * along).sum(1), 0, 1)
            best = min(best, np.linalg.norm(e0 + t[:, None] * along - x, axis=1).min())
        if over.any():
            best = min(best, (np.abs(height) / np.sqrt(square))[over].min())
        out[n] = -best if solid > 2 * np.pi else best
    return out


def rim_points(closer, k):
    """Pairs of neighbouring vertices along which the skin of segment k was cut from its parent's."""
    rim = closer.rims[k]
    return [e for e in zip(rim, rim[1:] + rim[:1]) if closer.cut.across(e) == parent_of(k)]


def gaps(closer, k, steps):
    """Worst over the range of motion, per point of the rim between segment k and its parent (ends, then middles): how far the
    point on the one or on the other segment, whichever is nearer, is outside the other segment [mm]; and where."""
    parent = parent_of(k)
    pairs = rim_points(closer, k)
    ends = sorted({i for e in pairs for i in e})
    at = closer.points
    points = np.vstack([at[ends], [(at[i] + at[j]) / 2 for i, j in pairs]])
    own, others = closer.local(k, points), closer.local(parent, points)
    mesh = {s: closer.local(s, at) for s in (k, parent)}
    worst, where = np.full(len(points), -np.inf), [None] * len(points)
    for q, R, p in closer.relative(k, steps):
        gap = outside((others - p) @ R, mesh[k], closer.meshes[k])
        open_ = gap > 0
        if open_.any():
            gap[open_] = np.minimum(gap[open_], outside(own[open_] @ R.T + p, mesh[parent], closer.meshes[parent]))
        for i in np.flatnonzero(gap > worst):
            worst[i], where[i] = gap[i], q
    return ends, points, worst, where
