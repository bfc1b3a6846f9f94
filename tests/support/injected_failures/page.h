// SPDX-License-Identifier: Apache-2.0
// What a program whose calls fail and the test that makes them fail share.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

namespace phalanx::test {

/// Environment variable that names the page's file to a program. Beside that file, in FILE.stack, the program
/// leaves the call stack of the call that failed.
inline constexpr const char* kFailuresVariable = "PHALANX_INJECTED_FAILURES";

/// Calls that can fail although the program is right.
enum class FailingCall : std::uint32_t {
  kMemory,   ///< malloc() and its like: ENOMEM
  kMap,      ///< mmap(): ENOMEM
  kOpen,     ///< open(), fopen(), pipe2(), socketpair() and their like: EMFILE
  kWrite,    ///< write() and its like, of descriptors and of C streams: ENOSPC
  kSync,     ///< fsync() and fdatasync(): EIO
  kChange,   ///< rename(), unlink(), mkdir(), ftruncate(): EIO
  kProcess,  ///< fork(): EAGAIN
  kThread,   ///< pthread_create(): EAGAIN
};
inline constexpr std::array<const char*, 8> kFailingCallNames{"memory", "map",    "open",    "write",
                                                              "sync",   "change", "process", "thread"};

/// A call stack from which such a call was made.
struct CallStack {
  std::atomic<std::uint64_t> hash{0};  ///< the same in each run of one build; 0: free
  FailingCall call{};
  bool running = false;      ///< its first call came after the run phase had begun
  bool child = false;        ///< its first call came from a process that the program forked
  std::uint32_t number = 0;  ///< of its first call among all calls, from 1
};

/// Zero bytes are a page that records.
struct FailurePage {
  static constexpr std::size_t kStacks = 1U << 14U;

  // From the test.
  std::atomic<std::uint64_t> fails{0};  ///< CallStack::hash whose first call fails; 0: none, all are recorded
  std::atomic<std::uint32_t> from{0};   ///< number of the first call that is looked at for that
  std::array<char, 16> runs_from{};     ///< name of the thread with which the run phase begins; empty: none

  /// The main thread's first call after so long calls std::terminate() [ns]; 0: none does.
  std::atomic<std::int64_t> terminates_after{0};

  // From the program.
  std::atomic<std::uint32_t> calls{0};
  std::atomic<std::uint32_t> failed{0};    ///< how many calls have failed
  std::atomic<std::uint32_t> left_out{0};  ///< stacks that found no place
  std::atomic<bool> running{false};        ///< the run phase has begun
  std::array<CallStack, kStacks> stack{};
};

}  // namespace phalanx::test
