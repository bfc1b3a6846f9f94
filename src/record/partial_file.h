// SPDX-License-Identifier: Apache-2.0
// The file that an output is until it is complete.
#pragma once

#include <filesystem>

#include "phalanx/record/output_file.h"

namespace phalanx {

/// @throws std::runtime_error  "cannot WHAT 'FILE': REASON". @param error  an errno
[[noreturn]] void fail_to(const char* what, const std::filesystem::path& file, int error);

/// "<file>.partial"
[[nodiscard]] std::filesystem::path partial_name(const std::filesystem::path& file);

struct PartialFile {
  int descriptor = -1;  ///< open for writing, empty and locked (flock); the caller closes it
  std::filesystem::path finished_earlier;  ///< OutputFile::finished_earlier()
};

/// Makes a new `<file>.partial`. What stands there is removed; with Unfinished::kLeft, a regular file is
/// finished as OutputFile describes. @throws std::runtime_error as OutputFile
[[nodiscard]] PartialFile open_partial(const std::filesystem::path& file, Unfinished unfinished);

/// @returns true if the file has a second line that is whole: the first one is a log's header
[[nodiscard]] bool has_rows(int descriptor) noexcept;

/// Takes the lock of an open file (flock), for as long as it is open. A process that was killed may hold its
/// lock for a moment after it is gone: waits for up to a second.
/// @returns true if it has the lock, false while another one has it. @throws std::system_error
[[nodiscard]] bool lock_file(int descriptor);

}  // namespace phalanx
