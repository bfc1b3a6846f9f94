// SPDX-License-Identifier: Apache-2.0
#include "phases.h"

#include "peer_clearance.h"
#include "peer_fcl.h"
#include "peer_motion.h"

namespace phalanx::bench {

namespace {

Phase phase_of_touch(int segments, bool deep, ContactMode mode) {
  if (mode == ContactMode::kStatic) return deep ? Phase::kDeep : Phase::kTouching;
  if (segments == 1) return Phase::kOneSegment;
  if (segments <= 5) return Phase::kFewSegments;
  return segments <= 10 ? Phase::kManySegments : Phase::kMostSegments;
}

}  // namespace

std::vector<Phase> phases_of(const HapticModel& model, const std::vector<GdpValues>& states,
                             ContactMode mode) {
  FclEngine engine(model.hand, model.object.mesh());
  Clearance clearance(model.hand, model.object.mesh(), engine, Pruning::kLikeOurs);
  const auto is_free = [&](const GdpValues& state) {
    for (int s = 0; s < kPalm; ++s) {
      const int d = digit_of_segment(s);
      const int k = s % kSegmentsPerDigit;
      const Pose& X_WS = state.poses.digit[idx(d)].segment[idx(k)];
      if (!(clearance.of(d, k, digit_angles(state.angle, d), X_WS, kFreeDistance) > kFreeDistance))
        return false;
    }
    return true;
  };
  std::vector<Phase> phases;
  for (std::size_t tick = 1; tick < states.size(); ++tick) {
    int touching = 0;
    bool deep = false;
    for (int s = 0; s < kPalm; ++s) {
      const ContactRecord& record = states[tick].record[idx(s)];
      touching += record.active ? 1 : 0;
      deep = deep || (record.active && record.depth > kDeepDepth);
    }
    phases.push_back(touching > 0            ? phase_of_touch(touching, deep, mode)
                     : is_free(states[tick]) ? Phase::kFree
                                             : Phase::kNear);
  }
  return phases;
}

}  // namespace phalanx::bench
