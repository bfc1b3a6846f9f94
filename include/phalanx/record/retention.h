// SPDX-License-Identifier: Apache-2.0
// How long recordings are kept, and how much room they may take.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "phalanx/record/recordings.h"

namespace phalanx {

/// Which recordings of a folder are deleted. The default deletes none.
struct RetentionRule {
  std::optional<double> days;          ///< those whose begin and last change are longer ago
  std::optional<std::uint64_t> bytes;  ///< the oldest, until those that remain have at most so many

  [[nodiscard]] bool deletes() const noexcept { return days || bytes; }
};

/// @returns the recordings that the rule deletes, oldest first. The newest whole one always stays, whatever the clock says. A file
/// that is being written, has no end, or was not recorded by this program stays, too, and does not count. An encrypted one
/// without its key is deleted as others are: its name and its frames show begin and end
/// @param all  of a folder, as list_recordings()
/// @param now  UTC [s since 1970]
[[nodiscard]] std::vector<RecordingSummary> expired_recordings(const std::vector<RecordingSummary>& all,
                                                               const RetentionRule& rule, double now);

/// Deletes a recording with its page and the originals of its repairs. @returns what was deleted
/// @throws std::filesystem::filesystem_error
std::vector<std::filesystem::path> delete_recording(const std::filesystem::path& file);

/// @returns the bytes of all recordings of a folder, with the originals of repairs
[[nodiscard]] std::uint64_t recorded_bytes(const std::filesystem::path& folder);

}  // namespace phalanx
