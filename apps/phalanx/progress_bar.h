// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace phalanx {

/// A bar on standard error, only if that is a terminal; gone when it is destroyed.
class ProgressBar {
 public:
  ProgressBar(std::string what, bool wanted);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(std::uint64_t done, std::uint64_t total);
  /// Work of unknown length, in place of the bar.
  void show(const char* doing);

 private:
  std::string what_;
  bool on_;
};

}  // namespace phalanx
