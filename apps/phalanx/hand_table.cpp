// SPDX-License-Identifier: Apache-2.0
#include "hand_table.h"

#include <fmt/format.h>

#include "phalanx/core/constants.h"
#include "phalanx/hand/anthropometry.h"
#include "phalanx/hand/fit.h"

namespace phalanx {
namespace {

/// Formats the distance from the means: "+0.8 SD" from one, or "-0.8 SD of men, +0.5 SD of women".
std::string deviations(double value, std::span<const Norm> norms) {
  std::string text;
  for (const Norm& norm : norms) {
    text += fmt::format("{}{:+.1f} SD of {} ({:.1f} +- {:.1f} mm)", text.empty() ? "" : ", ",
                        (value - norm.mean) / norm.sd, norm.group, norm.mean / kMm, norm.sd / kMm);
  }
  return text;
}

std::string sizes(const HandParameters& hand) {
  std::string text = fmt::format("hand length   {:>8.2f} mm   {}\n", hand_length(hand) / kMm,
                                 deviations(hand_length(hand), hand_length_norms()));
  text += fmt::format("hand breadth  {:>8.2f} mm   {}\n\n", hand_breadth(hand) / kMm,
                      deviations(hand_breadth(hand), hand_breadth_norms()));
  text += fmt::format("{:<36}{:>11}{:>9}{:>13}\n", "segment", "length [mm]", "[SD]", "breadth [mm]");
  for (int s = 0; s < kSegments - 1; ++s) {
    const Norm norm = segment_length_norm(s);
    const double length = segment_length(hand, s);
    text += fmt::format("{:<36}{:>11.2f}{:>+9.1f}{:>13.2f}\n", segment_name(s), length / kMm,
                        (length - norm.mean) / norm.sd, segment_breadth(hand, s) / kMm);
  }
  return text;
}

std::string ranges(const HandParameters& hand) {
  std::string text = fmt::format("\n{:<24}{:>10}{:>10}{:>12}\n", "joint", "least", "largest", "open [deg]");
  for (int j = 0; j < kJoints; ++j) {
    const auto i = static_cast<std::size_t>(j);
    text += fmt::format("{:<24}{:>10.1f}{:>10.1f}{:>12.1f}\n", joint_name(j), kRadToDeg * hand.min_angle[i],
                        kRadToDeg * hand.max_angle[i], kRadToDeg * hand.open_angle[i]);
  }
  return text;
}

std::size_t triangles(const SegmentMeshes& meshes) {
  std::size_t count = 0;
  for (const TriangleMesh& mesh : meshes) count += mesh.triangles.size();
  return count;
}

}  // namespace

std::string hand_table(const LoadedHand& hand) {
  return fmt::format("{}: a {} hand\n", hand.parameters.name,
                     hand.handedness == Handedness::kLeft ? "left" : "right") +
         sizes(hand.parameters) + ranges(hand.parameters) +
         fmt::format("\ntriangles: {} that collide, {} that are shown\n", triangles(hand.meshes.collision),
                     triangles(hand.meshes.display));
}

}  // namespace phalanx
