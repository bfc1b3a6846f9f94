# SPDX-License-Identifier: Apache-2.0
"""The numbers of a hand file and the kinematics that src/hand/hand_model.cpp computes from them, in millimetres."""
import tomllib

import numpy as np

DIGITS = ["thumb", "index", "middle", "ring", "little"]
# [lengths] of assets/hands/adult.toml: bone + soft tip is where the finger ends
SOFT_TIP_MM = {"thumb": 5.67, "index": 3.84, "middle": 3.95, "ring": 3.95, "little": 3.73}


def unit(v):
    return np.asarray(v, float) / np.linalg.norm(v)


def turn(axis, angle):
    """Rotation about a unit vector, in rad."""
    x, y, z = axis
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * K @ K


class Digit:
    """One digit of the hand file; angles in degrees."""

    def __init__(self, name, table):
        self.name = name
        self.base = np.array(table["base_mm"], float)
        x = unit(table["distal"])
        z = unit(np.cross(table["dorsal"], x))
        self.frame = np.column_stack([x, np.cross(z, x), z])  # D-H base: x distal, z the flexion axis
        self.rows = [(j["a_mm"], np.radians(j["alpha_deg"])) for j in table["joints"]]
        pronation = table.get("pronation", {})
        self.pronation = pronation.get("per_flexion", 0.0), pronation.get("per_abduction", 0.0)
        metacarpal = table.get("metacarpal", {})
        self.metacarpal = metacarpal.get("per_flexion", 0.0)
        self.metacarpal_base = np.array(metacarpal.get("base_mm", (0, 0, 0)), float)
        self.metacarpal_axis = unit(metacarpal.get("axis", (-1, 0, 0)))
        self.limits = [(j["min_deg"], j["max_deg"]) for j in table["joints"]]
        if any(j["d_mm"] or j["theta_deg"] for j in table["joints"]):
            raise SystemExit(f"hand file: digit {name} has an offset d_mm or theta_deg; this program knows rows without them")
        self.length = [j["a_mm"] for j in table["joints"][1:]]
        self.radius = [table["segments"][0]["radius_base_mm"]] + [s["radius_tip_mm"] for s in table["segments"]]
        self.end = self.length[2] + SOFT_TIP_MM[name]  # of the distal segment, from its joint

    def poses(self, angles_deg):
        """Rotation and origin of the three segments in the hand frame H at four joint angles."""
        q0, q1 = np.radians(angles_deg[:2])
        M = turn(self.metacarpal_axis, self.metacarpal * q0)
        R, p, out = M @ self.frame, self.metacarpal_base + M @ (self.base - self.metacarpal_base), []
        for i, ((a, alpha), q) in enumerate(zip(self.rows, np.radians(angles_deg))):
            c, s, ca, sa = np.cos(q), np.sin(q), np.cos(alpha), np.sin(alpha)
            p = p + R @ (a * np.array([c, s, 0.0]))
            R = R @ np.array([[c, -s * ca, s * sa], [s, c * ca, -c * sa], [0.0, sa, ca]])
            if i == 1:
                R = R @ turn((-1.0, 0.0, 0.0), self.pronation[0] * q0 + self.pronation[1] * q1)
            if i:
                out.append((np.column_stack([-R[:, 2], -R[:, 1], -R[:, 0]]), p - a * R[:, 0]))
        return out

    def relative(self, k, angles_deg):
        """Rotation and origin of segment k in the frame of what it hangs on: H for k = 0, else segment k - 1."""
        q = [0.0] * 4
        for joint, angle in zip((0, 1) if k == 0 else (k + 1,), angles_deg):
            q[joint] = angle
        poses = self.poses(q)
        if k == 0:
            return poses[0]
        (Ra, pa), (Rb, pb) = poses[k - 1], poses[k]
        return Ra.T @ Rb, Ra.T @ (pb - pa)

    def range_of(self, k, steps):
        """A grid over the range of motion of the joint(s) that move segment k, in the order of relative()."""
        axes = [np.linspace(*self.limits[i], steps) for i in ((0, 1) if k == 0 else (k + 1,))]
        return np.stack([g.ravel() for g in np.meshgrid(*axes, indexing="ij")], 1)


def read_hand(path):
    with open(path, "rb") as file:
        table = tomllib.load(file)
    return [Digit(name, table[name]) for name in DIGITS], table["palm"]
