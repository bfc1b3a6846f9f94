// SPDX-License-Identifier: Apache-2.0
// A hand as a tree of frames and hinges, in the form of other simulators' files: urdf.cpp and mjcf.cpp write
// them. The other files of this folder read a hand: hand_file.cpp its numbers, profile_file.cpp the fit to a
// patient, skin_file.cpp its skin, and hand_meshes.cpp the whole hand with meshes and skin.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "phalanx/scene/hand_meshes.h"

namespace phalanx {

/// A hinge between two frames; it turns about the child's origin.
struct Hinge {
  Pose X_parent_child;              ///< at angle 0
  Vec3 axis_child = Vec3::UnitX();  ///< unit vector; a positive angle turns the child about it
  double min_angle = 0.0;           ///< [rad]
  double max_angle = 0.0;           ///< [rad]
};

/// Hinges of a hand, four for each digit. The first one's parent is H; its child is a frame in the joint's
/// centre, with the axes of the digit's first segment at angle 0. The others' children are the
/// segments' frames S.
struct HandTree {
  std::array<Hinge, kJoints> hinge;
};

/// Makes the tree of a hand, of its own handedness.
[[nodiscard]] HandTree hand_tree(const LoadedHand& hand);

/// Writes a number that reads back to the same bits: 17 significant digits.
[[nodiscard]] std::string exact(double value);
[[nodiscard]] std::string exact(const Vec3& v);

/// @returns `text` as the value of an XML attribute in double quotes.
[[nodiscard]] std::string xml_escaped(std::string_view text);

}  // namespace phalanx
