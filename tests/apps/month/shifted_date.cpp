// SPDX-License-Identifier: Apache-2.0
// A library that LD_PRELOAD puts before a program: its date is that of the computer plus a shift from a file,
// which a test changes while the program runs. The monotonic clock is not changed.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>

namespace {

constexpr const char* kVariable = "PHALANX_SHIFTED_DATE";  // path of a file with one std::int64_t
using ClockGettime = int (*)(clockid_t, timespec*);

/// Maps the file. A program without the variable, or whose file is missing, has the computer's date.
const std::atomic<std::int64_t>* map_shift() noexcept {
  const char* file = ::getenv(kVariable);
  if (file == nullptr) return nullptr;
  const int descriptor = ::open(file, O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return nullptr;
  void* page = ::mmap(nullptr, sizeof(std::int64_t), PROT_READ, MAP_SHARED, descriptor, 0);
  ::close(descriptor);
  return page == MAP_FAILED ? nullptr : static_cast<const std::atomic<std::int64_t>*>(page);
}

/// @returns the shift [s]
std::int64_t shift() noexcept {
  static const std::atomic<std::int64_t>* const mapped = map_shift();
  return mapped == nullptr ? 0 : mapped->load(std::memory_order_relaxed);
}

}  // namespace

extern "C" {

int clock_gettime(clockid_t id, timespec* time) noexcept {
  static const auto next = reinterpret_cast<ClockGettime>(::dlsym(RTLD_NEXT, "clock_gettime"));
  if (id != CLOCK_REALTIME) return next(id, time);
  const long result = ::syscall(SYS_clock_gettime, id, time);
  if (result == 0) time->tv_sec += shift();
  return static_cast<int>(result);
}

time_t time(time_t* out) noexcept {
  timespec now{};
  static_cast<void>(clock_gettime(CLOCK_REALTIME, &now));
  if (out != nullptr) *out = now.tv_sec;
  return now.tv_sec;
}

int gettimeofday(timeval* now, void* /*zone*/) noexcept {
  timespec precise{};
  const int result = clock_gettime(CLOCK_REALTIME, &precise);
  now->tv_sec = precise.tv_sec;
  now->tv_usec = precise.tv_nsec / 1000;
  return result;
}

}  // extern "C"
