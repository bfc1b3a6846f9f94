# SPDX-License-Identifier: Apache-2.0
"""S1 fig. 8: which joints of the index finger carry torque in seven situations with a ball.

S1 is Feng, Li, IEEE ROBIO 2010. By its equations (3) to (5) a contact loads every joint between it and the palm,
and no other. From the open hand the finger moves to a posture; then one joint after the other flexes until its
segment meets the ball, and a few degrees more.
"""
from dataclasses import dataclass

import numpy as np
import phalanx

from figure import BLUE, GREY, ORANGE, arguments, plt, save

HAND = {"hand.file": "papers", "hand.meshes": "capsules", "hand.coupling": "none"}
JOINTS = [phalanx.joint(f"index_{name}") for name in ("mcp_flexion", "pip_flexion", "dip_flexion")]
SEGMENTS = [phalanx.segment(f"index-finger-{name}")
            for name in ("phalanx-proximal", "phalanx-intermediate", "phalanx-distal")]
SPEED = np.radians(20)  # of a closing joint [rad/s]


@dataclass
class Situation:
    """One frame of the figure."""

    title: str
    posture_deg: tuple  # of the three joints, in which segment `under` touches the ball
    under: int  # 0 proximal, 1 middle, 2 distal
    along: float  # place of the ball along that segment, as a part of its length
    diameter_m: float
    closings: tuple  # joint, segment that has to touch, degrees further
    snapshot: object = None
    centre_m: object = None
    shapes_m: object = None


def situations():
    """Returns the seven situations; (b), (c) and (d) are one grasp."""
    b, c, d = (0, 0, 4), (1, 1, 6), (2, 2, 8)
    grasp = ((35, 5, 5), 0, 0.65, 0.04)
    return [
        Situation("(a) free", *grasp, ()),
        Situation("(b) proximal", *grasp, (b,)),
        Situation("(c) + middle", *grasp, (b, c)),
        Situation("(d) + distal", *grasp, (b, c, d)),
        Situation("(e) distal", (25, 10, 5), 2, 0.5, 0.04, ((0, 2, 2),)),
        Situation("(f) distal, flexed", (40, 30, 20), 2, 0.5, 0.03, ((0, 2, 2),)),
        Situation("(g) middle", (35, 25, 0), 1, 0.5, 0.03, ((0, 1, 3),)),
    ]


def move(stepper, angle, target, seconds):
    """Moves in a straight line; returns the new angles and the last snapshot."""
    rows = np.linspace(angle, target, round(seconds * stepper.rate_hz) + 1)[1:]
    stepper.steps(rows, columns=[])
    return target, stepper.snapshot()


def play(situation):
    """Plays one situation and keeps its last step, when everything is at rest."""
    empty = phalanx.Stepper(phalanx.Scene.from_text("", set=HAND))
    angle = np.array(empty.open_angle_rad)
    touch = angle.copy()
    touch[JOINTS] = np.radians(situation.posture_deg)
    segment = SEGMENTS[situation.under]
    position, rotation = (part[segment] for part in empty.poses(touch))
    length, base, tip = empty.segment_shapes_m[segment]
    radius = base + situation.along * (tip - base) + situation.diameter_m / 2
    away = 0.0 if situation.closings else 0.03  # out of reach
    situation.centre_m = position + rotation @ [0.0, -(radius + away), -situation.along * length]
    situation.shapes_m = empty.segment_shapes_m
    ball = {"kind": "sphere", "diameter_mm": 1e3 * situation.diameter_m, "triangles": 2000,
            "position_mm": 1e3 * situation.centre_m}
    stepper = phalanx.Stepper(phalanx.Scene.from_text("", set={**HAND, "objects": [ball]}))
    before = touch.copy()
    if situation.closings:
        before[JOINTS[0]] -= np.radians(20)
    angle, snapshot = move(stepper, angle, before, 0.5)
    for joint, part, further in situation.closings:
        for _ in range(round(np.radians(110) / SPEED * stepper.rate_hz)):
            if snapshot.contact[SEGMENTS[part]]:
                break
            angle[JOINTS[joint]] += SPEED / stepper.rate_hz
            snapshot = stepper.step(angle)
        pressed = angle.copy()
        pressed[JOINTS[joint]] += np.radians(further)
        angle, snapshot = move(stepper, angle, pressed, np.radians(further) / SPEED)
    _, situation.snapshot = move(stepper, angle, angle.copy(), 0.5)
    return situation


def compute():
    """Returns the seven situations with their last steps."""
    return [play(situation) for situation in situations()]


def outline(position, rotation, shape):
    """Returns a tapered capsule seen from the side: distal to the right, the finger's back up [mm]."""
    length, base, tip = 1e3 * shape
    slope = np.arcsin(np.clip((base - tip) / length, -1, 1))
    far = np.linspace(np.pi / 2 - slope, -np.pi / 2 + slope, 40)
    near = np.linspace(-np.pi / 2 + slope, -3 * np.pi / 2 - slope, 40)
    along = np.concatenate([length + tip * np.cos(far), base * np.cos(near)])
    across = np.concatenate([tip * np.sin(far), base * np.sin(near)])
    points = np.outer(along, -rotation[:, 2]) + np.outer(across, rotation[:, 1]) + 1e3 * position
    return -points[:, 2], points[:, 1]


def draw(played):
    """Draws each situation from the side, and the torques below it."""
    figure, axes = plt.subplots(2, len(played), figsize=(15, 5), sharey="row", layout="constrained",
                                height_ratios=(3, 2))
    largest = max(abs(1e3 * s.snapshot.torque_nm[JOINTS]).max() for s in played)
    strongest = max(s.snapshot.force_n.max() for s in played)
    for column, s in enumerate(played):
        side, bars = axes[:, column]
        for segment in SEGMENTS:
            shape = s.shapes_m[segment]
            side.fill(*outline(s.snapshot.gdp_position_m[segment], s.snapshot.gdp_rotation[segment], shape),
                      fc="#f3d9c4", ec=GREY, lw=1)
            side.plot(*outline(s.snapshot.hcp_position_m[segment], s.snapshot.hcp_rotation[segment], shape),
                      color=BLUE, lw=0.9, ls=":")
        centre = 1e3 * s.centre_m
        side.add_patch(plt.Circle((-centre[2], centre[1]), 500 * s.diameter_m, fc="#dddddd", ec=GREY))
        for segment in SEGMENTS:
            force = s.snapshot.force_n[segment]
            if force > 0:
                point, normal = 1e3 * s.snapshot.point_m[segment], s.snapshot.normal[segment]
                size = 30 * force / strongest
                side.annotate("", (-point[2] - size * normal[2], point[1] + size * normal[1]),
                              (-point[2], point[1]), annotation_clip=False,
                              arrowprops={"arrowstyle": "->", "color": ORANGE, "lw": 2, "shrinkA": 0, "shrinkB": 0})
        side.set_title(s.title)
        knuckle = 1e3 * s.snapshot.gdp_position_m[SEGMENTS[0]]
        side.set_xlim(-knuckle[2] - 45, -knuckle[2] + 85)
        side.set_ylim(knuckle[1] - 90, knuckle[1] + 15)
        side.set_aspect("equal")
        side.axis("off")
        torque = 1e3 * s.snapshot.torque_nm[JOINTS]
        bars.bar(["MCP", "PIP", "DIP"], torque, color=BLUE, width=0.6)
        for joint, value in enumerate(torque):
            bars.annotate(f"{value:.0f}" if value else "0", (joint, min(value, 0)), xytext=(0, -2),
                          textcoords="offset points", ha="center", va="top", fontsize=8)
        bars.axhline(0, color=GREY, lw=0.8)
        bars.grid(axis="x", visible=False)
    axes[1, 0].set_ylabel("torque on the joint [N mm]")
    axes[1, 0].set_ylim(-1.25 * largest, 0.1 * largest)
    figure.suptitle("S1 fig. 8: a contact loads the joints between it and the palm, and no other "
                    "(filled: shown finger; dotted: measured finger; arrows: forces; 0.5 N/mm)")
    return figure


if __name__ == "__main__":
    save(draw(compute()), arguments(__doc__).out)
