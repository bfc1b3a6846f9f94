// SPDX-License-Identifier: Apache-2.0
// The data that the loop's thread and the link's thread share; nothing else passes between them.
#pragma once

#include <atomic>
#include <cstdint>

#include "phalanx/core/latest.h"
#include "phalanx/device/device.h"
#include "phalanx/device/sample_queue.h"

namespace phalanx {

/// A command, and the time at which the loop sent it [s].
struct SentCommand {
  DeviceCommand command;
  double at = 0.0;
};

/// Counters of LinkStatistics that two threads may change.
struct LinkCounters {
  std::atomic<std::uint64_t> received{0}, lost{0}, outdated{0}, corrupt{0}, refused{0}, overflowed{0},
      sent{0}, device_corrupt{0}, device_refused{0}, device_outdated{0};

  static void count(std::atomic<std::uint64_t>& counter, std::uint64_t more = 1) noexcept {
    counter.fetch_add(more, std::memory_order_relaxed);
  }
};

/// Queues and flags between the two threads.
struct LinkShared {
  SampleQueue samples;                     ///< link -> loop
  Latest<SentCommand> command;             ///< loop -> link
  std::atomic<std::uint32_t> resets{0};    ///< loop -> link: number of reset() calls
  std::atomic<Fault> fault{Fault::kNone};  ///< link -> loop: connection_fault()
  LinkCounters counters;
};

}  // namespace phalanx
