// SPDX-License-Identifier: Apache-2.0
// What the patient wants from moment to moment in a trial: come, press, hold, let go; with tremor and a bump.
#pragma once

#include <array>
#include <cstdint>

#include "phalanx/core/random.h"
#include "phalanx/device/patient.h"
#include "phalanx/device/press_plan.h"

namespace phalanx {

/// A seed's streams of random numbers do not repeat each other: the patient's are drawn from the seed itself,
/// the sensors' noise and the phase of the host's clock (0 .. 1 of its period) from these.
[[nodiscard]] constexpr std::uint64_t sensor_seed(std::uint64_t seed) noexcept {
  return seed ^ 0x5eed5e0500000000ULL;
}
[[nodiscard]] constexpr double clock_phase(std::uint64_t seed) noexcept {
  return Random(seed ^ 0x5eedc10c00000000ULL).uniform();
}

/// When things happen in a trial [s]. The criterion looks at the window.
struct TrialSchedule {
  double start = 0.2;
  double window_begin = 2.7;
  double window_end = 4.2;
  double release = 4.3;
  double release_speed = 0.1;  ///< of the fingertip [m/s]
  double end = 5.3;
};

/// The intended angles over time. Each pressing digit goes along its press direction at constant speed, from
/// `kApproach` before the contact to the depth at which a wall of the given stiffness holds the drawn force
/// at rest,
///   x_end = press (1/kh + 1/k);
/// there it stays until the release. Press, speed and tremor are drawn from the seed, digit by digit. All
/// other joints stay at the open hand. Tremor and bump act on every pressing digit.
class PressIntent {
 public:
  static constexpr double kApproach =
      0.02;  ///< way from the start to the contact, or as much as the joints' ranges allow [m]

  /// @param wall   stiffness of the wall [N/m] > 0
  /// @param press  force [N]; the seed's spread is applied to it
  PressIntent(const PressPlan& plan, const PatientParameters& patient, const HandParameters& hand,
              double wall, double press, std::uint64_t seed, const TrialSchedule& schedule);

  [[nodiscard]] JointArray angle(double t) const noexcept;  ///< [rad]
  /// When the last digit's intent comes to its end [s].
  [[nodiscard]] double arrival() const noexcept;
  /// Force that a digit is meant to reach, 0 for those that do not press [N].
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
