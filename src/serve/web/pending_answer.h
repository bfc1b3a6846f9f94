// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <functional>
#include <memory>

#include "phalanx/serve/web_server.h"
#include "serve/web/gate.h"

namespace phalanx::web {

/// An answer that the application owes, from any thread. The first one counts; if it is forgotten, the
/// request is answered nevertheless.
class PendingAnswer {
 public:
  PendingAnswer(std::shared_ptr<Gate> gate, std::function<void(WebAnswer)> deliver)
      : gate_(std::move(gate)), deliver_(std::move(deliver)) {}
  PendingAnswer(const PendingAnswer&) = delete;
  PendingAnswer& operator=(const PendingAnswer&) = delete;
  ~PendingAnswer() {
    WebAnswer none;
    none.status = 500;
    none.body = std::make_shared<const std::string>("The station has no answer to this.\n");
    give(std::move(none));
  }

  void give(WebAnswer answer) {
    if (given_.exchange(true)) return;
    gate_->post([deliver = deliver_, answer = std::move(answer)]() mutable { deliver(std::move(answer)); });
  }

 private:
  std::shared_ptr<Gate> gate_;
  std::function<void(WebAnswer)> deliver_;
  std::atomic<bool> given_{false};
};

}  // namespace phalanx::web
