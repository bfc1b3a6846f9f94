// SPDX-License-Identifier: Apache-2.0
#include "phalanx/station/deadline_statistics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "station/pacer.h"

namespace phalanx {

void Histogram::merge(const Histogram& other) noexcept {
  for (std::size_t i = 0; i < kBins; ++i) count_[i] += other.count_[i];
  total_ += other.total_;
  max_ = std::max(max_, other.max_);
}

double Histogram::middle(std::size_t bin) noexcept {
  const std::size_t place = bin - 1;
  const double within = (static_cast<double>(place % kPerOctave) + 0.5) / static_cast<double>(kPerOctave);
  return kFloor * std::ldexp(1.0 + within, static_cast<int>(place / kPerOctave));
}

double Histogram::percentile_us(double percent) const noexcept {
  if (total_ == 0) return 0.0;
  const double wanted = std::ceil(percent * static_cast<double>(total_) / 100.0);
  const double rank = std::clamp(wanted, 1.0, static_cast<double>(total_));
  if (rank >= static_cast<double>(total_)) return max_us();
  std::uint64_t seen = count_.front();
  if (static_cast<double>(seen) >= rank) return std::min(1e6 * kFloor, max_us());
  for (std::size_t i = 1; i + 1 < kBins; ++i) {
    seen += count_[i];
    if (static_cast<double>(seen) >= rank) return std::min(1e6 * middle(i), max_us());
  }
  return max_us();
}

std::uint64_t Histogram::in_octave(std::size_t k) const noexcept {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < kPerOctave; ++i) sum += count_[1 + k * kPerOctave + i];
  return sum;
}

namespace {

std::string row(const std::string& range, std::uint64_t count, std::uint64_t total) {
  constexpr double kBar = 50.0;
  const double share = static_cast<double>(count) / static_cast<double>(total);
  // Every count above 0 shows: the rare long durations are what a reader looks for.
  const auto length = static_cast<std::size_t>(std::ceil(kBar * share));
  const std::string bar(length, '#');
  return fmt::format("  {:>24} us {:>10} {:>8.3f} % {}\n", range, count, 100.0 * share, bar);
}

}  // namespace

std::string histogram_text(const Histogram& histogram, const std::string& title) {
  const std::uint64_t total = histogram.count();
  if (total == 0) return fmt::format("{}: nothing measured\n", title);
  std::string text =
      fmt::format("{}: {} measured; 50 % {:.1f}, 99 % {:.1f}, 99.9 % {:.1f}, longest {:.1f} us\n", title,
                  total, histogram.percentile_us(50.0), histogram.percentile_us(99.0),
                  histogram.percentile_us(99.9), histogram.max_us());
  if (histogram.below_range() > 0) text += row("under 0.1", histogram.below_range(), total);
  std::size_t first = 0;
  std::size_t last = Histogram::kOctaves;
  while (first < last && histogram.in_octave(first) == 0) ++first;
  while (last > first && histogram.in_octave(last - 1) == 0) --last;
  for (std::size_t k = first; k < last; ++k) {
    const double low = 1e6 * std::ldexp(Histogram::kFloor, static_cast<int>(k));
    text += row(fmt::format("{:.1f} .. {:.1f}", low, 2.0 * low), histogram.in_octave(k), total);
  }
  if (histogram.above_range() > 0) text += row("longer", histogram.above_range(), total);
  return text;
}

void DeadlineStatistics::add(const Wake& wake, double step_end) noexcept {
  ++steps;
  skipped += wake.skipped;
  lateness.add(wake.lateness);
  step.add(step_end - wake.now);
  if (step_end <= wake.deadline + period) {
    overruns_in_row = 0;
    return;
  }
  ++overruns;
  ++overruns_in_row;
  longest_run = std::max(longest_run, overruns_in_row);
  last_overrun = step_end;
}

void DeadlineStatistics::append(const DeadlineStatistics& later) noexcept {
  period = later.period;
  lateness.merge(later.lateness);
  step.merge(later.step);
  steps += later.steps;
  overruns += later.overruns;
  overruns_in_row = later.overruns_in_row;
  longest_run = std::max(longest_run, later.longest_run);
  skipped += later.skipped;
  if (later.overruns > 0) last_overrun = later.last_overrun;
}

}  // namespace phalanx
