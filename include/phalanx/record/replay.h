// SPDX-License-Identifier: Apache-2.0
// A recording played again through the code that the station runs: same samples and changes, same bits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "phalanx/record/recording_keys.h"

namespace phalanx {

class ReplayVisitor;

/// The first step of a replay that differs from the recording.
struct ReplayDifference {
  std::uint64_t station = 0;
  std::uint64_t tick = 0;
  double time = 0.0;  ///< since the first step of the recording [s]
  std::string what;   ///< "channel 3 (angle of index_pip): ..."
};

/// Result of replay().
struct ReplayResult {
  std::uint64_t stations = 0;
  std::uint64_t steps = 0;      ///< in the file
  std::uint64_t compared = 0;   ///< made again and compared
  std::uint64_t different = 0;  ///< of those compared
  std::uint64_t missing = 0;    ///< that the file does not have
  std::uint64_t not_compared =
      0;                 ///< after a gap, until the next station begins: what they depended on is missing
  double seconds = 0.0;  ///< from the first to the last step of the file
  bool exact = true;     ///< compared to the last bit; else commands and angles to kTolerance
  std::optional<ReplayDifference> first;
  double largest_torque = 0.0;  ///< largest difference of a torque that was sent [Nm]
  std::string recorded_by;      ///< version and commit of the program
  std::string recorded_on;      ///< processor
  bool other_version = false;   ///< another version or commit than this program's
  bool other_machine = false;   ///< sines and cosines of this machine have other bits

  static constexpr double kTolerance = 1e-9;  ///< [Nm], [rad]
};

/// Makes every step of a recording again, with what it depended on, and compares its hash: through live changes, exchanges,
/// faults, resets and stops. Where this machine's sine and cosine round otherwise than the recording's, it compares the
/// commands and, 60 times a second, the angles to ReplayResult::kTolerance.
/// @param on_progress  gets the part that is read, 0 .. 1, some times a second; may be empty
/// @param visitor      gets each step that is made again, and what is missing; null: none
/// @param keys         of encrypted recordings; may be empty
/// @throws std::runtime_error if the file is not whole, is encrypted and without its key, is no recording, or needs what this version cannot make; what() names
/// the place and the remedy. Not real-time.
[[nodiscard]] ReplayResult replay(const std::filesystem::path& file,
                                  const std::function<void(double)>& on_progress = {},
                                  ReplayVisitor* visitor = nullptr, const FindRecordingKey& keys = {});

}  // namespace phalanx
