#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the continuous skin assets/hands/generic/skin.json from the WebXR generic hand. See README.md there."""
import argparse
import json
import pathlib

import numpy as np

from hand_numbers import read_hand
from hand_source import SEGMENTS, HandSource
from skin import fitted_skin

LEAST_SHARE = 0.01  # a segment that moves a vertex by less than this share of its own motion is left out
UNITS = 10000       # a weight is a whole number of these parts, so that a vertex's weights add up to 1 exactly
HEADER = {
    "source": "hand model of npm @webxr-input-profiles/assets 1.0.20, dist/profiles/generic-hand/right.glb, Copyright (c) 2019 Amazon; "
              "welded and fitted to assets/hands/adult.toml by scripts/hand/make_skin.py",
    "licence": "MIT (LICENSE.txt beside this file)",
    "frame": "the hand frame H of a right hand, all joints at zero",
    "segments": SEGMENTS,
}


def shares(weight):
    """Per vertex its segments with their weights in UNITS, the heaviest first: the shares' sum is rounded, not each share alone."""
    out = []
    for row in weight:
        kept = sorted(np.flatnonzero(row >= LEAST_SHARE * row.sum()).tolist(), key=lambda k: (-row[k], k))[:4]
        exact = row[kept] * (UNITS / row[kept].sum())
        units = np.floor(exact).astype(int)
        left = UNITS - units.sum()
        for i in sorted(range(len(kept)), key=lambda i: (units[i] - exact[i], i))[:left]:
            units[i] += 1
        out.append([(k, n) for k, n in zip(kept, units.tolist())])
    return out


def lines(rows):
    return ",\n".join("  " + row for row in rows)


def write(path, vertices, triangles, influences):
    header = json.dumps(HEADER, indent=1)[:-2]
    places = ["[%s]" % ", ".join(("%.3f" % (x + 0.0)).replace("-0.000", "0.000") for x in v) for v in vertices]
    weights = ["[%s]" % ", ".join("[%d, %.4f]" % (k, n / UNITS) for k, n in row) for row in influences]
    corners = ["[%d, %d, %d]" % tuple(t) for t in triangles.tolist()]
    path.write_text(f'{header},\n "vertices_mm": [\n{lines(places)}\n ],\n "influences": [\n{lines(weights)}\n ],\n'
                    f' "triangles": [\n{lines(corners)}\n ]\n}}\n')


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("source", type=pathlib.Path, help="folder with the npm package's right.glb")
    parser.add_argument("hand", type=pathlib.Path, help="hand file whose lengths and breadths the skin gets")
    parser.add_argument("out", type=pathlib.Path, help="the .json file to write")
    options = parser.parse_args()
    right = HandSource(options.source / "right.glb")
    digits, _ = read_hand(options.hand)
    vertices, _ = fitted_skin(right, digits)
    influences = shares(right.weight)
    write(options.out, vertices, right.triangles, influences)
    count = np.bincount([len(row) for row in influences], minlength=5)[1:]
    print(f"{len(vertices)} vertices, {len(right.triangles)} triangles; vertices with 1 to 4 segments: {', '.join(map(str, count))}")


if __name__ == "__main__":
    main()
