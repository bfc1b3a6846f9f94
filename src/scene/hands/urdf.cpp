// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>

#include "phalanx/core/xml_text.h"
#include "phalanx/force/force_parameters.h"
#include "phalanx/scene/hand_export.h"
#include "scene/hands/hand_tree.h"
#include "scene/hands/mass_properties.h"

namespace phalanx {
namespace {

/// Computes roll, pitch and yaw with  R = Rz(yaw) Ry(pitch) Rx(roll).  Their product equals R to rounding
/// even if pitch is near +-90 degrees, because roll is computed from the rest after yaw.
Vec3 roll_pitch_yaw(const Mat3& R) {
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  const double pitch = std::atan2(-R(2, 0), c * R(0, 0) + s * R(1, 0));
  const double roll = std::atan2(s * R(0, 2) - c * R(1, 2), c * R(1, 1) - s * R(0, 1));
  return {roll, pitch, yaw};
}

std::string link_with_meshes(const LoadedHand& hand, int segment, const ExportedMeshes& meshes) {
  const MassProperties m =
      mass_properties(hand.meshes.collision[static_cast<std::size_t>(segment)], kHandDensity);
  const std::string_view name = segment_name(segment);
  const auto geometry = [&](const char* what, const std::string& folder) {
    return fmt::format("    <{0}><geometry><mesh filename=\"{1}/{2}.obj\"/></geometry></{0}>\n", what,
                       xml_escaped(folder), name);
  };
  return fmt::format(
             "  <link name=\"{}\">\n    <inertial>\n      <origin xyz=\"{}\" rpy=\"0 0 0\"/>\n      <mass "
             "value=\"{}\"/>\n      <inertia ixx=\"{}\" ixy=\"{}\" ixz=\"{}\" iyy=\"{}\" iyz=\"{}\" "
             "izz=\"{}\"/>\n    </inertial>\n",
             name, exact(m.centre), exact(m.mass), exact(m.inertia(0, 0)), exact(m.inertia(0, 1)),
             exact(m.inertia(0, 2)), exact(m.inertia(1, 1)), exact(m.inertia(1, 2)), exact(m.inertia(2, 2))) +
         geometry("visual", meshes.display) + geometry("collision", meshes.collision) + "  </link>\n";
}

std::string joint(const Hinge& hinge, std::string_view parent, std::string_view child) {
  const LimitParameters limits;
  const std::string mimic = hinge.coupled
                                ? fmt::format("    <mimic joint=\"{}\" multiplier=\"{}\" offset=\"0\"/>\n",
                                              joint_name(hinge.joint), exact(hinge.ratio))
                                : "";
  return fmt::format(
      "  <joint name=\"{}\" type=\"revolute\">\n    <parent link=\"{}\"/>\n    <child link=\"{}\"/>\n    "
      "<origin xyz=\"{}\" rpy=\"{}\"/>\n    <axis xyz=\"{}\"/>\n    <limit lower=\"{}\" upper=\"{}\" "
      "effort=\"{}\" velocity=\"{}\"/>\n{}  </joint>\n",
      hinge.name, parent, child, exact(hinge.X_parent_child.p), exact(roll_pitch_yaw(hinge.X_parent_child.R)),
      exact(hinge.axis_child), exact(hinge.min_angle), exact(hinge.max_angle), exact(limits.joint_torque),
      exact(std::abs(hinge.ratio) * limits.joint_speed), mimic);
}

}  // namespace

std::string urdf_text(const LoadedHand& hand, const ExportedMeshes& meshes) {
  const HandTree tree = hand_tree(hand);
  std::string text =
      fmt::format("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", xml_escaped(hand.parameters.name));
  text += link_with_meshes(hand, kPalm, meshes);
  for (int digit = 0; digit < kDigits; ++digit) {
    std::string parent(segment_name(kPalm));
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const int segment = segment_index(digit, k);
      const std::vector<Hinge>& hinges = tree.hinges[static_cast<std::size_t>(segment)];
      for (std::size_t i = 0; i < hinges.size(); ++i) {
        const bool last = i + 1 == hinges.size();
        const std::string child = last ? std::string(segment_name(segment)) : hinges[i].name + "_link";
        text +=
            last ? link_with_meshes(hand, segment, meshes) : fmt::format("  <link name=\"{}\"/>\n", child);
        text += joint(hinges[i], parent, child);
        parent = child;
      }
    }
  }
  return text + "</robot>\n";
}

}  // namespace phalanx
