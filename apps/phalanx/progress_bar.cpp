// SPDX-License-Identifier: Apache-2.0
#include "progress_bar.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

namespace phalanx {

ProgressBar::ProgressBar(std::string what, bool wanted)
    : what_(std::move(what)), on_(wanted && ::isatty(STDERR_FILENO) == 1) {}

ProgressBar::~ProgressBar() {
  if (on_) fmt::print(stderr, "\r\033[K");
}

void ProgressBar::show(std::uint64_t done, std::uint64_t total) {
  if (!on_ || total == 0) return;
  constexpr std::uint64_t kWidth = 40;
  const std::uint64_t filled = kWidth * done / total;
  fmt::print(stderr, "\r{} [{:#<{}}{:.<{}}] {:3}%", what_, "", filled, "", kWidth - filled,
             100 * done / total);
  std::fflush(stderr);
}

void ProgressBar::show(const char* doing) {
  if (!on_) return;
  fmt::print(stderr, "\r\033[K{} ...", doing);
  std::fflush(stderr);
}

}  // namespace phalanx
