// SPDX-License-Identifier: Apache-2.0
// The result of a whole run, collected tick by tick.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/record/made.h"
#include "phalanx/simulation/step_times.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// Result of a run: counts and peaks.
struct Summary {
  std::string scene;
  std::uint64_t ticks = 0;
  double rate_hz = 0.0;
  double seconds = 0.0;
  int hand_triangles = 0;
  int object_triangles = 0;
  StepTimes step_us;
  AngleOrigins angle_origin{};                           ///< of the joint angles
  std::array<std::uint64_t, kSegments> contact_ticks{};  ///< ticks with a contact record
  std::array<double, kSegments> peak_force{};            ///< largest magnitude sent [N]
  std::array<double, kSegments> peak_depth{};            ///< [m]
  JointArray peak_torque{};                              ///< largest absolute value commanded [Nm]
  double peak_total_force = 0.0;         ///< largest sum over all segments of the forces sent [N]
  double peak_total_force_time_s = 0.0;  ///< time of its first tick
  double largest_slid = 0.0;             ///< over all contacts [m]
  std::array<std::uint64_t, kDigits> inside_ticks{};      ///< ticks in which a digit gave no force, because
                                                          ///< it started inside the object
  std::array<std::uint64_t, kStatusBits> status_ticks{};  ///< ticks in which each status bit was set
  std::vector<std::string>
      notes;  ///< sentences that the caller adds to the warnings, for example on the motion file
  Made made;
};

/// Adds one tick to counts and peaks. `summary.ticks` grows by one.
void add_tick(Summary& summary, const Snapshot& snapshot);

/// @returns the sum over all segments of the force magnitudes sent [N].
[[nodiscard]] double total_force(const Snapshot& snapshot);

/// @returns one sentence for each reason to distrust the result, then `summary.notes`. Reasons are clamped,
/// lost or jumping samples, a digit that started inside, an oscillating force, and contacts that slid. A
/// search that gave up and a torque that was not finite are reasons, too. limiters() reports the limits that
/// acted, which is their purpose.
[[nodiscard]] std::vector<std::string> warnings(const Summary& summary);

/// Name of a limiter in files, and the ticks in which it acted.
struct LimiterActivity {
  const char* name;
  const char* key;  ///< the scene key that sets it
  std::uint64_t ticks;
};
/// @returns the four limiters with the ticks in which each acted.
[[nodiscard]] std::array<LimiterActivity, 4> limiters(const Summary& summary);

/// Writes summary.json: indented by two spaces, keys in a fixed order (docs/outputs.md), with a
/// final line feed.
[[nodiscard]] std::string summary_json(const Summary& summary);

}  // namespace phalanx
