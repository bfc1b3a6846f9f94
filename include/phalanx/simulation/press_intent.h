// SPDX-License-Identifier: Apache-2.0
// The patient's intended angles over a trial: approach, press, hold, release, with tremor and a bump.
#pragma once

#include <array>
#include <cstdint>

#include "phalanx/core/random.h"
#include "phalanx/simulation/patient.h"
#include "phalanx/simulation/press_plan.h"

namespace phalanx {

/// @returns the seed of the sensors' noise in a trial. It differs from the trial's seed, which the patient
/// uses, so that their random sequences differ.
[[nodiscard]] constexpr std::uint64_t sensor_seed(std::uint64_t seed) noexcept {
  return seed ^ 0x5eed5e0500000000ULL;
}
/// @returns the phase of the host's clock in a trial, 0 .. 1 of its period.
[[nodiscard]] constexpr double clock_phase(std::uint64_t seed) noexcept {
  return Random(seed ^ 0x5eedc10c00000000ULL).uniform();
}

/// Times of the phases of a trial [s]. The stability criterion evaluates the window.
struct TrialSchedule {
  double start = 0.2;
  double window_begin = 2.7;
  double window_end = 4.2;
  double release = 4.3;
  double release_speed = 0.1;  ///< speed of the fingertip [m/s]
  double end = 5.3;
};

/// The intended angles over time. Each pressing digit moves along its press direction at constant speed, from
/// `kApproach` before the contact to a depth x_end. There, a wall of the given stiffness holds the drawn
/// force at rest,
///   x_end = press (1/kh + 1/k);
/// it stays there until the release. Press, speed and tremor are drawn from the seed, digit by digit. All
/// other joints stay at the open hand. Tremor and bump act on every pressing digit.
class PressIntent {
 public:
  static constexpr double kApproach =
      0.02;  ///< distance from start to contact [m]; less if the joints' ranges end before

  /// Draws press, speed and tremor of each digit. Set-up only.
  /// @param plan, patient  outlive this object, which refers to them
  /// @param wall   stiffness of the wall [N/m] > 0
  /// @param press  force [N], finite and >= 0; the seed's spread is applied to it
  PressIntent(const PressPlan& plan, const PatientParameters& patient, const HandParameters& hand,
              double wall, double press, std::uint64_t seed, const TrialSchedule& schedule);

  [[nodiscard]] JointArray angle(double t) const noexcept;  ///< [rad]
  /// @returns the time at which the last digit's intent reaches its end [s].
  [[nodiscard]] double arrival() const noexcept;
  /// @returns the intended force of a digit [N]; 0 if it does not press.
  [[nodiscard]] double force(int digit) const noexcept {
    return digit_[static_cast<std::size_t>(digit)].force;
  }
  [[nodiscard]] JointArray push(double t) const noexcept;  ///< torque of the bump on each joint [Nm]

 private:
  static constexpr std::size_t kWaves = 3;
  struct Wave {
    double frequency = 0.0;  ///< [Hz]
    double phase = 0.0;      ///< [rad]
  };
  struct Digit {
    const DigitPress* press = nullptr;
    double approach = 0.0;  ///< [m]
    double force = 0.0;     ///< [N]
    double end = 0.0;       ///< [m]
    double speed = 0.0;     ///< [m/s]
    std::array<Wave, kWaves> tremor{};
  };
  [[nodiscard]] double way(const Digit& digit, double t) const noexcept;

  const PressPlan& plan_;
  const PatientParameters& patient_;
  TrialSchedule schedule_;
  std::array<Digit, kDigits> digit_{};
};

}  // namespace phalanx
