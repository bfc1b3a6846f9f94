// SPDX-License-Identifier: Apache-2.0
// Step times with the papers' numbers of triangles.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/scene/scene.h"
#include "phalanx/simulation/step_times.h"

namespace phalanx {

/// Step times of one run.
struct TimingRun {
  bool smoothing = true;
  StepTimes step_us;
};

/// Result of a timing experiment.
struct TimingResult {
  std::string name;             ///< "s1-timing"
  std::string what;             ///< one line: hand and motion
  std::string paper_triangles;  ///< triangles as the paper prints them
  std::string paper_time;       ///< time and machine as the paper prints them; or "not printed"
  int hand_triangles = 0;       ///< triangles of our hand
  int object_triangles = 0;
  std::uint64_t ticks = 0;
  std::vector<TimingRun> runs;
};

/// Times the index finger on a ball, with 1,489 triangles in all as in S1, or as near as the generators come.
[[nodiscard]] TimingResult run_s1_timing();
/// Times the whole hand on the teapot. The hand has 2,248 triangles and the object 992 as in S2, or as near
/// as the mesh generators come.
[[nodiscard]] TimingResult run_s2_timing();

/// Writes the times as text for a terminal.
[[nodiscard]] std::string timing_text(const TimingResult& result);
/// Writes the times as CSV.
[[nodiscard]] std::string timing_csv(const TimingResult& result);
/// Writes the times as JSON.
[[nodiscard]] std::string timing_json(const TimingResult& result);

/// Finds the `triangles` to request from a mesh generator so that it makes as near to `target` as possible.
/// It returns the request near the target with the smallest error.
/// @param made  number of triangles that the generator makes for a request
[[nodiscard]] int best_request(int target, int (*made)(int request, const SceneDescription& scene),
                               const SceneDescription& scene);

}  // namespace phalanx
