// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "phalanx/clinic/station_exercises.h"
#include "phalanx/station/session.h"
#include "run/run_console.h"
#include "run/told_openings.h"
#include "terminal/typed_lines.h"

namespace phalanx {

/// State of which the user at the terminal is informed. Lines may be read late: a line typed before another
/// stop or fault does not refer to that one.
struct SeenAtTerminal {
  std::uint64_t stops = 0;
  double fault = 0.0;  ///< FaultEvent::time; 0: none [s]
};

/// Commands that the user types at the terminal of a running station: stop, resume, reset, open, set, scene, quit. The
/// owner's thread.
class TypedCommands {
 public:
  /// What the commands act on. All of it outlives them.
  struct Parts {
    Session& session;
    const std::shared_ptr<StationExercises>& exercises;  ///< null: there are none
    RunConsole& console;
    ToldOpenings& openings;
    bool quiet = false;  ///< no status lines are shown
    /// Reports a command to pages and recording
    std::function<void(const std::string& code, const std::string& text)> tell = {};
  };

  explicit TypedCommands(Parts parts) : parts_(std::move(parts)), seen_(look()) {}

  /// Carries out the lines that wait. A refusal is shown, and ends nothing.
  void handle(TypedLines& typed);
  [[nodiscard]] bool quits() const noexcept { return quit_; }  ///< `quit` was typed

  /// @returns the state at this moment
  [[nodiscard]] SeenAtTerminal look() const;
  /// The user has seen this state in a status line.
  void saw(const SeenAtTerminal& seen) noexcept { seen_ = seen; }
  void saw_fault(double time) noexcept { seen_.fault = time; }  ///< likewise this fault, in a line

 private:
  void carry_out(const TypedLines::Line& typed);
  void look_after(bool granted);
  void resume();
  void reset();
  void resume_exercise();
  [[nodiscard]] bool carries_out_exercise() const;
  void refuse_during_exercise() const;
  void say_change(const std::string& code, const std::string& text, const std::string& line,
                  const ChangeOutcome& outcome);

  const Parts parts_;
  SeenAtTerminal seen_;
  bool quit_ = false;
};

}  // namespace phalanx
