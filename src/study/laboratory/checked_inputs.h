// SPDX-License-Identifier: Apache-2.0
// The inputs of a study's points: their fingerprint, and whether their files are still as they were.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "phalanx/study/laboratory/run_study.h"

namespace phalanx {

/// Files as they were when they were added: inode, size and time of the last change of content. A file that was changed
/// and restored has another time.
class InputFiles {
 public:
  /// Adds a file as it is now, unless it was added before.
  void add(const std::filesystem::path& file);
  /// @throws std::runtime_error naming the first file that is not as it was, or is gone. Several threads may call it.
  void refuse_changed() const;

 private:
  struct State {
    std::uint64_t inode = 0;
    std::int64_t size = -1;  ///< [byte]; -1: there is no file
    std::int64_t seconds = 0;
    std::int64_t nanoseconds = 0;
    auto operator<=>(const State&) const = default;
  };
  static State state_of(const std::filesystem::path& file) noexcept;

  std::map<std::filesystem::path, State> states_;
};

/// Inputs of all points of a study.
struct CheckedInputs {
  std::string fingerprint;
  InputFiles files;
};

/// As check_study(), with the files as they were when their points were checked.
[[nodiscard]] CheckedInputs check_inputs(const Study& study, const StudyCheck& check, int jobs);

}  // namespace phalanx
