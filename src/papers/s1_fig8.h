// SPDX-License-Identifier: Apache-2.0
// S1 fig. 8: which joints carry torque in seven situations.
#pragma once

#include <array>
#include <string>
#include <vector>

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
/// The papers' right hand, Hooke 0.5 N/mm, smoothing and limits at their defaults, 200 Hz.
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

}  // namespace phalanx
