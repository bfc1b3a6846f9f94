// SPDX-License-Identifier: Apache-2.0
// Queue of commands from any thread to the worker of a Session, and of answers back to the owner.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <variant>

#include "phalanx/station/session.h"

namespace phalanx {

/// Lays values over the scene.
struct SetValues {
  Overrides changes;
};
struct LoadScene {
  std::string scene;
};
struct SelectSource {
  HandSource source;
};
/// Tries again to make a station while there is none.
struct MakeStation {};

using Action = std::variant<SetValues, LoadScene, SelectSource, StationOrder, WizardStep, MakeStation>;

/// An action and the callbacks that wait for its outcome.
struct Request {
  Action action;
  std::list<Session::Done> waiting;  ///< oldest first; all but the last belong to overtaken values
  std::string refused;               ///< reason, set by the worker; empty: done
};

/// Requests that the worker makes together: neighbouring SetValues, or one request of another kind.
struct Command {
  std::list<Request> requests;
};

/// Answer to one callback.
struct Answer {
  Session::Done done;
  ChangeOutcome outcome;
};

/// Bounded queue. A dragged slider asks faster than changes are made. Neighbouring sets therefore become one
/// command, and a newer value overtakes a waiting one of the same keys. An overtaken value is never tried,
/// and is answered as overtaken before the newer one. For any thread, where no thread is named;
/// Session::stop() does not pass this queue.
class CommandQueue {
 public:
  static constexpr std::size_t kCommands = 16;  ///< commands that wait for the worker
  static constexpr std::size_t kRequests = 16;  ///< requests of one command, with different keys
  /// Callbacks that wait, until next_answer() returns them: 5 s at 200 sets a second.
  static constexpr std::size_t kAnswers = 1024;

  /// Appends a request and wakes the worker. A MakeStation is not bounded; a second one that waits is left
  /// out.
  /// @param done  may be empty
  /// @throws std::runtime_error if too many wait already or after end(); std::bad_alloc. Done is then not
  /// called
  void ask(Action action, Session::Done done);

  /// Waits for a command. The worker's thread.
  /// @param timeout  longest wait; none: until there is a command or the queue ends
  /// @returns the command as the only element; an empty list after `timeout` or end()
  [[nodiscard]] std::list<Command> take(std::optional<std::chrono::milliseconds> timeout);
  /// Hands a command back, with Request::refused set. The worker's thread; allocates nothing.
  void answer(std::list<Command> done) noexcept;
  /// @returns the next callback, in the order of the commands. The owner's thread.
  [[nodiscard]] std::optional<Answer> next_answer();

  /// Ends the queue: waiting commands are dropped unanswered, and ask() refuses further ones.
  void end() noexcept;
  [[nodiscard]] bool ended() const noexcept;

 private:
  [[nodiscard]] bool join(Command& next) noexcept;
  [[nodiscard]] bool waits_to_make_station() const noexcept;

  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::list<Command> waiting_;
  std::list<Command> answered_;
  std::size_t answers_ = 0;  ///< callbacks in the queue, also of a command that the worker has taken
  bool ended_ = false;
};

/// Writes changes for people: "force.law = hooke, rate_hz = as in the scene".
[[nodiscard]] std::string text_of(const Overrides& changes);
/// Writes a command for people.
[[nodiscard]] std::string text_of(const Command& command);
/// @returns the changes of all SetValues of the command, in their order.
[[nodiscard]] Overrides changes_of(const Command& command);

}  // namespace phalanx
