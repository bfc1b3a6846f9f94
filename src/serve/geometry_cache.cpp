// SPDX-License-Identifier: Apache-2.0
#include "serve/geometry_cache.h"

#include <new>
#include <system_error>
#include <thread>
#include <utility>

#include "phalanx/geometry.pb.h"
#include "record/recording/geometry_message.h"

namespace phalanx {
namespace {

/// @param bytes  null: there was no memory
WebResponse response_with(const Bytes& bytes) {
  if (!bytes) return {.status = 500, .type = "text/plain", .body = nullptr, .immutable = false};
  return {.status = 200, .type = "application/x-protobuf", .body = bytes, .immutable = false};
}

}  // namespace

Bytes GeometryCache::encode(const SessionGeometry& geometry) noexcept {
  try {
    wire::Geometry message;
    write_geometry(geometry, message);
    return std::make_shared<const std::string>(message.SerializeAsString());
  } catch (const std::bad_alloc&) {
    return nullptr;
  }
}

void GeometryCache::request(std::shared_ptr<const SessionGeometry> geometry, Respond respond) {
  std::unique_lock lock(mutex_);
  if (bytes_ && revision_ == geometry->revision) {
    const Bytes bytes = bytes_;
    lock.unlock();
    return respond(response_with(bytes));
  }
  requests_.push_back({std::move(geometry), std::move(respond)});
  if (working_) return;
  try {
    std::thread([self = shared_from_this()] { self->work(); }).detach();
    working_ = true;
  } catch (const std::system_error&) {  // no thread: the page requests it again
    const Request refused = std::move(requests_.back());
    requests_.pop_back();
    lock.unlock();
    refused.respond(response_with(nullptr));
  }
}

void GeometryCache::work() {
  std::unique_lock lock(mutex_);
  while (!requests_.empty()) {
    const Request next = std::move(requests_.front());
    requests_.pop_front();
    Bytes bytes = revision_ == next.geometry->revision ? bytes_ : nullptr;
    lock.unlock();
    if (!bytes) bytes = encode(*next.geometry);
    next.respond(response_with(bytes));
    lock.lock();
    bytes_ = std::move(bytes);
    revision_ = next.geometry->revision;
  }
  working_ = false;
}

}  // namespace phalanx
