// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "phalanx/device/clock.h"
#include "phalanx/station/session.h"
#include "run/run_console.h"

namespace phalanx {

/// What the user at the terminal was told of digits that started inside the object. A digit is opened by the way that was
/// told. The owner's thread.
class ToldOpenings {
 public:
  /// @param session, clock, console  outlive this object
  ToldOpenings(Session& session, const Clock& clock, RunConsole& console)
      : session_(session), clock_(clock), console_(console) {}

  /// Reports digits that started inside the object, and what came of their opening. What waits for a confirmation is
  /// reported again whenever forces have been off.
  void say();

  /// Asks to open a digit by the way that was told last.
  /// @returns what was asked, for the log
  /// @throws std::invalid_argument, with the remedy, if there is no such digit, its way has just been told or has changed
  /// since; as Session::open_digit()
  std::string open(const std::string& name);

 private:
  /// A digit's way out as the user was told of it.
  struct ToldOpening {
    OpeningPhase phase = OpeningPhase::kNone;
    double way = 0.0;           ///< [m]
    std::uint64_t running = 0;  ///< StationView::running
    double time = 0.0;          ///< of the line [s]
  };

  Session& session_;
  const Clock& clock_;
  RunConsole& console_;
  std::array<ToldOpening, kDigits> told_{};
};

}  // namespace phalanx
