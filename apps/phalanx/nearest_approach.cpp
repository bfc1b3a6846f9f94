// SPDX-License-Identifier: Apache-2.0
#include "nearest_approach.h"

#include <fmt/format.h>

#include "phalanx/contact/proximity.h"
#include "phalanx/core/index.h"
#include "phalanx/figures/human_names.h"

namespace phalanx {

void NearestApproach::add(const Snapshot& snapshot) {
  if (snapshot.tick % every_ == 0) poses_.push_back(snapshot.hcp_pose);
}

std::string NearestApproach::text(const HapticModel& model, const SceneDescription& scene) const {
  if (scene.objects.empty()) return "";
  constexpr double kFarthest = 10.0;  // [m]
  double nearest = kFarthest;
  int segment = 0;
  SearchScratch scratch(model.trees());
  for (const auto& poses : poses_) {
    for (int s = 0; s < kSegments; ++s) {
      if (s == kPalm) continue;  // it does not move
      const double apart =
          distance({model.trees()[idx(s)], poses[idx(s)], scratch}, model.object.tree(), nearest);
      if (apart >= nearest) continue;
      nearest = apart;
      segment = s;
    }
  }
  if (nearest == 0.0) return "";
  const std::string found = nearest == kFarthest ? ""
                                                 : fmt::format("the nearest was the {}, {:.3g} mm away; ",
                                                               human_segment_name(segment), 1e3 * nearest);
  constexpr double kCloser = 0.8;
  const bool closes = scene.motion.file.empty() && scene.motion.script.closure < kCloser;
  return fmt::format(
      ": {}move the object (--set objects.0.position_mm=[x,y,z]){}", found,
      closes ? fmt::format(" or close the hand further (--set motion.closure={})", kCloser) : "");
}

}  // namespace phalanx
