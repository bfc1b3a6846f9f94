// SPDX-License-Identifier: Apache-2.0
// The papers' experiments, run by the program's own step. Only what the papers print is put beside the
// results.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/record/step_times.h"
#include "phalanx/step/snapshot.h"

namespace phalanx {

/// One of the seven situations of S1 fig. 8: the index finger and a ball, pressed and held still.
struct Fig8Situation {
  char letter = 'a';  ///< the frame in S1 fig. 8
  std::string title;
  std::array<bool, 3> touching{};   ///< what S1 says is in contact: proximal, middle, distal
  double ball_diameter = 0.0;       ///< [m]
  Vec3 ball_centre = Vec3::Zero();  ///< [m]
  Snapshot held;                    ///< the last tick, everything at rest
  Status limited = Status::kOk;     ///< every status bit that was set on the way
};

/// Plays the seven: from the open hand to a posture, then one joint after the other flexes until its segment
/// meets the ball and a few degrees more, then the hand holds for half a second. Adult right hand, Hooke 0.5
/// N/mm, smoothing and limits at their defaults, 200 Hz.
/// @throws std::runtime_error if a segment that has to meet the ball does not.
[[nodiscard]] std::vector<Fig8Situation> run_s1_fig8();

/// Whether a joint of the index finger (0 MCP flexion, 1 PIP, 2 DIP) carries torque by S1 eq. (3)-(5) in this
/// situation: some segment from its own on is in contact.
[[nodiscard]] bool carries_torque(const Fig8Situation& situation, int joint);

[[nodiscard]] std::string fig8_text(const std::vector<Fig8Situation>& situations);
[[nodiscard]] std::string fig8_csv(const std::vector<Fig8Situation>& situations);
[[nodiscard]] std::string fig8_json(const std::vector<Fig8Situation>& situations);

struct TimingRun {
  bool smoothing = true;
  StepTimes step_us;
};

struct TimingResult {
  std::string name;             ///< "s1-timing"
  std::string what;             ///< one line: which hand does what
  std::string paper_triangles;  ///< as the paper prints them
  std::string paper_time;       ///< as the paper prints it, with its machine; or "not printed"
  int hand_triangles = 0;       ///< what ours really has
  int object_triangles = 0;
  std::uint64_t ticks = 0;
  std::vector<TimingRun> runs;
};

/// The index finger presses a ball, 1,489 triangles in all as in S1 (or as near as the mesh makers come).
[[nodiscard]] TimingResult run_s1_timing();
/// The whole hand grasps the teapot, 2,248 triangles of hand and 992 of object as in S2 (or as near as the
/// mesh makers come).
[[nodiscard]] TimingResult run_s2_timing();

[[nodiscard]] std::string timing_text(const TimingResult& result);
[[nodiscard]] std::string timing_csv(const TimingResult& result);
[[nodiscard]] std::string timing_json(const TimingResult& result);

}  // namespace phalanx
