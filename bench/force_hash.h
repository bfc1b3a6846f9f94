// SPDX-License-Identifier: Apache-2.0
// A number that changes if any force or torque of a run changes in any bit.
#pragma once

#include <cstdint>
#include <cstring>

#include "phalanx/step/snapshot.h"

namespace phalanx::bench {

/// FNV-1a (Fowler, Noll & Vo), 64 bits, over words of 64 bits.
class Hash {
 public:
  void add(double value) {
    std::uint64_t bits = 0;
    static_assert(sizeof bits == sizeof value);
    std::memcpy(&bits, &value, sizeof bits);
    value_ = (value_ ^ bits) * 0x100000001b3ULL;
    value_ ^= value_ >> 29U;  // words, not bytes: bring the upper bits down
  }
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
  [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325ULL;
};

/// Of this machine's sine and cosine at ten thousand angles: libm may choose other code, and round otherwise,
/// on another CPU, and then forces differ in their last bits.
[[nodiscard]] std::uint64_t libm_fingerprint();

}  // namespace phalanx::bench
