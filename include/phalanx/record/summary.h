// SPDX-License-Identifier: Apache-2.0
// What a whole run came to, gathered tick by tick.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/record/made.h"
#include "phalanx/record/step_times.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

struct Summary {
  std::string scene;
  std::uint64_t ticks = 0;
  double rate_hz = 0.0;
  double seconds = 0.0;
  int hand_triangles = 0;
  int object_triangles = 0;
  StepTimes step_us;
  std::array<std::uint64_t, kSegments> contact_ticks{};  ///< ticks with a contact record
  std::array<double, kSegments> peak_force{};            ///< largest magnitude sent [N]
  std::array<double, kSegments> peak_depth{};            ///< [m]
  JointArray peak_torque{};                              ///< largest absolute value commanded [Nm]
  double peak_total_force = 0.0;         ///< largest sum over all segments of the forces sent [N]
  double peak_total_force_time_s = 0.0;  ///< its first tick's time
  double largest_slid = 0.0;             ///< over all contacts [m]
  std::array<std::uint64_t, kDigits> inside_ticks{};      ///< in which each digit gave no force: start_inside
  std::array<std::uint64_t, kStatusBits> status_ticks{};  ///< ticks in which each status bit was set
  std::vector<std::string>
      notes;  ///< sentences that the caller adds to the warnings, e.g. on the motion file
  Made made;
};

/// Adds one tick: counts and peaks. `summary.ticks` grows by one.
void add_tick(Summary& summary, const Snapshot& snapshot);

/// Sum over all segments of the force magnitudes sent [N].
[[nodiscard]] double total_force(const Snapshot& snapshot);

/// One sentence for each thing that makes the result less than it looks: clamped, lost or jumping samples, a
/// digit that started inside, contacts that slid, a search that gave up, a torque that was not finite; then
/// `summary.notes`. Limits that acted are reported by `limiters`, not here: acting is what they are for.
[[nodiscard]] std::vector<std::string> warnings(const Summary& summary);

/// A limiter's name in files, and the ticks in which it acted.
struct LimiterActivity {
  const char* name;
  const char* key;  ///< the scene key that sets it
  std::uint64_t ticks;
};
[[nodiscard]] std::array<LimiterActivity, 4> limiters(const Summary& summary);

/// summary.json: two-space indented, keys in a fixed order (docs/outputs.md), ends with a line feed.
[[nodiscard]] std::string summary_json(const Summary& summary);

}  // namespace phalanx
