# SPDX-License-Identifier: Apache-2.0
"""Which triangle of the skin belongs to which segment, so that every cut is one clean loop around its joint."""
from collections import defaultdict

import numpy as np

from hand_source import PALM

ROOTS = [3, 6, 9, 12]   # the fingers' proximal phalanges
THUMB = 0               # the thumb's metacarpal
KNUCKLE_Z = -60.0       # [mm] palm nearer the wrist than this belongs to no finger
THUMB_BASE = 4.0        # [mm] the thumb's metacarpal begins this far before its joint
THUMB_REACH = 30.0      # [mm] farthest skin that the thumb's metacarpal takes from the palm
WEB_SHARE = 1.25        # of the web between thumb and index finger: the ratio of the distances to their bones where it is cut


def edges(t):
    return (t[0], t[1]), (t[1], t[2]), (t[2], t[0])


def to_bone(points, a, b):
    t = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
    return np.linalg.norm(points - a - t[:, None] * (b - a), axis=1)


class Cut:
    """owner (m,): segment of each triangle. Starts from the dominant joint; then the knuckles are cut where their joints are,
    the thumb's metacarpal at its joint and in the middle of the web, and islands, spikes and pinch vertices are cleaned away.
    Skin vertices on the knuckles' cut slide along the hand onto the line of the joints (`vertices`)."""

    def __init__(self, vertices, triangles, owner, digits, index_metacarpal):
        self.vertices, self.triangles, self.owner = vertices.copy(), triangles, owner.copy()
        self.edge = {e: i for i, t in enumerate(triangles) for e in edges(t)}
        self.pinches = []
        self.clean()
        self.cut_knuckles(digits)
        self.cut_thumb(digits, index_metacarpal)
        self.clean()
        self.slide_knuckles()

    def across(self, e):
        return self.owner[self.edge[(e[1], e[0])]]

    def neighbours(self, i):
        return [self.across(e) for e in edges(self.triangles[i])]

    def triangles_of(self, segment):
        return np.flatnonzero(self.owner == segment)

    def cut_knuckles(self, digits):
        joints = np.array([d.base for d in digits[1:]])
        self.beyond = lambda p: np.interp(p[:, 0], joints[:, 0], joints[:, 2]) - p[:, 2]
        centre = self.vertices[self.triangles].mean(1)
        distance = []
        for d in digits[1:]:
            x = d.frame[:, 0]
            r = centre - d.base
            r -= (r @ x)[:, None] * x
            distance.append(np.linalg.norm(r * [1.0, 1.0, 1.0], axis=1))
        finger = np.array(ROOTS)[np.argmin(distance, 0)]
        near = centre[:, 2] < KNUCKLE_Z
        distal = self.beyond(centre) > 0
        roots = np.isin(self.owner, ROOTS)
        take = near & distal & (self.owner == PALM)
        self.owner[near & ~distal & roots] = PALM
        self.owner[take] = finger[take]

    def cut_thumb(self, digits, index_metacarpal):
        (R, base), (_, end) = digits[0].poses([0.0] * 4)[:2]
        centre = self.vertices[self.triangles].mean(1)
        behind = ((centre - base) @ R)[:, 2] > THUMB_BASE
        self.owner[(self.owner == THUMB) & behind] = PALM
        own, index = to_bone(centre, base, end), to_bone(centre, index_metacarpal, digits[1].base)
        self.owner[(self.owner == PALM) & ~behind & (own < WEB_SHARE * index) & (own < THUMB_REACH)] = THUMB
        self.clean()
        # The web's skin must not join the thumb's proximal phalanx to the palm.
        shared = set(self.triangles[self.owner == 1].ravel()) & set(self.triangles[self.owner == PALM].ravel())
        for i in self.triangles_of(1):
            if set(self.triangles[i]) & shared:
                self.owner[i] = THUMB

    def slide_knuckles(self):
        palm = set(self.triangles[self.owner == PALM].ravel())
        rim = np.array(sorted(palm & set(self.triangles[np.isin(self.owner, ROOTS)].ravel())))
        for _ in range(3):
            self.vertices[rim, 2] += np.clip(self.beyond(self.vertices[rim]), -4, 4)

    def parts(self, triangles, vertex=None):
        """Parts that hang together over edges (over edges at `vertex`)."""
        left, out = set(triangles), []
        while left:
            part = [min(left)]
            left.discard(part[0])
            for i in part:
                for a, b in edges(self.triangles[i]):
                    j = self.edge[(b, a)]
                    if j in left and (vertex is None or vertex in (a, b)):
                        left.discard(j)
                        part.append(j)
            out.append(sorted(part))
        return sorted(out, key=lambda p: (len(p), p))

    def give_away(self, part, segment):
        others = [o for i in part for o in self.neighbours(i) if o != segment]
        if others:
            self.owner[part] = max(sorted(set(others)), key=others.count)
        return bool(others)

    def clean(self):
        for _ in range(100):
            before = self.owner.copy()
            for k in range(PALM + 1):
                for part in self.parts(self.triangles_of(k))[:-1]:
                    self.give_away(part, k)
            for i in range(len(self.triangles)):
                around = self.neighbours(i)
                for other in sorted(set(around)):
                    if other != self.owner[i] and around.count(other) >= 2:
                        self.owner[i] = other
                        break
            for k in range(PALM + 1):
                starts = defaultdict(int)
                for i in self.triangles_of(k):
                    for e in edges(self.triangles[i]):
                        starts[e[0]] += self.across(e) != k
                for v in sorted(v for v in starts if starts[v] > 1):
                    fans = self.parts([i for i in self.triangles_of(k) if v in self.triangles[i]], v)
                    if len(fans) > 1:
                        self.give_away(fans[0], k)
                        self.pinches.append((k, int(v)))
            if (before == self.owner).all():
                return
        raise SystemExit("the cuts do not settle; has the source mesh changed?")

    def loops(self, segment):
        """Border loops of a segment's skin, the skin on their left."""
        following = {}
        for i in self.triangles_of(segment):
            for e in edges(self.triangles[i]):
                if self.across(e) != segment:
                    following[e[0]] = e[1]
        out = []
        while following:
            loop = [min(following)]
            after = following.pop(loop[0])
            while after != loop[0]:
                loop.append(after)
                after = following.pop(after)
            out.append(loop)
        return out
