// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace phalanx::testing {

/// As long as it lives, threads of a name get no memory from operator new. One at a time.
class StarvedThread {
 public:
  /// @param name  as pthread_setname_np() has set it; nullptr: the calling thread's own
  explicit StarvedThread(const char* name = nullptr);
  StarvedThread(const StarvedThread&) = delete;
  StarvedThread& operator=(const StarvedThread&) = delete;
  ~StarvedThread();
};

}  // namespace phalanx::testing
