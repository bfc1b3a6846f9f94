// SPDX-License-Identifier: Apache-2.0
#include "serve/shapes.h"

#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "serve/geometry_message.h"

namespace phalanx {
namespace {

/// @param bytes  none: there was no memory, and the server has an answer of its own to that
WebAnswer answer_of(const Bytes& bytes) {
  if (!bytes) return {.status = 500, .type = "text/plain", .body = nullptr, .immutable = false};
  return {.status = 200, .type = "application/x-protobuf", .body = bytes, .immutable = false};
}

}  // namespace

Bytes Shapes::encode(const HostGeometry& shown) noexcept {
  try {
    return std::make_shared<const std::string>(geometry_message(shown));
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void Shapes::ask(std::shared_ptr<const HostGeometry> shown, Answer answer) {
  std::unique_lock lock(mutex_);
  if (bytes_ && revision_ == shown->revision) {
    const Bytes bytes = bytes_;
    lock.unlock();
    return answer(answer_of(bytes));
  }
  asked_.push_back({std::move(shown), std::move(answer)});
  if (working_) return;
  try {
    std::thread([self = shared_from_this()] { self->work(); }).detach();
    working_ = true;
  } catch (const std::system_error&) {  // no thread to be had: the page asks again
    const Asked refused = std::move(asked_.back());
    asked_.pop_back();
    lock.unlock();
    refused.answer(answer_of(nullptr));
  }
}

void Shapes::work() {
  std::unique_lock lock(mutex_);
  while (!asked_.empty()) {
    const Asked next = std::move(asked_.front());
    asked_.pop_front();
    Bytes bytes = revision_ == next.shown->revision ? bytes_ : nullptr;
    lock.unlock();
    if (!bytes) bytes = encode(*next.shown);
    next.answer(answer_of(bytes));
    lock.lock();
    bytes_ = std::move(bytes);
    revision_ = next.shown->revision;
  }
  working_ = false;
}

}  // namespace phalanx
