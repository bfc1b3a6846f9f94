// SPDX-License-Identifier: Apache-2.0
#include "serve/upload_work.h"

#include <thread>
#include <utility>

namespace phalanx {

std::optional<Overrides> UploadWork::values() const {
  const std::lock_guard lock(mutex_);
  if (host_ == nullptr) return std::nullopt;
  return host_->state()->values;
}

bool UploadWork::done() const {
  const std::lock_guard lock(mutex_);
  return done_;
}

void UploadWork::finish() {
  const std::lock_guard lock(mutex_);
  done_ = true;
  ended_.notify_all();
}

void UploadWork::abandon(std::chrono::milliseconds wait) {
  std::unique_lock lock(mutex_);
  host_ = nullptr;
  ended_.wait_for(lock, wait, [this] { return done_; });
}

void begin(const std::shared_ptr<UploadWork>& work, std::function<WebAnswer(const ValuesInForce&)> what,
           std::function<void(WebAnswer)> answer) {
  std::thread([work, what = std::move(what), answer = std::move(answer)]() mutable {
    WebAnswer outcome = what([work] { return work->values(); });
    what = nullptr;  // what it holds goes first
    work->finish();
    answer(std::move(outcome));
  }).detach();
}

}  // namespace phalanx
