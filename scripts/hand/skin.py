# SPDX-License-Identifier: Apache-2.0
"""The source's skin in the straight pose and with the lengths and breadths of a hand file: linear blend skinning."""
import numpy as np

from hand_numbers import unit
from hand_source import SEGMENTS

FINGERS = ["index", "middle", "ring", "pinky"]
KNUCKLES = 0.80, 0.72  # scales of breadth and thickness at the metacarpals' heads: the hand is then as broad and thick as [palm] states


def bones_of(digit):
    """The source's joints along a digit, 0 the thumb, up to its tip."""
    if digit == 0:
        return SEGMENTS[:3] + ["thumb-tip"]
    return SEGMENTS[3 * digit:3 * digit + 3] + [FINGERS[digit - 1] + "-finger-tip"]


def frame(origin, back, dorsal):
    """Rotation and origin of a frame with -Z along the bone and +Y out of the back."""
    z = unit(back)
    x = unit(np.cross(dorsal, z))
    return np.column_stack([x, np.cross(z, x), z]), np.asarray(origin, float)


def transported(v, old, new):
    """The vector v, turned by the smallest rotation that takes the direction `old` to `new`."""
    old, new = unit(old), unit(new)
    across = np.cross(old, new)
    return v + np.cross(across, v) + np.cross(across, np.cross(across, v)) / (1.0 + old @ new)


class Bone:
    """Maps points around a bone of the source to the same bone of the hand file: stretched along it, and across by a scale
    (breadth and thickness alike, or one each) that runs from one joint's to the other's."""

    def __init__(self, source, target, length, new_length, scale, end_scale):
        self.source, self.target = source, target
        self.length, self.new_length = length, new_length
        self.scale, self.end_scale = np.broadcast_to(scale, 2), np.broadcast_to(end_scale, 2)

    def __call__(self, points):
        R, origin = self.source
        p = (points - origin) @ R
        t = np.clip(-p[:, 2:] / self.length, 0, 1)
        across = self.scale + (self.end_scale - self.scale) * t
        p = np.hstack([p[:, :2] * across, p[:, 2:] * (self.new_length / self.length)])
        R, origin = self.target
        return p @ R.T + origin


def mean_radius(source, digit, k, bone_frame):
    """A quarter of breadth + thickness of the skin within 5 mm of the plane through the joint of segment k > 0."""
    R, origin = bone_frame
    p = (source.vertices - origin) @ R
    s = 3 * digit + k
    near = (np.abs(p[:, 2]) < 5) & (source.weight[:, s] + source.weight[:, s - 1] > 0.5)
    return (np.ptp(p[near, 0]) + np.ptp(p[near, 1])) / 4


def fitted_skin(source, digits):
    """Vertices of the source's skin [mm, frame H] with every joint of the hand file at angle 0. Returns them and, per digit, the
    scales across at its three joints."""
    bones, scales = {"wrist": lambda points: points}, []
    for d, digit in enumerate(digits):
        names = bones_of(d)
        joint = [source.joints[n] for n in names]
        frames = [frame(joint[k][:3, 3], joint[k][:3, 3] - joint[k + 1][:3, 3], joint[k][:3, 1]) for k in range(3)]
        length = [np.linalg.norm(joint[k + 1][:3, 3] - joint[k][:3, 3]) for k in range(2)]
        R, origin = frames[2]
        length.append(-((source.vertices - origin) @ R)[source.weight[:, 3 * d + 2] > 0.5, 2].min())  # to the skin's end
        new_length = digit.length[:2] + [digit.end]
        scale = [digit.radius[k] / mean_radius(source, d, k, frames[k]) for k in (1, 2)]
        # A finger's first joint has the palm's scale; the thumb's grows out of the thenar, which stays.
        scale = [1.0, 1.0, scale[1]] if d == 0 else [KNUCKLES] + scale
        scales.append(scale)
        target = digit.poses([0.0] * 4)
        if d == 0:  # The thumb's skin keeps its roll about the bones: the hand file's frames follow the joints' axes.
            new_back = -digit.frame[:, 0]
            target = [frame(p, new_back, transported(joint[k][:3, 1], frames[k][0][:, 2], new_back))
                      for k, (_, p) in enumerate(target)]
        for k in range(3):
            bones[names[k]] = Bone(frames[k], target[k], length[k], new_length[k], scale[k], scale[min(k + 1, 2)])
        bones[names[3]] = bones[names[2]]
        if d > 0:
            start = source.joints[FINGERS[d - 1] + "-finger-metacarpal"]
            base, dorsal, head = start[:3, 3], start[:3, 1], joint[0][:3, 3]
            bones[FINGERS[d - 1] + "-finger-metacarpal"] = Bone(
                frame(base, base - head, dorsal), frame(base, base - digit.base, dorsal),
                np.linalg.norm(head - base), np.linalg.norm(digit.base - base), 1.0, KNUCKLES)
    skin = np.zeros_like(source.vertices)
    for j, name in enumerate(source.joint_names):
        share = source.joint_weight[:, j:j + 1]
        if share.any():
            skin += share * bones[name](source.vertices)
    return skin / source.joint_weight.sum(1, keepdims=True), scales
