#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the sixteen segment meshes of assets/hands/generic from the WebXR generic hand. See README.md there."""
import argparse
import pathlib

import numpy as np

from check import faults, gaps, rim_points
from close import Closer, parent_of
from cut import ROOTS, Cut
from hand_numbers import read_hand
from hand_source import PALM, SEGMENTS, HandSource, mirror_deviation
from skin import fitted_skin

ALLOWED = 0.7      # [mm] a rim point that gaps more is drawn towards its joint
ROOT_ALLOWED = 0.8  # [mm] the same at the fingers' roots
CMC_ALLOWED = 0.4  # [mm] the same at the thumb's CMC joint,
CMC_REACH = 18.0   # [mm] as far as this from it: farther out is the web
ROUNDS = 24        # of drawing
STEPS = 13         # of each angle's range of motion
HEADER = """# SPDX-License-Identifier: MIT
# Source: hand model of npm @webxr-input-profiles/assets 1.0.20, dist/profiles/generic-hand/right.glb, Copyright (c) 2019 Amazon,
# MIT licence (LICENSE.txt beside this file); cut, closed and fitted to assets/hands/adult.toml by scripts/hand/make_hand_meshes.py.
# Segment {name} of a right hand: millimetres, origin in the segment's joint, -Z along the bone, +Y out of the back.
"""


def closed_without_gaps(cut, digits):
    """Draws rim points that still gap towards their joint, a little at a time, and closes again. Neighbouring roots share rim
    points, so that a draw for one may open a gap at the other: the closing with the least excess counts."""
    best, least = None, np.inf
    for _ in range(ROUNDS):
        closer = Closer(cut, digits)
        draws, excess = [], 0.0
        for k in range(PALM):
            allowed = CMC_ALLOWED if k == 0 else ROOT_ALLOWED if k in ROOTS else ALLOWED
            pairs, _, worst, _ = gaps(closer, k, STEPS, np.inf if k else CMC_REACH)
            ends = sorted({i for e in pairs for i in e})
            wide = {i for i, gap in zip(ends, worst) if gap > allowed}
            wide |= {i for e, gap in zip(pairs, worst[len(ends):]) if gap > allowed for i in e}
            draws += [(k, i) for i in sorted(wide)]
            excess = max(excess, worst.max() - allowed)
        if excess < least and not any(faults(closer.points, mesh) for mesh in closer.meshes):
            best, least = closer, excess
        if not draws:
            break
        for k, i in draws:
            way = cut.vertices[i] - closer.pose[k][1]
            cut.vertices[i] -= way / np.linalg.norm(way) * 0.2
    return best or closer


def write(closer, folder):
    number = []
    for k in range(PALM + 1):
        used = np.unique(closer.meshes[k])
        number.append(dict(zip(used.tolist(), range(1, len(used) + 1))))
    for k, name in enumerate(SEGMENTS):
        lines = [HEADER.format(name=name)]
        if k < PALM:
            parent = parent_of(k)
            lines.append(f"# rim: vertices of this mesh / of {SEGMENTS[parent]} along which the two were cut apart, edge by edge\n")
            pairs = [" ".join(f"{number[k][i]}/{number[parent][i]}" for i in e) for e in rim_points(closer, k)]
            lines += ["# rim " + ", ".join(pairs[i:i + 8]) + "\n" for i in range(0, len(pairs), 8)]
        lines.append(f"o {name}\n")
        local = closer.local(k, closer.points)
        lines += ["v %.3f %.3f %.3f\n" % tuple(local[i] + 0.0) for i in number[k]]
        lines += ["f %d %d %d\n" % tuple(number[k][i] for i in t) for t in closer.meshes[k].tolist()]
        (folder / f"{name}.obj").write_text("".join(lines).replace("-0.000", "0.000"))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("source", type=pathlib.Path, help="folder with the npm package's right.glb and left.glb")
    parser.add_argument("hand", type=pathlib.Path, help="hand file whose lengths and breadths the meshes get")
    parser.add_argument("out", type=pathlib.Path, help="folder for the sixteen .obj files")
    options = parser.parse_args()
    right, left = HandSource(options.source / "right.glb"), HandSource(options.source / "left.glb")
    print(f"{len(right.triangles)} triangles, {len(right.vertices)} vertices; the left hand's mirror image deviates by "
          f"{mirror_deviation(right, left):.4f} mm")
    digits, _ = read_hand(options.hand)
    skin, scales = fitted_skin(right, digits)
    for digit, scale in zip(digits, scales):
        joints = (" x ".join(f"{s:.3f}" for s in np.atleast_1d(joint)) for joint in scale)
        print(f"{digit.name}: scales across at its joints", "; ".join(joints))
    cut = Cut(skin, right.triangles, right.owner, digits, right.joints["index-finger-metacarpal"][:3, 3])
    print("pinch vertices cleaned:", ", ".join(f"{v} of {SEGMENTS[k]}" for k, v in cut.pinches) or "none")
    closer = closed_without_gaps(cut, digits)
    options.out.mkdir(parents=True, exist_ok=True)
    write(closer, options.out)
    for k, name in enumerate(SEGMENTS):
        line = f"{name:36s} {len(closer.meshes[k]):5d} triangles"
        if k < PALM:
            _, points, worst, where = gaps(closer, k, STEPS)
            i = worst.argmax()
            if k == 0:
                near = np.linalg.norm(closer.local(k, points), axis=1) < 14
                line += f", gap near the joint {worst[near].max():5.2f} mm"
            line += f", worst gap {worst[i]:5.2f} mm at {np.round(where[i], 1)} deg, {np.round(closer.local(k, points[i]), 1)}"
        print(line, *faults(closer.local(k, closer.points), closer.meshes[k]), sep="; ")
    print(sum(map(len, closer.meshes)), "triangles")
    return closer, digits


if __name__ == "__main__":
    main()
