// SPDX-License-Identifier: Apache-2.0
#include "serve/web/page_queue.h"

#include <utility>

namespace phalanx::web {

bool PageQueue::push(Bytes message) {
  const bool full = waiting_.size() >= messages_ || waiting_bytes_ + message->size() > bytes_;
  if (full && !waiting_.empty()) return false;
  waiting_bytes_ += message->size();
  waiting_.push_back(std::move(message));
  return true;
}

Bytes PageQueue::take() {
  if (waiting_.empty()) return std::exchange(newest_, nullptr);
  Bytes first = std::move(waiting_.front());
  waiting_.pop_front();
  waiting_bytes_ -= first->size();
  return first;
}

void PageQueue::clear() {
  waiting_.clear();
  waiting_bytes_ = 0;
  newest_ = nullptr;
}

}  // namespace phalanx::web
