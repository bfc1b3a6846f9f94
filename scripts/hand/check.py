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


def dot(a, b):
    return np.einsum("...i,...i", a, b)


def outside(p, points, triangles):
    """Distance of points from a closed mesh, negative inside."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    normal = np.cross(b - a, c - a)
    square = dot(normal, normal)
    x = p[:, None]
    u, v, w = a - x, b - x, c - x  # (point, triangle, 3)
    lu, lv, lw = (np.linalg.norm(y, axis=2) for y in (u, v, w))
    solid = 2 * np.arctan2(dot(u, np.cross(v, w)), lu * lv * lw + dot(u, v) * lw + dot(v, w) * lu + dot(w, u) * lv).sum(1)
    height = -dot(normal, u)
    over = np.ones(height.shape, bool)
    best = np.full(len(p), np.inf)
    for from_start, start, end in ((u, a, b), (v, b, c), (w, c, a)):
        along = end - start
        over &= dot(np.cross(normal, along), -from_start) >= 0
        t = np.clip(-dot(from_start, along) / dot(along, along), 0, 1)
        best = np.minimum(best, np.linalg.norm(from_start + t[..., None] * along, axis=2).min(1))
    best = np.minimum(best, np.where(over, np.abs(height) / np.sqrt(square), np.inf).min(1))
    return np.where(solid > 2 * np.pi, -best, best)


def rim_points(closer, k):
    """Pairs of neighbouring vertices along which the skin of segment k was cut from its parent's."""
    rim = closer.rims[k]
    return [e for e in zip(rim, rim[1:] + rim[:1]) if closer.cut.across(e) == parent_of(k)]


def gaps(closer, k, steps, reach=np.inf):
    """The edges of the rim between segment k and its parent, within `reach` of the joint [mm]; their points, sorted ends, then
    middles; and per point the worst over the range of motion: how far the point on the one or on the other segment, whichever is
    nearer, is outside the other segment [mm], and where."""
    parent = parent_of(k)
    pairs = [e for e in rim_points(closer, k) if np.linalg.norm(closer.points[list(e)] - closer.pose[k][1], axis=1).max() < reach]
    ends = sorted({i for e in pairs for i in e})
    at = closer.points
    points = np.vstack([at[ends], [(at[i] + at[j]) / 2 for i, j in pairs]])
    own, others = closer.local(k, points), closer.local(parent, points)
    mesh = {s: closer.local(s, at) for s in (k, parent)}
    worst, where = np.full(len(points), -np.inf), [None] * len(points)
    near, seen = np.full(len(points), np.inf), np.zeros_like(points)  # the first distance where it was last computed
    for q, R, p in closer.relative(k, steps):
        place = (others - p) @ R
        # A distance changes by no more than the point moves; most points stay deep inside at most poses.
        todo = np.flatnonzero(near + np.linalg.norm(place - seen, axis=1) > worst)
        if not len(todo):
            continue
        gap = near[todo] = outside(place[todo], mesh[k], closer.meshes[k])
        seen[todo] = place[todo]
        gap = gap.copy()
        open_ = gap > np.maximum(worst[todo], 0.0)
        if open_.any():
            gap[open_] = np.minimum(gap[open_], outside(own[todo[open_]] @ R.T + p, mesh[parent], closer.meshes[parent]))
        for i, width in zip(todo, gap):
            if width > worst[i]:
                worst[i], where[i] = width, q
    return pairs, points, worst, where
