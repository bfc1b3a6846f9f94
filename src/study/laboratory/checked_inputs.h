// SPDX-License-Identifier: Apache-2.0
// The inputs of a study's points: their fingerprint, and whether their files are still as they were.
#pragma once

#include <compare>
#include <cstdint>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>

#include "phalanx/study/laboratory/run_study.h"

namespace phalanx {

/// A file of a study's inputs was changed or removed while the study ran.
struct InputsChanged : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Files as they were when they were added: device, inode, size and time of the last change of content. A file that was
/// written again with its old content has another time. One that was moved away and back has not: checked_trial()
/// finds it while another file stands in its place.
class InputFiles {
 public:
  /// Adds a file as it is now. @returns false if it was added before
  bool add(const std::filesystem::path& file);
  /// @returns the first file that is not as it was, or is gone; null if there is none. Several threads may call it.
  [[nodiscard]] const std::filesystem::path* changed() const;
  /// @throws InputsChanged naming changed(). Several threads may call it.
  void refuse_changed() const;

 private:
  struct State {
    std::uint64_t device = 0;
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
/// @throws std::runtime_error naming a file that changes meanwhile
[[nodiscard]] CheckedInputs check_inputs(const Study& study, const StudyCheck& check, int jobs);

/// @returns `trial`, and after each trial InputFiles::refuse_changed(), also if it throws. Both arguments must outlive
/// it. After an InputsChanged `trial` must not be called again: it may have kept what it read from another file.
[[nodiscard]] TrialFunction checked_trial(const TrialFunction& trial, const InputFiles& files);

}  // namespace phalanx
