// SPDX-License-Identifier: Apache-2.0
// A thread that owns a Session.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "station/session_fixture.h"

namespace phalanx::test {

/// Owner of a Session on a thread of its own: polls it, and fetches records and fault reports.
class Owner {
 public:
  explicit Owner(Session& session)
      : thread_([this, &session] {
          StepRecord record;
          std::vector<DeviceSample> samples;
          while (!ended_) {
            session.poll();
            while (session.next_record(record, samples)) {
            }
            static_cast<void>(session.take_fault_report());
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
