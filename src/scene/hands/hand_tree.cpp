// SPDX-License-Identifier: Apache-2.0
#include "scene/hands/hand_tree.h"

#include <fmt/format.h>

namespace phalanx {

HandTree hand_tree(const LoadedHand& hand) {
  const HandModel model(hand.parameters, hand.handedness, {}, hand.meshes.collision);
  HandPoses zero;
  model.poses(JointArray{}, zero);
  HandTree tree;
  for (int digit = 0; digit < kDigits; ++digit) {
    const DigitPose& pose = zero.digit[static_cast<std::size_t>(digit)];
    Pose parent = model.palm_pose();
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const auto j = static_cast<std::size_t>(joint_index(digit, i));
      const JointAxis& joint = pose.joint[static_cast<std::size_t>(i)];
      // A segment's origin is on its joint's axis: the Denavit-Hartenberg (D-H) offset d runs along it.
      Pose child = pose.segment[static_cast<std::size_t>(segment_in_digit_of_joint(i))];
      if (i == 0) child.p = joint.centre;
      tree.hinge[j] = {.X_parent_child = parent.inverse() * child,
                       .axis_child = child.R.transpose() * joint.axis,
                       .min_angle = hand.parameters.min_angle[j],
                       .max_angle = hand.parameters.max_angle[j]};
      parent = child;
    }
  }
  return tree;
}

std::string exact(double value) { return fmt::format("{:.17g}", value); }

std::string exact(const Vec3& v) { return exact(v.x()) + " " + exact(v.y()) + " " + exact(v.z()); }

std::string xml_escaped(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += static_cast<unsigned char>(c) < 32 ? ' ' : c;
  }
  return out;
}

}  // namespace phalanx
