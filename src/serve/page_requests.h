// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>

#include "phalanx/cockpit.pb.h"
#include "phalanx/station/station_host.h"

namespace phalanx {

/// What an operator's message asks of the station.
struct PageRequest {
  std::string code;       ///< of the notice: "set", "scene", ...
  std::string text;       ///< for people
  bool at_once = false;   ///< it is done already: `done` is not called
  std::string keys = {};  ///< of a "set"
  bool dragging = false;  ///< a later value of the same keys follows
};

/// Hands an operator's message to the host. Its values are checked by the code that reads scene files.
/// @param choices  what pages were told that there is (write_choices()): no disk is asked while others wait
/// @param uploads  folder of the meshes that pages may name
/// @param done     as StationHost's; not called for what is done at once
/// @returns what was asked, for the log
/// @throws std::invalid_argument: not for a station, refused at once, or said before its page knew of another
/// stop or fault; as StationHost if too much waits
PageRequest hand_over(const wire::ToHost& message, StationHost& host, const wire::Welcome& choices,
                      const std::filesystem::path& uploads, StationHost::Done done);

}  // namespace phalanx
