// SPDX-License-Identifier: Apache-2.0
// A thread that owns a StationHost.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "station/host_fixture.h"

namespace phalanx::test {

/// Owner of a StationHost on a thread of its own: polls it, and fetches records and fault reports.
class Owner {
 public:
  explicit Owner(StationHost& host)
      : thread_([this, &host] {
          StepRecord record;
          while (!ended_) {
            host.poll();
            while (host.next_record(record)) {
            }
            static_cast<void>(host.take_fault_report());
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
          }
        }) {}
  Owner(const Owner&) = delete;
  Owner& operator=(const Owner&) = delete;
  ~Owner() {
    ended_ = true;
    thread_.join();
  }

 private:
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace phalanx::test
