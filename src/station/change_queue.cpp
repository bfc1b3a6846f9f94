// SPDX-License-Identifier: Apache-2.0
#include "station/change_queue.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <utility>

namespace phalanx {
namespace {

/// Length after which further changes are left out: the text is read often, and people read no more [bytes].
constexpr std::size_t kLongText = 300;

bool sets(const Overrides& changes, const std::string& key) {
  return std::any_of(changes.begin(), changes.end(), [&](const auto& change) { return change.first == key; });
}

bool overtakes(const SetPart& later, const SetPart& earlier) {
  return std::all_of(earlier.changes.begin(), earlier.changes.end(),
                     [&](const auto& change) { return sets(later.changes, change.first); });
}

/// Moves the callbacks of an overtaken part to the newer one, which answers them. Oldest first.
void overtake(SetPart& later, SetPart& earlier) {
  if (earlier.done) earlier.overtaken.push_back(std::move(earlier.done));
  later.overtaken.insert(later.overtaken.begin(), std::make_move_iterator(earlier.overtaken.begin()),
                         std::make_move_iterator(earlier.overtaken.end()));
}

std::size_t answers_of(const ChangeRequest& request) {
  std::size_t count = request.done ? 1 : 0;
  for (const SetPart& part : request.sets) count += part.overtaken.size() + (part.done ? 1 : 0);
  return count;
}

}  // namespace

std::string text_of(const Overrides& changes) {
  std::string text;
  for (const auto& [key, value] : changes) {
    if (text.size() > kLongText) return text + ", ...";
    text +=
        fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, value.empty() ? "as in the scene" : value);
  }
  return text;
}

ChangeAnswer answer_to(SetPart part, std::string refused) {
  return {
      .done = std::move(part.done), .overtaken = std::move(part.overtaken), .refused = std::move(refused)};
}

void ChangeQueue::ask_set(Overrides changes, StationHost::Done done) {
  ChangeRequest request;
  request.text = text_of(changes);
  request.sets.push_back({.changes = std::move(changes), .done = std::move(done), .overtaken = {}});
  ask(std::move(request));
}

void ChangeQueue::ask(ChangeRequest request) {
  const std::lock_guard lock(mutex_);
  if (request.retry && retries()) return;
  const std::size_t answers = answers_of(request);
  if (answers_ + answers > kAnswers)
    throw std::runtime_error(fmt::format(
        "{} changes wait already; wait until the station has made them, and ask again", answers_));
  if (!join(request)) {
    if (waiting_.size() >= kRequests)
      throw std::runtime_error(fmt::format(
          "{} changes wait already; wait until the station has made them, and ask again", waiting_.size()));
    waiting_.push_back(std::move(request));
  }
  answers_ += answers;
}

bool ChangeQueue::join(ChangeRequest& later) {
  if (later.sets.empty() || waiting_.empty() || waiting_.back().sets.empty()) return false;
  ChangeRequest& earlier = waiting_.back();
  SetPart& part = later.sets.front();
  std::vector<SetPart> stays;
  for (SetPart& other : earlier.sets)
    if (!overtakes(part, other)) stays.push_back(other);
  if (stays.size() >= kParts) return false;
  for (auto it = earlier.sets.rbegin(); it != earlier.sets.rend(); ++it)
    if (overtakes(part, *it)) overtake(part, *it);
  earlier.sets = std::move(stays);
  earlier.sets.push_back(std::move(part));
  Overrides all;
  for (const SetPart& one : earlier.sets) all.insert(all.end(), one.changes.begin(), one.changes.end());
  earlier.text = text_of(all);
  return true;
}

bool ChangeQueue::retries() const {
  return std::any_of(waiting_.begin(), waiting_.end(),
                     [](const ChangeRequest& request) { return request.retry; });
}

std::optional<ChangeRequest> ChangeQueue::take() {
  const std::lock_guard lock(mutex_);
  if (waiting_.empty()) return std::nullopt;
  ChangeRequest next = std::move(waiting_.front());
  waiting_.pop_front();
  answers_ -= answers_of(next);
  return next;
}

/// Removes requests one by one: this needs no memory, and each is freed after the lock, since its owner
/// may ask again.
void ChangeQueue::clear() {
  while (take()) {
  }
}

}  // namespace phalanx
