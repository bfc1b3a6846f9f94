// SPDX-License-Identifier: Apache-2.0
// One run of the closed loop, as the laboratory sees it: what is asked for and what comes back.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// What one closed-loop run of one seed came to.
struct TrialResult {
  bool valid =
      true;  ///< no limiter but the one studied acted (motor saturation excepted), and a contact was made
  std::string why_invalid;   ///< a few words; empty if valid
  bool stable = false;       ///< no contact swings by more than the criterion allows
  double force_swing = 0.0;  ///< largest peak-to-peak of the sent force over the contacts, in the window [N]
  double position_swing = 0.0;  ///< the same of the HCP along the contact's normal n [m]
  double peak_depth = 0.0;      ///< deepest penetration of the whole run [m]
  double mean_force = 0.0;      ///< of the pressing contact, in the window [N]
  double mean_depth = 0.0;      ///< of the pressing contact, in the window [m]
  double ghost_s = 0.0;         ///< how long there is a force after the finger has left the wall [s]
  double ghost_energy = 0.0;    ///< the work that this force does on the finger [J]
};

/// Runs the closed loop once.
/// @param overrides  of the scene, in order (StudyPoint's, see point_overrides())
/// @param stiffness  of the wall [N/m]; NaN: the scene's
/// @param press      force that the finger presses with [N]; NaN: the patient's
/// @param seed       of everything random in the run
/// Must be safe to call from several threads at once, and give the same result for the same arguments
/// whatever ran before. It may throw: the point is then not finished (see run_study()). Not real-time.
using TrialFunction = std::function<TrialResult(const Overrides& overrides, double stiffness, double press,
                                                std::uint64_t seed)>;

}  // namespace phalanx
