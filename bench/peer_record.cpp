// SPDX-License-Identifier: Apache-2.0
#include "peer_record.h"

#include <utility>

namespace phalanx::bench {

bool choose_contact(const std::vector<ClosePair>& pairs, double cap, const SegmentField* field,
                    std::vector<ClosePair>& tied) {
  constexpr double kCos30 = 0.86602540378443865;
  const ClosePair* lead = nullptr;
  double fastest = 0.0;
  if (field != nullptr) {
    for (const ClosePair& pair : pairs) {
      const double speed = field->closing(pair.direction(), pair.on_segment);
      if (pair.distance > cap || speed <= fastest) continue;
      fastest = speed;
      lead = &pair;
    }
  }
  const auto counts = [&](const ClosePair& pair) {
    return lead == nullptr || pair.direction().dot(lead->direction()) >= kCos30 ||
           field->closing(pair.direction(), pair.on_segment) >= 0.5 * fastest;
  };
  const ClosePair* nearest = nullptr;
  for (const ClosePair& pair : pairs) {
    if (pair.distance > cap || !counts(pair)) continue;
    if (nearest == nullptr || pair.distance < nearest->distance) nearest = &pair;
  }
  tied.clear();
  if (nearest == nullptr) return false;
  tied.push_back(*nearest);
  for (const ClosePair& pair : pairs) {
    if (&pair == nearest || pair.distance > nearest->distance + kTie || !counts(pair)) continue;
    tied.push_back(pair);
  }
  return true;
}

}  // namespace phalanx::bench
