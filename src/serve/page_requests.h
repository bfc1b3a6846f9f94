// SPDX-License-Identifier: Apache-2.0
// What an operator may ask of the station, and which files a page may name.
#pragma once

#include <filesystem>
#include <string>

#include "phalanx/cockpit.pb.h"
#include "phalanx/station/session.h"

namespace phalanx {

/// Request of an operator, in words for the log of changes.
struct PageRequest {
  std::string code;           ///< of its notice: "set", "scene", ...
  std::string text;           ///< for people
  bool done_at_once = false;  ///< it is done; `done` is not called
  std::string keys = {};      ///< of a "set", each with '\n'
  bool dragging = false;      ///< a later value of the same keys follows
};

/// Passes an operator's message on to the station. Does not read the disk, because the server's thread waits.
/// @param choices  what pages may choose from: write_choices()
/// @param uploads  folder of the meshes that pages have sent
/// @param done     as Session's; not called for a request that is done at once
/// @returns the request, for the log of changes
/// @throws std::invalid_argument if the message is malformed, names another file, or refers to an earlier
/// stop or fault; std::runtime_error if too many changes wait or after Session::shut_down() has begun
PageRequest apply_request(const wire::ToHost& message, Session& session, const wire::Welcome& choices,
                          const std::filesystem::path& uploads, Session::Done done);

/// Checks a value that a page sets. Pages may name shipped files by their bare names, and meshes that pages
/// have sent. They may not name other files of the disk or of the working directory. Reads the value as the
/// scene's reader does, so that it makes no difference how the value is written. Set-up only.
/// @param uploads  folder of the meshes that pages have sent
/// @returns true if the value names another file
[[nodiscard]] bool names_foreign_file(const std::string& key, const std::string& value,
                                      const std::filesystem::path& uploads);

}  // namespace phalanx
