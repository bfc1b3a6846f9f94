// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <thread>

namespace phalanx::web {

/// A thread that gives way to others: SCHED_OTHER, nice 5 (or what the process has, if that is nicer), all
/// signals blocked.
[[nodiscard]] std::thread start_nice_thread(std::function<void()> work);

}  // namespace phalanx::web
