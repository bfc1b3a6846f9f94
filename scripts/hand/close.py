# SPDX-License-Identifier: Apache-2.0
"""Closes the segments' skins: domes around the joints, so that a segment turns in its neighbour like a ball in its socket."""
from collections import defaultdict

import numpy as np

from crossing import crossings
from cut import ROOTS
from hand_source import PALM

SLACK = 0.2      # [mm] a dome stays this much below what sweeps past it
INSIDE = 0.3     # [mm] and this much below the neighbour's skin
PROUD = {3: 1.0, 6: 1.5, 9: 2.0, 12: 2.5}  # [mm] except at the knuckles, where it may stand out of the skin's chords so much more
REACH = np.radians(18.0)  # directions within this of a dome's vertex count for its radius
RINGS = {1: 3, 6: 3, 9: 3, 12: 3}  # of domes at a segment's base; 2 elsewhere


def parent_of(segment):
    return PALM if segment % 3 == 0 else segment - 1


class Closer:
    def __init__(self, cut, digits):
        self.cut, self.digits = cut, digits
        self.points = list(cut.vertices)
        self.caps = defaultdict(list)
        self.rims, ends = {}, {}
        for k in range(PALM):
            for loop in cut.loops(k):
                if self.is_base(k, loop):
                    self.rims[k] = loop
                else:
                    ends[k] = loop
        rest = [d.poses([0.0] * 4) for d in digits]
        self.pose = [rest[k // 3][k % 3] for k in range(PALM)] + [(np.eye(3), np.zeros(3))]
        for k in range(PALM):
            self.close_base(k)
            if k in ends:
                self.fill(k, ends[k])
        for loop in cut.loops(PALM):
            self.fill(PALM, loop)
        self.points = np.array(self.points)
        self.meshes = [np.vstack([cut.triangles[cut.owner == k], np.array(self.caps[k], int)]) for k in range(PALM + 1)]
        for k in ROOTS + [PALM]:
            self.untangle(k)

    def is_base(self, k, loop):
        outside = [self.cut.across(e) for e in zip(loop, loop[1:] + loop[:1])]
        return 2 * sum(o == k + 1 and k % 3 < 2 for o in outside) < len(outside)

    def at(self, loop):
        return np.array([self.points[i] for i in loop])

    def relative(self, k, steps):
        """Poses of segment k in its parent over the range of motion."""
        digit = self.digits[k // 3]
        return [(q, *digit.relative(k % 3, q)) for q in digit.range_of(k % 3, steps)]

    def local(self, k, points):
        R, origin = self.pose[k]
        return (points - origin) @ R

    def world(self, k, points):
        R, origin = self.pose[k]
        return points @ R.T + origin

    def close_base(self, k):
        parent = parent_of(k)
        rim = self.local(parent, middles(self.at(self.rims[k])))
        swept = np.vstack([self.world(k, (rim - p) @ R) for _, R, p in self.relative(k, 13)])
        skin = np.isin(self.cut.owner, [k, parent] + (ROOTS if k in ROOTS else []))
        self.dome(k, self.rims[k], swept, skin, RINGS.get(k, 2))

    def dome(self, k, loop, swept, skin, count):
        """Rings of directions from the joint's centre, from the loop to the apex opposite the skin."""
        centre = self.pose[k][1]
        u0, r0 = polar(self.at(loop) - centre)
        n = len(loop)
        apex = -sum(np.cross(u0[i] * r0[i], u0[(i + 1) % n] * r0[(i + 1) % n]) for i in range(n))
        apex /= np.linalg.norm(apex)
        ways, far = polar(swept - centre)
        over_apex = far[ways @ apex > np.cos(REACH)]
        middle, rings = (np.median(r0) + (over_apex.max() if len(over_apex) else np.median(r0))) / 2, []
        # The loop in polar angles around the apex, its azimuth made to grow all the way round.
        x = np.cross(apex, u0[0])
        x /= np.linalg.norm(x)
        azimuth = np.unwrap(np.arctan2(u0 @ np.cross(apex, x), u0 @ x))
        turn = np.sign(azimuth[-1] - azimuth[0])
        azimuth = steadily(turn * azimuth)
        angle = np.arccos(np.clip(u0 @ apex, -1, 1))
        for j in range(count):
            t = (j + 1) / (count + 1)
            sides = n if t < 0.6 else max(5, n // 2)
            at = np.arange(sides) / sides * n
            first = at.astype(int)
            f = at - first
            following = (first + 1) % n
            step = (azimuth[following] - azimuth[first]) % (2 * np.pi)
            phi = turn * (azimuth[first] + f * step)
            theta = (angle[first] * (1 - f) + angle[following] * f) * (1 - t)
            u = np.cos(theta)[:, None] * apex + np.sin(theta)[:, None] * (
                np.cos(phi)[:, None] * x + np.sin(phi)[:, None] * np.cross(apex, x))
            r = r0[first] * (1 - f) + r0[following] * f
            rings.append((u, r * (1 - t) + middle * t))
        rings.append((apex[None], np.array([middle])))
        ids = [list(loop)]
        for u, r in rings:
            limit = first_hit(centre, u, self.cut.vertices[self.cut.triangles[skin]]) - INSIDE + PROUD.get(k, 0.0)
            for i, way in enumerate(u):
                close = ways @ way > np.cos(REACH)
                if close.any():
                    r[i] = max(r[i], far[close].max() - SLACK)
            r = np.minimum(r, limit)
            ids.append([self.add(centre + r[i] * u[i]) for i in range(len(u))])
        for a, b in zip(ids[:-1], ids[1:]):
            self.caps[k] += zipper(a, b)

    def untangle(self, segment):
        """Where a cap crosses itself its vertices move towards the middle of their neighbours, until none does."""
        triangles, own = self.meshes[segment], len(self.cut.vertices)
        for _ in range(60):
            crossing = {i for pair in crossings(self.points, triangles) for t in pair for i in t}
            moved = self.points.copy()
            for i in sorted(i for i in crossing if i >= own):
                ring = np.setdiff1d(triangles[(triangles == i).any(1)], [i])
                moved[i] = (self.points[i] + self.points[ring].mean(0)) / 2
            if not crossing or (moved == self.points).all():
                return
            self.points = moved

    def add(self, point):
        self.points.append(point)
        return len(self.points) - 1

    def fill(self, segment, loop):
        """The triangulation of least area without new vertices and without an edge that the skin has already."""
        P, n = self.at(loop), len(loop)
        cost, best = np.zeros((n, n)), np.zeros((n, n), int)
        for span in range(2, n):
            for i in range(n - span):
                j = i + span
                k = np.arange(i + 1, j)
                area = np.linalg.norm(np.cross(P[k] - P[i], P[j] - P[i]), axis=1) / 2
                total = cost[i, k] + cost[k, j] + area
                best[i, j] = k[total.argmin()]
                taken = (loop[i], loop[j]) in self.cut.edge and span < n - 1
                cost[i, j] = 1e12 if taken else total.min()
        open_spans = [(0, n - 1)]
        while open_spans:
            i, j = open_spans.pop()
            if j - i > 1:
                k = best[i, j]
                self.caps[segment].append((loop[j], loop[k], loop[i]))
                open_spans += [(i, k), (k, j)]


def middles(loop):
    return np.vstack([loop, (loop + np.roll(loop, -1, 0)) / 2])


def polar(points):
    r = np.linalg.norm(points, axis=1)
    return points / r[:, None], r


def steadily(azimuth):
    """The nearest angles that grow by at least a degree from vertex to vertex, and by one turn in all."""
    n, least = len(azimuth), np.radians(1.0)
    a = azimuth.copy()
    for _ in range(1000):
        gap = np.append(a[1:], a[0] + 2 * np.pi) - a
        i = int(gap.argmin())
        if gap[i] >= least - 1e-9:
            return a
        push = (least - gap[i]) / 2
        a[i] -= push
        a[(i + 1) % n] += push
    raise SystemExit("a rim does not run around its joint; has the source mesh changed?")


def first_hit(origin, ways, corners):
    """Distance from `origin` along each way to the first of the triangles, infinite if there is none."""
    a, e1, e2 = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    out = np.full(len(ways), np.inf)
    for i, way in enumerate(ways):
        h = np.cross(way, e2)
        with np.errstate(divide="ignore", invalid="ignore"):
            f = 1 / (e1 * h).sum(1)
            u = f * ((origin - a) * h).sum(1)
            q = np.cross(origin - a, e1)
            v, t = f * (q @ way), f * (e2 * q).sum(1)
        hit = (u >= -1e-9) & (v >= -1e-9) & (u + v <= 1 + 1e-9) & (t > 1e-6)
        if hit.any():
            out[i] = t[hit].min()
    return out


def zipper(a, b):
    """Triangles between two rings that run with the skin on their left, b beyond a."""
    if len(b) == 1:
        return [(a[(i + 1) % len(a)], a[i], b[0]) for i in range(len(a))]
    out, i, j, na, nb = [], 0, 0, len(a), len(b)
    while i < na or j < nb:
        if j >= nb or (i < na and (i + 1) * nb <= (j + 1) * na):
            out.append((a[(i + 1) % na], a[i % na], b[j % nb]))
            i += 1
        else:
            out.append((b[j % nb], b[(j + 1) % nb], a[i % na]))
            j += 1
    return out
