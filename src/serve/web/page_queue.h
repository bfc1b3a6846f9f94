// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <utility>

#include "phalanx/serve/web_server.h"

namespace phalanx::web {

/// What waits to be written to one page: messages in order, and behind them at most one that newer ones
/// replace.
class PageQueue {
 public:
  PageQueue(std::size_t messages, std::size_t bytes) : messages_(messages), bytes_(bytes) {}

  /// @returns false, and takes nothing, if more would wait than may. One message alone may be of any size.
  [[nodiscard]] bool push(Bytes message);
  /// @returns whether it has replaced one
  bool put_newest(Bytes message) { return std::exchange(newest_, std::move(message)) != nullptr; }
  /// The next one to write; null: nothing waits.
  [[nodiscard]] Bytes take();
  void clear();

 private:
  std::deque<Bytes> waiting_;
  std::size_t waiting_bytes_ = 0;
  Bytes newest_;
  std::size_t messages_;
  std::size_t bytes_;
};

}  // namespace phalanx::web
