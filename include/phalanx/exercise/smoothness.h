// SPDX-License-Identifier: Apache-2.0
// Smoothness of free movement. docs/exercises.md ("Scores") has each formula with its source.
#pragma once

#include <span>
#include <vector>

#include "phalanx/exercise/observation.h"
#include "phalanx/exercise/score.h"

namespace phalanx {

/// Parameters of the spectral arc length, with the published values.             Balasubramanian et al. 2015
struct SparcParameters {
  int padding = 4;          ///< the spectrum has 2^padding times the points of the next power of two, 0 .. 8
  double cut_off = 10.0;    ///< above 0 [Hz]
  double threshold = 0.05;  ///< least magnitude at the ends of the arc, as a share of the largest, 0 .. 1 [-]
};

/// Calculates the spectral arc length (SPARC) of a speed. It is dimensionless and negative; nearer
/// to 0 is smoother.
/// @param speed  at least two finite values, not all 0, at equal intervals
/// @param rate   of these values, above 0 [Hz]
/// @throws std::invalid_argument  for other values. Not real-time: it allocates.
[[nodiscard]] double spectral_arc_length(std::span<const double> speed, double rate,
                                         const SparcParameters& parameters = {});

/// A free movement of one digit: of the sum of its flexion, MCP, PIP and DIP of a finger, MCP and IP
/// of the thumb.
struct FreeMovement {
  int digit = 1;
  double least_speed = 0.1;              ///< a trial with a smaller peak is invalid, above 0 [rad/s]
  bool calibration_independent = false;  ///< of what the person can reach; peak_speed demands it
};

/// Calculates sparc, movement_time_s, peak_speed_deg_per_s, speed_peaks. The flexion is interpolated linearly
/// at 100 Hz between the device's samples (Observation::sample_time), not between the steps that repeat them.
/// Pure. Scores are invalid as in motion_scores.h, and with fewer than 20 samples a second.
/// @throws std::invalid_argument  for a digit that does not exist, or a number outside its range
[[nodiscard]] std::vector<Score> smoothness_scores(std::span<const Observation> steps,
                                                   const FreeMovement& task);

}  // namespace phalanx
