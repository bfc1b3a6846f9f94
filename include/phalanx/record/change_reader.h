// SPDX-License-Identifier: Apache-2.0
// The changes of a session, for recorders that follow each other.
#pragma once

#include <cstdint>
#include <deque>

#include "phalanx/station/session.h"

namespace phalanx {

/// Changes that a session has kept and no recording has written yet. A recorder takes those of its stations; the others
/// remain for the recorder after it. One thread, not real-time.
class ChangeReader {
 public:
  /// @param session  of SessionSettings::keep_changes; outlives the reader
  explicit ChangeReader(Session& session) : session_(session) {}

  /// Fetches what the session has kept. @throws std::bad_alloc; no change is lost then
  void fetch();
  /// @returns the oldest change, after fetch(); null: there is none
  [[nodiscard]] const SessionChange* next();
  /// Removes the oldest change.
  void pop() noexcept;

  // ---- among those that were fetched
  /// @returns the beginning of a station; null: it is not here
  [[nodiscard]] const SessionChange* beginning_of(std::uint64_t station) const noexcept;
  /// @returns the station that was ordered with StationOrder::recording; 0: it is not here
  [[nodiscard]] std::uint64_t station_with(std::uint64_t recording) const noexcept;
  /// Removes the changes of stations up to this one. Nothing of them will be recorded.
  void drop_through(std::uint64_t station) noexcept;

 private:
  Session& session_;
  std::deque<SessionChange> waiting_;
};

}  // namespace phalanx
