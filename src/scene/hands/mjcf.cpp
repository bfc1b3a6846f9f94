// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "phalanx/core/xml_text.h"
#include "phalanx/scene/hand_export.h"
#include "scene/hands/hand_tree.h"
#include "scene/hands/mass_properties.h"

namespace phalanx {
namespace {

class Writer {
 public:
  Writer(const LoadedHand& hand, const ExportedMeshes& meshes)
      : hand_(hand), meshes_(meshes), tree_(hand_tree(hand)) {}

  std::string text() {
    line(0, "<mujoco model=\"{}\">", xml_escaped(hand_.parameters.name));
    line(1, "<compiler angle=\"radian\"/>");
    line(1, "<default>");
    line(2, "<default class=\"collision\"><geom type=\"mesh\" group=\"3\"/></default>");
    line(2,
         "<default class=\"display\"><geom type=\"mesh\" group=\"2\" contype=\"0\" "
         "conaffinity=\"0\"/></default>");
    line(1, "</default>");
    assets();
    line(1, "<worldbody>");
    line(2, "<body name=\"{}\">", segment_name(kPalm));
    contents(kPalm, 3);
    for (int digit = 0; digit < kDigits; ++digit) chain(digit);
    line(2, "</body>");
    line(1, "</worldbody>");
    excluded_contacts();
    equalities();
    line(0, "</mujoco>");
    return text_;
  }

 private:
  template <typename... Parts>
  void line(int depth, fmt::format_string<Parts...> format, Parts&&... parts) {
    text_.append(static_cast<std::size_t>(2 * depth), ' ');
    text_ += fmt::format(format, std::forward<Parts>(parts)...);
    text_ += '\n';
  }

  [[nodiscard]] bool one_set() const { return meshes_.collision == meshes_.display; }

  void assets() {
    line(1, "<asset>");
    for (int segment = 0; segment < kSegments; ++segment) {
      const std::string_view name = segment_name(segment);
      line(2, "<mesh name=\"{0}\" file=\"{1}/{0}.obj\"/>", name, xml_escaped(meshes_.collision));
      if (!one_set())
        line(2, "<mesh name=\"{0}-display\" file=\"{1}/{0}.obj\"/>", name, xml_escaped(meshes_.display));
    }
    line(1, "</asset>");
  }

  /// Writes inertia and geoms. The inertial is explicit, so that a mesh's own centre has no influence.
  void contents(int segment, int depth) {
    const MassProperties m =
        mass_properties(hand_.meshes.collision[static_cast<std::size_t>(segment)], kHandDensity);
    const Mat3& I = m.inertia;
    line(depth, "<inertial pos=\"{}\" mass=\"{}\" fullinertia=\"{} {} {} {} {} {}\"/>", exact(m.centre),
         exact(m.mass), exact(I(0, 0)), exact(I(1, 1)), exact(I(2, 2)), exact(I(0, 1)), exact(I(0, 2)),
         exact(I(1, 2)));
    const std::string_view name = segment_name(segment);
    line(depth, "<geom class=\"collision\" mesh=\"{}\"/>", name);
    line(depth, "<geom class=\"display\" mesh=\"{}{}\"/>", name, one_set() ? "" : "-display");
  }

  void chain(int digit) {
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const int depth = 3 + k;
      const int segment = segment_index(digit, k);
      const std::vector<Hinge>& hinges = tree_.hinges[static_cast<std::size_t>(segment)];
      Pose X;
      for (const Hinge& hinge : hinges) X = X * hinge.X_parent_child;
      const Eigen::Quaterniond q(X.R);
      line(depth, "<body name=\"{}\" pos=\"{}\" quat=\"{} {} {} {}\">", segment_name(segment), exact(X.p),
           exact(q.w()), exact(q.x()), exact(q.y()), exact(q.z()));
      // MuJoCo applies a body's joints in their order, each in the frame that the earlier ones have turned.
      // Their frames have the body's directions at angle 0: only their places differ.
      Vec3 at = Vec3::Zero();
      std::vector<Vec3> places(hinges.size(), at);
      for (std::size_t i = hinges.size() - 1; i > 0; --i) {
        at = at - hinges[i].X_parent_child.p;
        places[i - 1] = at;
      }
      for (std::size_t i = 0; i < hinges.size(); ++i) joint(hinges[i], depth + 1, places[i]);
      contents(segment, depth + 1);
    }
    for (int k = kSegmentsPerDigit - 1; k >= 0; --k) line(3 + k, "</body>");
  }

  void joint(const Hinge& hinge, int depth, const Vec3& pos) {
    line(depth, "<joint name=\"{}\" type=\"hinge\" pos=\"{}\" axis=\"{}\" limited=\"true\" range=\"{} {}\"/>",
         hinge.name, exact(pos), exact(hinge.axis_child), exact(hinge.min_angle), exact(hinge.max_angle));
  }

  /// Writes that each coupled hinge's angle is its ratio times its joint's.
  void equalities() {
    std::vector<const Hinge*> coupled;
    for (const std::vector<Hinge>& hinges : tree_.hinges)
      for (const Hinge& hinge : hinges)
        if (hinge.coupled) coupled.push_back(&hinge);
    if (coupled.empty()) return;
    line(1, "<equality>");
    for (const Hinge* hinge : coupled) {
      line(2, "<joint joint1=\"{}\" joint2=\"{}\" polycoef=\"0 {} 0 0 0\"/>", hinge->name,
           joint_name(hinge->joint), exact(hinge->ratio));
    }
    line(1, "</equality>");
  }

  void excluded_contacts() {
    line(1, "<contact>");
    for (int segment = 0; segment < kPalm; ++segment)
      line(2, "<exclude body1=\"{}\" body2=\"{}\"/>", segment_name(kPalm), segment_name(segment));
    for (int digit = 1; digit < kDigits; ++digit) {
      line(2, "<exclude body1=\"{}\" body2=\"{}\"/>", segment_name(segment_index(digit - 1, 0)),
           segment_name(segment_index(digit, 0)));
    }
    line(1, "</contact>");
  }

  const LoadedHand& hand_;
  const ExportedMeshes& meshes_;
  HandTree tree_;
  std::string text_;
};

}  // namespace

std::string mjcf_text(const LoadedHand& hand, const ExportedMeshes& meshes) {
  return Writer(hand, meshes).text();
}

}  // namespace phalanx
