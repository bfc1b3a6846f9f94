// SPDX-License-Identifier: Apache-2.0
#include "run/typed_commands.h"

#include <fmt/format.h>

#include <exception>
#include <stdexcept>

#include "phalanx/scene/scene.h"
#include "terminal/end_signals.h"
#include "terminal/error_line.h"

namespace phalanx {

SeenAtTerminal TypedCommands::look() const {
  const std::uint64_t stops = parts_.session.stops();
  const FaultEvent fault = parts_.session.view().fault;
  return {.stops = stops, .fault = fault.fault == Fault::kNone ? 0.0 : fault.time};
}

/// Updates `seen_` after a command. After a refusal, only the next status line counts as seen: a second
/// `resume` typed with the first must not end a stop that was not shown. Without status lines, the
/// refusal itself counts.
void TypedCommands::look_after(bool granted) {
  if (granted || parts_.quiet) seen_ = look();
}

void TypedCommands::handle(TypedLines& typed) {
  while (asked_to_end == 0 && !quit_) {
    const auto line = typed.next();
    if (!line) break;
    try {
      carry_out(*line);
    } catch (const std::exception& error) {  // a refusal ends nothing
      parts_.console.complain(reason(error));
    }
  }
  if (const std::size_t left_out = typed.take_left_out(); left_out > 0)
    parts_.console.complain(
        fmt::format("{} lines were left out: they came faster than they are handled", left_out),
        Emphasis::kWarning);
}

void TypedCommands::carry_out(const TypedLines::Line& typed) {
  const std::string& line = typed.text;
  if (line == "stop") {  // TypedLines has stopped already
    seen_ = look();
    seen_.stops = typed.stops;
    parts_.tell("stopped", "stopped");
  } else if (line == "resume") {
    resume();
  } else if (line == "reset") {
    reset();
  } else if (line.starts_with("open ")) {
    parts_.tell("opened", parts_.openings.open(line.substr(5)));
  } else if (line == "quit") {
    quit_ = true;
    parts_.tell("quit", "ends the station");
  } else if (line.starts_with("set ")) {
    refuse_during_exercise();
    const std::string change = line.substr(4);
    parts_.session.set({parse_override(change)}, [this, change](const ChangeOutcome& outcome) {
      say_change("set", change, change, outcome);
    });
  } else if (line.starts_with("scene ")) {
    refuse_during_exercise();
    parts_.session.load_scene(line.substr(6), [this, line](const ChangeOutcome& outcome) {
      say_change("scene", line.substr(6), line, outcome);
    });
  } else if (!line.empty()) {
    throw std::invalid_argument(fmt::format(
        "'{}' is not understood; type stop, resume, reset, open DIGIT, set KEY=VALUE, scene NAME or quit",
        line));
  }
}

void TypedCommands::resume() {
  if (carries_out_exercise()) {
    resume_exercise();
    return parts_.tell("resumed", "resumed the exercise");
  }
  const bool resumed = parts_.session.resume(seen_.stops);
  look_after(resumed);
  if (!resumed) throw std::invalid_argument("another stop or fault has come since; look, then resume again");
  parts_.tell("resumed", "resumed");
}

void TypedCommands::reset() {
  const bool asked = parts_.session.reset(seen_.fault);
  look_after(asked);
  if (!asked) throw std::invalid_argument("another fault has come since; look, then reset again");
  parts_.tell("reset", "asked for a reset");
}

/// Resumes the exercise. It ends no stop that the user at the terminal has not seen.
void TypedCommands::resume_exercise() {
  try {
    parts_.exercises->input({.kind = ExerciseInput::Kind::kResume},
                            {.stops = seen_.stops, .account = "the terminal"});
  } catch (const std::exception&) {
    look_after(false);
    throw;
  }
}

bool TypedCommands::carries_out_exercise() const { return parts_.exercises && parts_.exercises->busy(); }

void TypedCommands::refuse_during_exercise() const {
  if (carries_out_exercise()) throw std::invalid_argument("an exercise runs; end it first, on its page");
}

void TypedCommands::say_change(const std::string& code, const std::string& text, const std::string& line,
                               const ChangeOutcome& outcome) {
  RunConsole& console = parts_.console;
  if (!outcome.refused.empty()) return console.say("refused: " + outcome.refused, Emphasis::kError);
  if (outcome.overtaken) return console.say("overtaken by a newer value: " + line);
  console.say("changed: " + line);
  parts_.tell(code, text);
}

}  // namespace phalanx
