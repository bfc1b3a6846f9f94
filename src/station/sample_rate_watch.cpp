// SPDX-License-Identifier: Apache-2.0
#include "station/sample_rate_watch.h"

#include <algorithm>

namespace phalanx {
namespace {

/// Least number of promised samples for which the rate by the device's clock is judged. Fewer are too coarse.
constexpr double kLeastSamples = 20.0;
/// Least number of the host's reads in a window that is compared with another. After a pause the first read
/// has old samples, and the next ones new samples.
constexpr int kLeastReads = 10;

}  // namespace

SampleRateWatch::SampleRateWatch(const SafetySettings& settings, double promised_hz) noexcept
    : window_(settings.rate_window), factor_(settings.rate_factor), rates_{.promised = promised_hz} {}

void SampleRateWatch::forget() noexcept {
  begun_ = false;
  has_before_ = false;
  good_ = true;
  rates_ = {.promised = rates_.promised};
}

double SampleRateWatch::delay(const DeviceSample& sample) const noexcept {
  return sample.received - 1e-6 * static_cast<double>(static_cast<std::int64_t>(sample.time_us - anchor_us_));
}

bool SampleRateWatch::outside(double rate) const noexcept {
  return rate * factor_ < rates_.promised || rate > factor_ * rates_.promised;
}

void SampleRateWatch::begin_window(const DeviceSample& sample) noexcept {
  if (!begun_) anchor_us_ = sample.time_us;
  begun_ = true;
  first_ = sample;
  least_ = delay(sample);
  last_received_ = sample.received;
  reads_ = 1;
}

void SampleRateWatch::take(const DeviceSample& sample) noexcept {
  if (!begun_) return begin_window(sample);
  // Another order of numbers or times is another fault's concern. A new window begins.
  if (static_cast<std::int32_t>(sample.sequence - first_.sequence) <= 0 || sample.time_us <= first_.time_us) {
    forget();
    return begin_window(sample);
  }
  if (sample.received - first_.received >= window_) {
    judge_window(sample);
    return begin_window(sample);
  }
  least_ = std::min(least_, delay(sample));
  if (sample.received > last_received_) ++reads_;
  last_received_ = sample.received;
}

/// @param next  the first sample after the window
void SampleRateWatch::judge_window(const DeviceSample& next) noexcept {
  const double length = next.received - first_.received;
  const double by_device_clock = 1e-6 * static_cast<double>(next.time_us - first_.time_us);
  const auto count = static_cast<double>(next.sequence - first_.sequence);
  const bool counted = by_device_clock * rates_.promised >= kLeastSamples;
  rates_.by_device = count / by_device_clock;
  rates_.by_host = 0.0;
  good_ = !(counted && outside(rates_.by_device));
  const bool read = reads_ >= kLeastReads;
  if (has_before_ && read) {
    const double speed = std::max(0.0, 1.0 - (least_ - least_before_) / std::max(length, length_before_));
    rates_.by_host = (counted ? rates_.by_device : rates_.promised) * speed;
    good_ = good_ && !outside(rates_.by_host);
  }
  least_before_ = least_;
  length_before_ = length;
  has_before_ = read;
}

}  // namespace phalanx
