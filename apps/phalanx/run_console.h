// SPDX-License-Identifier: Apache-2.0
// What a person at the terminal of a running station sees and types.
#pragma once

#include <string>

#include "phalanx/station/station.h"

namespace phalanx {

/// "  12.0 s  running   index 3.2 N  thumb 1.1 N   step 9 us (p99.9 41)   woken 61 us late (p99.9 180)   ..."
[[nodiscard]] std::string status_line(const StationView& view, const DeadlineStatistics& deadlines,
                                      double seconds);

/// Lines typed, without waiting for them. Standard input that ends is not asked again.
class TypedLines {
 public:
  /// @returns whether a whole line was there
  bool next(std::string& line);

 private:
  std::string pending_;
  bool ended_ = false;
};

}  // namespace phalanx
