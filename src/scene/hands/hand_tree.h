// SPDX-License-Identifier: Apache-2.0
// A hand as a tree of frames and hinges, in the form of other simulators' files: urdf.cpp and mjcf.cpp write
// them. The other files of this folder read a hand: hand_file.cpp its numbers, profile_file.cpp the fit to a
// patient, skin_file.cpp its skin, and hand_meshes.cpp the whole hand with meshes and skin.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "phalanx/scene/hand_meshes.h"

namespace phalanx {

/// A hinge between two frames; it turns about a point of its axis, the child's origin.
struct Hinge {
  std::string name;                 ///< of the joint: joint_name(), or its own for a coupled one
  Pose X_parent_child{};            ///< at angle 0
  Vec3 axis_child = Vec3::UnitX();  ///< unit vector; a positive angle turns the child about it
  double min_angle = 0.0;           ///< [rad]
  double max_angle = 0.0;           ///< [rad]
  int joint = 0;                    ///< the joint whose angle it follows
  double ratio = 1.0;               ///< its angle is ratio times the joint's
  bool coupled = false;             ///< it is not the joint itself
};

/// Hinges of a hand: for each digit's segment those between it and the segment before it (the palm), from the
/// palm outwards. The last one's child is the segment's frame S. The children of the others are frames on their
/// axes, with the directions of S at angle 0.
/// A digit's first segment has two, and one more for each coefficient of its coupling that is not 0. The other
/// segments have one each.
struct HandTree {
  std::array<std::vector<Hinge>, kSegments - 1> hinges;
};

/// Makes the tree of a hand, of its own handedness.
[[nodiscard]] HandTree hand_tree(const LoadedHand& hand);

/// Writes a number that reads back to the same bits: 17 significant digits.
[[nodiscard]] std::string exact(double value);
[[nodiscard]] std::string exact(const Vec3& v);

}  // namespace phalanx
