// SPDX-License-Identifier: Apache-2.0
// A hand as a tree of frames and hinges, in the form that other simulators' files have.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "phalanx/scene/hand_meshes.h"

namespace phalanx {

/// A hinge between two frames that turn about the child's origin.
struct Hinge {
  Pose X_parent_child;              ///< at angle 0
  Vec3 axis_child = Vec3::UnitX();  ///< unit; a positive angle turns the child about it
  double min_angle = 0.0;           ///< [rad]
  double max_angle = 0.0;           ///< [rad]
};

/// Of every digit four hinges; the first one's child is a frame in the joint's centre with the axes of the
/// digit's first segment at angle 0, the others' children are the segments' frames S. The first one's parent
/// is H.
struct HandTree {
  std::array<Hinge, kJoints> hinge;
};

[[nodiscard]] HandTree hand_tree(const LoadedHand& hand);

/// A number that reads back to the same bits: 17 significant digits.
[[nodiscard]] std::string exact(double value);
[[nodiscard]] std::string exact(const Vec3& v);

/// `text` as the value of an XML attribute in double quotes.
[[nodiscard]] std::string xml_escaped(std::string_view text);

}  // namespace phalanx
