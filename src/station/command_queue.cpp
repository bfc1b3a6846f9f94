// SPDX-License-Identifier: Apache-2.0
#include "station/command_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace phalanx {
namespace {

/// Length after which further changes are left out: the text is read often, and people read no more [bytes].
constexpr std::size_t kLongText = 300;

bool sets(const Overrides& changes, const std::string& key) {
  return std::any_of(changes.begin(), changes.end(), [&](const auto& change) { return change.first == key; });
}

/// @returns true if `later` has newer values of all keys of `earlier`
bool overtakes(const SetValues& later, const SetValues& earlier) {
  return std::all_of(earlier.changes.begin(), earlier.changes.end(),
                     [&](const auto& change) { return sets(later.changes, change.first); });
}

template <class Kind>
bool is(const Command& command) noexcept {
  return std::holds_alternative<Kind>(command.requests.front().action);
}

std::runtime_error too_many(std::size_t waiting) {
  return std::runtime_error(
      fmt::format("{} changes wait to be made or answered; wait a moment, and ask again", waiting));
}

}  // namespace

// ---- texts ----

std::string text_of(const Overrides& changes) {
  std::string text;
  for (const auto& [key, value] : changes) {
    if (text.size() > kLongText) return text + ", ...";
    text +=
        fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, value.empty() ? "as in the scene" : value);
  }
  return text;
}

std::string text_of(const Command& command) {
  const Action& action = command.requests.front().action;
  if (std::holds_alternative<SetValues>(action)) return text_of(changes_of(command));
  if (const auto* scene = std::get_if<LoadScene>(&action)) return "scene " + scene->scene;
  if (const auto* order = std::get_if<StationOrder>(&action)) return "another station, scene " + order->scene;
  if (const auto* hand = std::get_if<SelectSource>(&action))
    return hand->source == HandSource::kSliders ? "sliders" : "simulated patient";
  return std::holds_alternative<WizardStep>(action) ? "calibration" : "another try";
}

Overrides changes_of(const Command& command) {
  Overrides all;
  for (const Request& request : command.requests)
    if (const auto* set = std::get_if<SetValues>(&request.action))
      all.insert(all.end(), set->changes.begin(), set->changes.end());
  return all;
}

// ---- any thread ----

// All memory is allocated before the lock: joining, taking, answering and ending need none.
void CommandQueue::ask(Action action, Session::Done done) {
  std::list<Command> next(1);
  Request& request = next.front().requests.emplace_back();
  request.action = std::move(action);
  request.waiting.push_back(std::move(done));
  {
    const std::lock_guard lock(mutex_);
    if (ended_) throw std::runtime_error("the station has ended; start it again");
    const bool makes_station = is<MakeStation>(next.front());
    if (makes_station && waits_to_make_station()) return;
    if (!makes_station && answers_ >= kAnswers) throw too_many(answers_);
    if (!join(next.front())) {
      if (!makes_station && waiting_.size() >= kCommands) throw too_many(waiting_.size());
      waiting_.splice(waiting_.end(), next);
    }
    ++answers_;
  }
  changed_.notify_one();
}

/// Joins a set to the last waiting command, if that consists of sets too. The callbacks of overtaken requests
/// move to the newer one.
/// @returns false, with no effect, if it cannot
bool CommandQueue::join(Command& next) noexcept {
  if (waiting_.empty() || !is<SetValues>(next) || !is<SetValues>(waiting_.back())) return false;
  Request& later = next.requests.front();
  std::list<Request>& earlier = waiting_.back().requests;
  const auto overtaken = [&later](const Request& request) {
    return overtakes(std::get<SetValues>(later.action), std::get<SetValues>(request.action));
  };
  const auto gone = std::count_if(earlier.begin(), earlier.end(), overtaken);
  if (earlier.size() - static_cast<std::size_t>(gone) >= kRequests) return false;
  std::list<Session::Done> older;
  for (Request& request : earlier)
    if (overtaken(request)) older.splice(older.end(), request.waiting);
  later.waiting.splice(later.waiting.begin(), older);
  earlier.remove_if(overtaken);
  earlier.splice(earlier.end(), next.requests);
  return true;
}

bool CommandQueue::waits_to_make_station() const noexcept {
  return std::any_of(waiting_.begin(), waiting_.end(), is<MakeStation>);
}

bool CommandQueue::ended() const noexcept {
  const std::lock_guard lock(mutex_);
  return ended_;
}

void CommandQueue::end() noexcept {
  std::list<Command> dropped;  // freed after the lock: what a callback owns may call ask() when it is freed
  {
    const std::lock_guard lock(mutex_);
    ended_ = true;
    dropped.swap(waiting_);
  }
  changed_.notify_all();
}

// ---- the worker's thread ----

std::list<Command> CommandQueue::take(std::optional<std::chrono::milliseconds> timeout) {
  std::list<Command> taken;
  std::unique_lock lock(mutex_);
  const auto due = [this] { return ended_ || !waiting_.empty(); };
  if (timeout)
    changed_.wait_for(lock, *timeout, due);
  else
    changed_.wait(lock, due);
  if (!waiting_.empty()) taken.splice(taken.begin(), waiting_, waiting_.begin());
  return taken;
}

void CommandQueue::answer(std::list<Command> done) noexcept {
  const std::lock_guard lock(mutex_);
  answered_.splice(answered_.end(), done);
}

// ---- the owner's thread ----

std::optional<Answer> CommandQueue::next_answer() {
  const std::lock_guard lock(mutex_);
  while (!answered_.empty()) {
    std::list<Request>& requests = answered_.front().requests;
    if (requests.empty()) {
      answered_.pop_front();
    } else if (Request& request = requests.front(); request.waiting.empty()) {
      requests.pop_front();
    } else {
      Answer answer{.done = std::move(request.waiting.front()), .outcome = {}};
      request.waiting.pop_front();
      --answers_;
      answer.outcome.overtaken = !request.waiting.empty();
      if (!answer.outcome.overtaken) answer.outcome.refused = std::move(request.refused);
      if (answer.done) return answer;
    }
  }
  return std::nullopt;
}

}  // namespace phalanx
