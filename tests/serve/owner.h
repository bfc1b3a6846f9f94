// SPDX-License-Identifier: Apache-2.0
// A StationHost with an owner of its own, moved by sliders.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "station/host_fixture.h"

namespace phalanx::test {

/// Somebody who does what an owner does, on a thread of its own.
class Owner {
 public:
  explicit Owner(StationHost& host)
      : thread_([this, &host] {
          StepRecord record;
          while (!ended_) {
            host.go_on();
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
