// SPDX-License-Identifier: Apache-2.0
// A number that changes if any force or torque of a run changes in any bit.
#pragma once

#include <cstdint>

#include "phalanx/core/bit_hash.h"
#include "phalanx/step/snapshot.h"

namespace phalanx::bench {

/// Hash of the forces and torques of a run.
class Hash {
 public:
  void add(double value) { hash_.add(value); }
  /// Torques, and each segment's forces with where and in which direction they act.
  void add(const Snapshot& snapshot) {
    for (const double torque : snapshot.torque) add(torque);
    for (const SegmentSnapshot& segment : snapshot.segment) {
      add(segment.force_raw);
      add(segment.force);
      if (!(segment.force > 0.0)) continue;
      for (int i = 0; i < 3; ++i) {
        add(segment.point[i]);
        add(segment.normal[i]);
      }
    }
  }
  [[nodiscard]] std::uint64_t value() const { return hash_.value(); }

 private:
  BitHash hash_;
};

}  // namespace phalanx::bench
