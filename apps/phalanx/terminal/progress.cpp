// SPDX-License-Identifier: Apache-2.0
#include "terminal/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <thread>

#include "terminal/error_line.h"

namespace phalanx {

std::string duration_text(double seconds) {
  const auto s = static_cast<long long>(std::llround(seconds));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

double on_all_cores(double processor_seconds) noexcept {
  return std::max(1.0, processor_seconds / std::max(1U, std::thread::hardware_concurrency()));
}

ProgressBar::ProgressBar(std::string what, bool wanted)
    : what_(std::move(what)), on_(wanted && ::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (on_) print_aside("\r\033[K");
}

void ProgressBar::show(std::uint64_t done, std::uint64_t total) {
  if (!on_ || total == 0) return;
  constexpr std::uint64_t kWidth = 40;
  const std::uint64_t filled = kWidth * done / total;
  print_aside(
      fmt::format("\r{} [{:#<{}}{:.<{}}] {:3}%", what_, "", filled, "", kWidth - filled, 100 * done / total));
}

void ProgressBar::show(const char* doing) {
  if (!on_) return;
  print_aside(fmt::format("\r\033[K{} ...", doing));
}

}  // namespace phalanx
