// SPDX-License-Identifier: Apache-2.0
// The papers' experiments, run by the program's own step. Results are compared only with what the papers
// print. S1 is Feng, Li, IEEE ROBIO 2010, and S2 is Feng, Li, Zheng, ICVRV 2011 (docs/architecture.md).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/record/step_times.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// One of the seven situations of S1 fig. 8: the index finger presses a ball and holds still.
struct Fig8Situation {
  char letter = 'a';  ///< the frame in S1 fig. 8
  std::string title;
  std::array<bool, 3> touching{};   ///< segments that S1 shows in contact: proximal, middle, distal
  double ball_diameter = 0.0;       ///< [m]
  Vec3 ball_centre = Vec3::Zero();  ///< [m]
  Snapshot held;                    ///< the last tick, when everything is at rest
  Status limited = Status::kOk;     ///< all status bits that were set during the motion
};

/// Plays the seven situations. From the open hand, the finger moves to a posture. Then one joint after the
/// other flexes until its segment meets the ball, and a few degrees more. The hand then holds for 0.5 s.
/// Adult right hand, Hooke 0.5 N/mm, smoothing and limits at their defaults, 200 Hz.
/// @throws std::runtime_error if a segment that has to meet the ball does not.
[[nodiscard]] std::vector<Fig8Situation> run_s1_fig8();

/// @returns true if a joint of the index finger carries torque by S1 eq. (3)-(5): a segment at or beyond it
/// is in contact.
/// @param joint  0 flexion of the metacarpophalangeal joint (MCP), 1 proximal (PIP), 2 distal
/// interphalangeal joint (DIP)
[[nodiscard]] bool carries_torque(const Fig8Situation& situation, int joint);

/// Writes the situations as text for a terminal.
[[nodiscard]] std::string fig8_text(const std::vector<Fig8Situation>& situations);
/// Writes the situations as CSV.
[[nodiscard]] std::string fig8_csv(const std::vector<Fig8Situation>& situations);
/// Writes the situations as JSON.
[[nodiscard]] std::string fig8_json(const std::vector<Fig8Situation>& situations);

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

}  // namespace phalanx
