// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/change_reader.h"

#include <algorithm>

namespace phalanx {

void ChangeReader::fetch() {
  for (;;) {
    waiting_.emplace_back();  // before the change leaves the session: without memory it stays there
    if (session_.next_change(waiting_.back())) continue;
    waiting_.pop_back();
    return;
  }
}

const SessionChange* ChangeReader::next() {
  if (waiting_.empty()) fetch();
  return waiting_.empty() ? nullptr : &waiting_.front();
}

void ChangeReader::pop() noexcept {
  if (!waiting_.empty()) waiting_.pop_front();
}

const SessionChange* ChangeReader::beginning_of(std::uint64_t station) const noexcept {
  const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const SessionChange& change) {
    return change.number == 0 && change.station == station;
  });
  return found == waiting_.end() ? nullptr : &*found;
}

std::uint64_t ChangeReader::station_with(std::uint64_t recording) const noexcept {
  const auto found = std::find_if(waiting_.begin(), waiting_.end(), [&](const SessionChange& change) {
    return change.number == 0 && change.recording == recording;
  });
  return recording == 0 || found == waiting_.end() ? 0 : found->station;
}

void ChangeReader::drop_through(std::uint64_t station) noexcept {
  while (!waiting_.empty() && waiting_.front().station <= station) waiting_.pop_front();
}

}  // namespace phalanx
