// SPDX-License-Identifier: Apache-2.0
// Expected duration and progress of long work.
#pragma once

#include <cstdint>
#include <string>

namespace phalanx {

/// Formats a duration: "45 s", "3 min 20 s", "5 h 12 min".
[[nodiscard]] std::string duration_text(double seconds);

/// Estimates the duration of work that is shared by all cores, at least 1 s [s]. `processor_seconds` was
/// measured on the machine of README's timings; another one is faster or slower.
[[nodiscard]] double on_all_cores(double processor_seconds) noexcept;

/// Progress bar on standard error, only if that is a terminal; its destructor erases it.
class ProgressBar {
 public:
  ProgressBar(std::string what, bool wanted);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(std::uint64_t done, std::uint64_t total);
  /// Shows work of unknown length in place of the bar.
  void show(const char* doing);

 private:
  std::string what_;
  bool on_;
};

}  // namespace phalanx
