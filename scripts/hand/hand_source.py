# SPDX-License-Identifier: Apache-2.0
"""The WebXR generic hand as a welded triangle mesh in the wrist's frame, in millimetres, with the joints' rest poses."""
import json
import struct

import numpy as np

SEGMENTS = ["thumb-metacarpal", "thumb-phalanx-proximal", "thumb-phalanx-distal"] + [
    f"{finger}-finger-phalanx-{bone}"
    for finger in ("index", "middle", "ring", "pinky")
    for bone in ("proximal", "intermediate", "distal")
] + ["wrist"]  # in the order of segment_name() in src/hand/joints.cpp
PALM = 15
_TYPES = {5126: "<f4", 5121: "u1", 5123: "<u2", 5125: "<u4"}
_WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def segment_of_joint(name):
    """The segment that takes a joint's weights: tips go to the distal phalanges, wrist and finger metacarpals to the palm."""
    if name == "wrist" or (name.endswith("metacarpal") and not name.startswith("thumb")):
        return PALM
    return SEGMENTS.index(name.replace("finger-tip", "finger-phalanx-distal").replace("thumb-tip", "thumb-phalanx-distal"))


class HandSource:
    """vertices (n, 3) [mm, wrist frame], triangles (m, 3), weight (n, 16) per segment, owner (m,): the segment that is
    dominant over the triangle's corners; joints {name: 4x4 pose in the wrist frame, mm}."""

    def __init__(self, path):
        document, binary = _read_glb(path)

        def accessor(index):
            a = document["accessors"][index]
            view = document["bufferViews"][a["bufferView"]]
            width = _WIDTH[a["type"]]
            start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
            return np.frombuffer(binary, _TYPES[a["componentType"]], a["count"] * width, start).reshape(-1, width)

        part = document["meshes"][0]["primitives"][0]
        position = accessor(part["attributes"]["POSITION"]).astype(float)
        joint = accessor(part["attributes"]["JOINTS_0"]).astype(int)
        share = accessor(part["attributes"]["WEIGHTS_0"]).astype(float)
        triangles = accessor(part["indices"]).reshape(-1, 3).astype(int)
        skin = document["skins"][0]
        inverse_bind = accessor(skin["inverseBindMatrices"]).reshape(-1, 4, 4).transpose(0, 2, 1).astype(float)
        names = [document["nodes"][j]["name"] for j in skin["joints"]]

        first, keep, where = {}, [], np.zeros(len(position), int)
        for i, p in enumerate(map(bytes, np.round(position * 1e7).astype(np.int64))):  # weld the UV seams
            if p not in first:
                first[p] = len(keep)
                keep.append(i)
            where[i] = first[p]
        self.raw_vertices = len(position)
        to_wrist = inverse_bind[names.index("wrist")]
        self.vertices = (position[keep] @ to_wrist[:3, :3].T + to_wrist[:3, 3]) * 1e3
        self.triangles = where[triangles]
        self.weight = np.zeros((len(keep), len(SEGMENTS)))
        self.joint_names = names
        self.joint_weight = np.zeros((len(keep), len(names)))
        for k in range(joint.shape[1]):
            np.add.at(self.joint_weight, (np.arange(len(keep)), joint[keep, k]), share[keep, k])
        for k in range(joint.shape[1]):
            column = np.array([segment_of_joint(names[j]) for j in joint[keep, k]])
            np.add.at(self.weight, (np.arange(len(keep)), column), share[keep, k])
        self.owner = self.weight[self.triangles].sum(1).argmax(1)
        self.joints = {}
        for name, matrix in zip(names, inverse_bind):
            pose = to_wrist @ np.linalg.inv(matrix)
            pose[:3, :3] /= np.linalg.norm(pose[:3, :3], axis=0)
            pose[:3, 3] *= 1e3
            self.joints[name] = pose


def mirror_deviation(right, left):
    """Largest distance [mm] from a vertex of the right hand to the nearest one of the left hand's mirror image, and back."""
    image = left.vertices * [-1.0, 1.0, 1.0]
    distance = np.linalg.norm(right.vertices[:, None] - image[None], axis=2)
    return max(distance.min(1).max(), distance.min(0).max())


def _read_glb(path):
    data = open(path, "rb").read()
    if data[:4] != b"glTF":
        raise SystemExit(f"{path}: not a binary glTF file; give dist/profiles/generic-hand/right.glb of the npm package")
    length = struct.unpack_from("<I", data, 12)[0]
    document = json.loads(data[20:20 + length])
    return document, data[28 + length:]
