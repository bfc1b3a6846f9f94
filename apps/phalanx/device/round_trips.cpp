// SPDX-License-Identifier: Apache-2.0
#include "device/round_trips.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace phalanx {

std::uint64_t RoundTrips::send(double now) {
  sent_.push_back({.at = now, .answered = false});
  return sent_.size() - 1;
}

void RoundTrips::receive(std::uint64_t number, double now) {
  if (number >= sent_.size()) return;
  Ping& ping = sent_[number];
  if (ping.answered) {
    ++duplicates_;
    return;
  }
  ping.answered = true;
  seconds_.push_back(now - ping.at);
  if (number < newest_) ++reordered_;
  newest_ = std::max(newest_, number);
}

RoundTripTimes RoundTrips::times() const {
  if (seconds_.empty()) return {};
  std::vector<double> sorted = seconds_;
  std::sort(sorted.begin(), sorted.end());
  const auto part = [&](double of) {
    const double rank = std::ceil(of * static_cast<double>(sorted.size()));
    return sorted[static_cast<std::size_t>(std::max(rank, 1.0)) - 1];
  };
  return {.p50 = part(0.5), .p90 = part(0.9), .p99 = part(0.99), .p999 = part(0.999), .max = sorted.back()};
}

std::string RoundTrips::histogram() const {
  constexpr std::size_t kBins = 16;
  constexpr double kFirst = 31.25e-6;  // upper end of the first bin [s]; 1 ms is the end of a bin
  constexpr std::size_t kWidth = 50;
  std::array<std::uint64_t, kBins> count{};
  for (const double t : seconds_) {
    const double doublings = t > kFirst ? std::ceil(std::log2(t / kFirst)) : 0.0;
    ++count[std::min(static_cast<std::size_t>(doublings), kBins - 1)];
  }
  const std::uint64_t most = *std::max_element(count.begin(), count.end());
  const auto filled = [](std::uint64_t n) { return n > 0; };
  const auto first = std::find_if(count.begin(), count.end(), filled);
  const auto last = std::find_if(count.rbegin(), count.rend(), filled).base();
  std::string text;
  for (auto bin = first; bin < last; ++bin) {
    const auto index = static_cast<int>(bin - count.begin());
    const double end = 1e3 * std::ldexp(kFirst, index);
    const bool open_ended = index + 1 == static_cast<int>(kBins);
    const std::size_t bar = (*bin * kWidth + most - 1) / most;
    text += fmt::format("  {} {:>8.3f} ms {:>8}  {}\n", open_ended ? "more than" : "    up to",
                        open_ended ? end / 2.0 : end, *bin, std::string(bar, '#'));
  }
  return text;
}

}  // namespace phalanx
