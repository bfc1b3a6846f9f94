// SPDX-License-Identifier: Apache-2.0
// From a station's steps to what exercises observe: the same code while the station runs and in a replay.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "phalanx/exercise/observation.h"
#include "phalanx/station/station_view.h"

namespace phalanx {

/// Converter from a station's steps to observations. Same steps, same observations, to the last bit.
///
/// - Time: StepInput::time since the first step that is observed. It goes on over a change of station.
/// - Time of the sample: of the device's clock; the first one of a station has the time of its step.
/// - Force: StepRecord::force times StepRecord::sent_share, what ramps and limits leave of it on the way to
///   the device.
/// - Fault: ObservationFault::kNotFinite if an angle, a force, the factor or the time is not finite; else
///   kGap if steps of the station are missing before this one, or if time does not increase; else kFault in
///   SafetyState::kFault; else kNoSample if no sample of this station has come yet, or if the newest is older
///   than most_age().
/// - Torque is on in SafetyState::kStarting, kRunning and kStopping while the factor is above zero.
///
/// Not real-time: it runs beside the loop.
class HandObserver {
 public:
  /// Bounds of most_age() [s]: 2.5 intervals of a signal of 100 Hz, at which scores are interpolated, and
  /// of 25 Hz.
  static constexpr double kLeastLimit = 0.025;
  static constexpr double kMostAge = 0.1;

  /// Observes the next step, in the order of the steps.
  [[nodiscard]] Observation observe(const StepRecord& record) noexcept;
  /// Notes that steps are missing before the next one.
  void gap() noexcept { gap_ = true; }
  /// @returns the longest age of a sample for a step that is scored: 2.5 of the device's own intervals, the
  /// median of the last 9, within the bounds above; kMostAge before there are 9. A station with motors ends
  /// in a fault after 10 ms already (SafetySettings::sample_timeout), without motors it may be slower [s]
  [[nodiscard]] double most_age() const noexcept { return most_age_; }

 private:
  void hear(const StepRecord& record, double time) noexcept;
  void note_interval(double interval) noexcept;
  [[nodiscard]] ObservationFault fault_of(const StepRecord& record, const Observation& out) const noexcept;

  bool first_ = true;
  bool gap_ = false;
  double begin_ = 0.0;  ///< time of the first step, the host's clock [s]
  double time_ = 0.0;   ///< Observation::time of the newest step [s]
  std::uint64_t station_ = 0;
  std::uint64_t tick_ = 0;
  bool heard_ = false;           ///< a sample of this station has come
  double heard_at_ = 0.0;        ///< of the newest step with a sample, the host's clock [s]
  double first_heard_ = 0.0;     ///< Observation::time of this station's first step with a sample [s]
  std::uint64_t first_us_ = 0;   ///< of that sample, the device's clock [us]
  std::uint64_t newest_us_ = 0;  ///< of the newest sample, likewise [us]
  std::uint32_t sequence_ = 0;   ///< of the newest sample
  double sample_time_ = std::numeric_limits<double>::quiet_NaN();  ///< of the newest sample [s]
  std::array<double, 9> interval_{};                               ///< of the device's last samples [s]
  std::size_t intervals_ = 0;                                      ///< that have been noted
  double most_age_ = kMostAge;
};

}  // namespace phalanx
