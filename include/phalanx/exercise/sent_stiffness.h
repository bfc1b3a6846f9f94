// SPDX-License-Identifier: Apache-2.0
// Stiffness that was really sent to a participant during one press.
#pragma once

#include <array>
#include <string>

#include "phalanx/exercise/observation.h"

namespace phalanx {

/// Meter of the stiffness that the station really sent in one press. A force limit, a ramp or a stabiliser
/// makes it differ from the commanded one: smoothing leaves 0.38 of 1.6 N/mm at 100 mm/s. Real-time: O(1), no
/// allocation; reason() allocates.
class SentStiffness {
 public:
  /// @param commanded  of the sponge that is presented [N/m]
  /// @param digits     instructed to press it
  SentStiffness(double commanded, const std::array<bool, kDigits>& digits);

  /// Takes in a step. Samples are Observation::sent_stiffness of every digit that touches, instructed or not:
  /// a participant feels the sponge with each of them.
  void add(const Observation& observation);

  /// @returns the mean over all samples, whether the press counts or not; NaN without samples [N/m]
  [[nodiscard]] double mean() const noexcept;
  /// @returns why the press does not count, for people: fewer than 20 samples of the instructed digits, a
  /// fault, a torque that was off or ramped, or differs(). Empty: it counts
  [[nodiscard]] std::string reason() const;
  /// @returns true if more than a fifth of the samples are not within 10 % of the commanded stiffness
  [[nodiscard]] bool differs() const noexcept;
  /// @returns the largest depth of an instructed digit's contact up to now [m]
  [[nodiscard]] double deepest() const noexcept { return deepest_; }
  /// @returns number of samples of the instructed digits
  [[nodiscard]] int samples() const noexcept { return own_; }

 private:
  double commanded_ = 0.0;
  std::array<bool, kDigits> digits_{};
  double sum_ = 0.0;
  double deepest_ = 0.0;
  int count_ = 0;    ///< samples of all digits
  int own_ = 0;      ///< of the instructed ones
  int outside_ = 0;  ///< samples that are not within 10 %
  bool fault_ = false;
  bool ramped_ = false;
};

}  // namespace phalanx
