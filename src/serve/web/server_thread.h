// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <thread>

namespace phalanx::web {

/// A thread that gives way to others (give_way()), all signals blocked. @param name  15 bytes at most
[[nodiscard]] std::thread start_nice_thread(const char* name, std::function<void()> work);

}  // namespace phalanx::web
