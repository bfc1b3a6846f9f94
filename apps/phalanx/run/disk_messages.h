// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/record/session_recorder.h"

namespace phalanx {

/// What the user is told of the disk that the recording is written to: that it refuses the data or is slow, that it takes them
/// again, and that steps are lost.
class DiskMessages {
 public:
  /// @param now  the program's clock [s]
  /// @returns what is new, in words. Lost steps are told once more each time that their number has doubled
  [[nodiscard]] std::vector<std::string> next(const RecordingStatus& recording, double now);

  static constexpr double kLongUnsaved =
      0.7;                               ///< age of a step that is not saved, of which the user is told [s]
  static constexpr double kQuiet = 2.0;  ///< for which a disk has to take the data before that is told [s]

 private:
  enum class Disk { kTakes, kSlow, kRefuses };

  Disk told_ = Disk::kTakes;
  double took_since_ = 0.0;      ///< [s]
  std::uint64_t lost_told_ = 0;  ///< steps
};

}  // namespace phalanx
