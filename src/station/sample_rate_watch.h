// SPDX-License-Identifier: Apache-2.0
// Comparison of a device's promised rate with the samples that come. docs/safety.md argues window and bound.
#pragma once

#include <cstdint>

#include "phalanx/device/device.h"
#include "phalanx/station/safety_settings.h"

namespace phalanx {

/// Judge of the sample rate. Samples are numbered and dated by the device, so that losses and a busy host do
/// not count:
///   by_device = numbers / the device's seconds
///   by_host   = by_device times the speed of the device's clock,  speed = 1 - (m_k - m_(k-1)) / window
/// m_k is the least of  received - time_us  in window k. A late arrival makes single differences larger, and
/// leaves the least one as it is. So a host that reads late does not change the speed. A window in which the
/// host read fewer than 10 times says nothing about the speed.
///
/// Real-time: O(1), no allocation, lock, throw or I/O.
class SampleRateWatch {
 public:
  /// @param promised_hz  DeviceInfo::rate_hz
  SampleRateWatch(const SafetySettings& settings, double promised_hz) noexcept;

  /// Takes the next sample. At the end of a window it judges the rates.
  void take(const DeviceSample& sample) noexcept;
  /// @returns false if the last full window was beyond the bound.
  [[nodiscard]] bool good() const noexcept { return good_; }
  /// @returns the rates of the last full window.
  [[nodiscard]] const SampleRates& rates() const noexcept { return rates_; }
  /// Forgets all samples: the next one begins a window.
  void forget() noexcept;

 private:
  void begin_window(const DeviceSample& sample) noexcept;
  void judge_window(const DeviceSample& next) noexcept;
  [[nodiscard]] bool outside(double rate) const noexcept;
  [[nodiscard]] double delay(const DeviceSample& sample) const noexcept;

  double window_;
  double factor_;
  SampleRates rates_;
  bool good_ = true;
  bool begun_ = false;
  bool has_before_ = false;      ///< least_before_ and length_before_ are valid
  std::uint64_t anchor_us_ = 0;  ///< time of the first sample; delays are relative to it
  DeviceSample first_{};         ///< of this window
  double least_ = 0.0;           ///< least delay of this window [s]
  double last_received_ = 0.0;   ///< arrival of the last sample [s]
  int reads_ = 0;                ///< different times of arrival in this window
  double least_before_ = 0.0;    ///< least delay of the window before [s]
  double length_before_ = 0.0;   ///< length of the window before, by the host's clock [s]
};

}  // namespace phalanx
