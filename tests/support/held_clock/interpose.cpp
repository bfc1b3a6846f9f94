// SPDX-License-Identifier: Apache-2.0
// The C library's functions that tell CLOCK_MONOTONIC or wait for it, replaced: under a held clock they tell
// and wait for its time. Linked into test programs, and as a library that LD_PRELOAD puts before a program.
// Without a held clock they are the system calls.
#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/timerfd.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>

#include "support/held_clock/interpose.h"

namespace phalanx::test {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr int kFreeLooks = 1000;         ///< of the clock by a thread that never waits; each more takes kSpin
constexpr std::int64_t kSpin = 1000;     ///< [ns]: a loop that waits for a time by reading the clock must end
constexpr std::int64_t kYield = 20'000;  ///< [ns]: the same for a loop that yields
constexpr const char* kLoop = "phalanx-loop";  ///< name of the thread of a station's loop
constexpr long kNap = 500'000;                 ///< real time between two looks from a condition variable [ns]

std::atomic<ClockPage*> held{nullptr};

/// This thread's place on the page, given back at its end.
struct Place {
  ~Place() {
    if (wait != nullptr) wait->give_back();
  }
  ClockWait* take(ClockPage& page) noexcept {
    const auto tid = static_cast<std::int32_t>(::syscall(SYS_gettid));
    if (wait != nullptr && wait->tid.load() == tid) return wait;
    for (ClockWait& place : page.wait)  // of the program that this process was before exec()
      if (place.tid.load() == tid) return own(place);
    for (ClockWait& place : page.wait) {
      std::int32_t free = 0;
      if (!place.tid.compare_exchange_strong(free, tid)) continue;
      return own(place);
    }
    std::fputs("held clock: more threads than it has places for\n", stderr);
    std::abort();
  }
  ClockWait* own(ClockWait& place) noexcept {
    place.pid.store(::getpid());
    place.kind.store(WaitKind::kNone);
    return wait = &place;
  }
  ClockWait* wait = nullptr;
};
thread_local Place own_place;
/// This thread's reads of the clock, and waits that something ended, since time last moved on.
thread_local int looks = 0;
thread_local std::int64_t last_look = 0;

/// Time goes on for a thread that looks at the clock again and again.
bool looks_too_often(ClockPage& page) noexcept {
  const std::int64_t now = page.now.load();
  if (now != last_look) looks = 0;
  last_look = now;
  return ++looks > kFreeLooks;
}
void spend(ClockPage& page, std::int64_t time) noexcept {
  last_look = page.now.fetch_add(time) + time;
  looks = kFreeLooks;
}

std::int64_t of(const timespec& t) noexcept { return t.tv_sec * kSecond + t.tv_nsec; }
timespec to_timespec(std::int64_t ns) noexcept { return {ns / kSecond, ns % kSecond}; }

/// Enters the wait, then calls `look` until it returns false.
template <class Look>
void wait_until(ClockPage& page, WaitKind kind, std::int64_t deadline, Look look,
                bool terminal = false) noexcept {
  if (looks_too_often(page)) spend(page, kSpin);
  ClockWait& wait = *own_place.take(page);
  page.waits.fetch_add(1);
  wait.woken.store(0);
  wait.terminal.store(terminal);
  wait.deadline.store(deadline);
  wait.kind.store(kind);
  while (look(wait)) wait.woken.store(0);  // the clock may have meant an earlier wait
  wait.woken.store(2);
  wait.kind.store(WaitKind::kNone);
}

/// How much later than it asks this thread wakes up from an absolute time [ns].
std::int64_t delay_of_this_thread(const ClockPage& page) noexcept {
  const std::int64_t delay = page.loop_delay.load();
  if (delay == 0) return 0;
  std::array<char, 16> name{};
  ::prctl(PR_GET_NAME, name.data());
  return std::strcmp(name.data(), kLoop) == 0 ? delay : 0;
}

/// @returns 0, or EINTR where a signal's handler ran
int sleep_until(ClockPage& page, std::int64_t deadline) noexcept {
  int result = 0;
  wait_until(page, WaitKind::kSleep, deadline, [&](ClockWait& wait) {
    if (page.now.load() >= deadline) return false;
    if (futex(&wait.woken, FUTEX_WAIT, 0) != 0 && errno == EINTR) {
      result = EINTR;
      return false;
    }
    return true;
  });
  return result;
}

/// Of a signal mask, as the kernel counts it. As wide as the kernel reads it: the last of six arguments
/// stands on the stack, and the upper half of an int's place there holds anything.
constexpr std::size_t kMaskBytes = _NSIG / 8;

/// The thread's signal mask without the signal that ends a poll.
sigset_t mask_for_waiting(const sigset_t* given) noexcept {
  sigset_t mask;
  if (given != nullptr)
    mask = *given;
  else
    pthread_sigmask(SIG_SETMASK, nullptr, &mask);
  sigdelset(&mask, wake_signal());
  return mask;
}

bool has_terminal(const pollfd* descriptors, nfds_t count) noexcept {
  const int error = errno;
  const bool has = std::any_of(descriptors, descriptors + count,
                               [](const pollfd& one) { return one.fd >= 0 && ::isatty(one.fd) == 1; });
  errno = error;
  return has;
}

sigset_t only_wake_signal() noexcept {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, wake_signal());
  return set;
}

/// How often the clock has signalled this thread. Atomic: ThreadSanitizer runs handlers at atomic operations.
thread_local std::atomic<unsigned> signals{0};
void note_signal(int) { signals.fetch_add(1); }

/// `call(mask, over)` waits for descriptors with that mask, not at all once the time is over.
template <class Call>
int poll_until(ClockPage& page, std::int64_t deadline, const sigset_t* given, bool terminal,
               Call call) noexcept {
  const sigset_t mask = mask_for_waiting(given);
  int result = 0;
  int error = 0;
  const auto look = [&](ClockWait&) {
    const unsigned before = signals.load();
    result = call(mask, page.now.load() >= deadline);
    error = errno;
    return result < 0 && error == EINTR &&
           signals.load() != before;  // the clock's signal, perhaps left pending by an earlier wait
  };
  wait_until(page, WaitKind::kPoll, deadline, look, terminal);
  errno = error;
  return result;
}

void block_wake_signal() noexcept {
  struct sigaction action{};
  action.sa_handler = note_signal;
  sigaction(wake_signal(), &action, nullptr);
  const sigset_t set = only_wake_signal();
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
}

void before_fork() {
  if (ClockPage* page = held.load()) page->forking.fetch_add(1);
}
void after_fork_in_child() {
  own_place.wait = nullptr;
  if (ClockPage* page = held.load()) {
    enter_process(*page, ::getpid());
    page->forking.fetch_sub(1);
  }
}

/// A program that was started with a clock's file.
[[gnu::constructor]] void attach_to_named_page() {
  const char* file = std::getenv(kClockVariable);
  if (file == nullptr || *file == '\0') return;
  const int descriptor = ::open(file, O_RDWR | O_CLOEXEC);
  void* memory = descriptor < 0
                     ? MAP_FAILED
                     : ::mmap(nullptr, sizeof(ClockPage), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, 0);
  if (memory == MAP_FAILED) {
    std::perror("held clock: its file");
    std::abort();
  }
  ::close(descriptor);
  ask_for_the_processor(1);
  hold(static_cast<ClockPage*>(memory));
}

}  // namespace

void hold(ClockPage* page) noexcept {
  if (page == nullptr) return held.store(nullptr);
  block_wake_signal();
  pthread_atfork(before_fork, nullptr, after_fork_in_child);
  enter_process(*page, ::getpid());
  held.store(page);
}

}  // namespace phalanx::test

// ---- the C library's names ----

using phalanx::test::ClockPage;
using phalanx::test::ClockWait;
using phalanx::test::WaitKind;

extern "C" {

int clock_gettime(clockid_t id, timespec* t) noexcept {
  ClockPage* page = phalanx::test::held.load(std::memory_order_acquire);
  if (page == nullptr || id != CLOCK_MONOTONIC) return static_cast<int>(::syscall(SYS_clock_gettime, id, t));
  if (phalanx::test::looks_too_often(*page)) phalanx::test::spend(*page, phalanx::test::kSpin);
  *t = phalanx::test::to_timespec(page->now.load());
  return 0;
}

int clock_nanosleep(clockid_t id, int flags, const timespec* t, timespec* left) {
  ClockPage* page = phalanx::test::held.load();
  if (page == nullptr || id != CLOCK_MONOTONIC) {
    if (::syscall(SYS_clock_nanosleep, id, flags, t, left) == 0) return 0;
    return errno;
  }
  const std::int64_t deadline =
      phalanx::test::of(*t) +
      ((flags & TIMER_ABSTIME) != 0 ? phalanx::test::delay_of_this_thread(*page) : page->now.load());
  const int result = phalanx::test::sleep_until(*page, deadline);
  if (result != 0 && left != nullptr && (flags & TIMER_ABSTIME) == 0)
    *left = phalanx::test::to_timespec(std::max<std::int64_t>(0, deadline - page->now.load()));
  return result;
}

int nanosleep(const timespec* t, timespec* left) {
  if (phalanx::test::held.load() == nullptr) return static_cast<int>(::syscall(SYS_nanosleep, t, left));
  const int result = clock_nanosleep(CLOCK_MONOTONIC, 0, t, left);
  if (result == 0) return 0;
  errno = result;
  return -1;
}

int usleep(useconds_t us) {
  const timespec t = phalanx::test::to_timespec(1000LL * us);
  return nanosleep(&t, nullptr);
}

int sched_yield() noexcept {
  ClockPage* page = phalanx::test::held.load();
  if (page != nullptr && phalanx::test::looks_too_often(*page))
    return phalanx::test::sleep_until(*page, page->now.load() + phalanx::test::kYield), 0;
  return static_cast<int>(::syscall(SYS_sched_yield));
}

int ppoll(pollfd* descriptors, nfds_t count, const timespec* timeout, const sigset_t* mask) {
  const auto now = [&](const timespec* t, const sigset_t* m) {
    timespec copy = t != nullptr ? *t : timespec{};
    return static_cast<int>(::syscall(SYS_ppoll, descriptors, count, t != nullptr ? &copy : nullptr, m,
                                      phalanx::test::kMaskBytes));
  };
  ClockPage* page = phalanx::test::held.load();
  const bool at_once = timeout != nullptr && phalanx::test::of(*timeout) == 0;
  if (page == nullptr || at_once) return now(timeout, mask);
  const bool terminal = phalanx::test::has_terminal(descriptors, count);
  if (timeout == nullptr && !terminal) return now(nullptr, mask);
  const timespec zero{};
  return phalanx::test::poll_until(
      *page, timeout == nullptr ? phalanx::test::kNever : page->now.load() + phalanx::test::of(*timeout),
      mask, terminal, [&](const sigset_t& m, bool over) { return now(over ? &zero : nullptr, &m); });
}

int poll(pollfd* descriptors, nfds_t count, int milliseconds) {
  if (milliseconds < 0) return ppoll(descriptors, count, nullptr, nullptr);
  const timespec t = phalanx::test::to_timespec(1'000'000LL * milliseconds);
  return ppoll(descriptors, count, &t, nullptr);
}

int epoll_pwait(int epoll, epoll_event* events, int count, int milliseconds, const sigset_t* mask) {
  const auto now = [&](int ms, const sigset_t* m) {
    return static_cast<int>(
        ::syscall(SYS_epoll_pwait, epoll, events, count, ms, m, phalanx::test::kMaskBytes));
  };
  ClockPage* page = phalanx::test::held.load();
  if (page == nullptr || milliseconds <= 0) return now(milliseconds, mask);
  return phalanx::test::poll_until(*page, page->now.load() + 1'000'000LL * milliseconds, mask, false,
                                   [&](const sigset_t& m, bool over) { return now(over ? 0 : -1, &m); });
}

int epoll_wait(int epoll, epoll_event* events, int count, int milliseconds) {
  return epoll_pwait(epoll, events, count, milliseconds, nullptr);
}

/// Asio waits in epoll_wait() where there are no such timers.
int timerfd_create(clockid_t id, int flags) noexcept {
  if (phalanx::test::held.load() == nullptr)
    return static_cast<int>(::syscall(SYS_timerfd_create, id, flags));
  errno = EINVAL;
  return -1;
}

/// Under a held clock a thread that waits for its turn delays no deadline, but the test. It keeps its policy.
int pthread_setschedparam(pthread_t thread, int policy, const sched_param* parameters) noexcept {
  static const auto in_c_library =
      reinterpret_cast<decltype(&pthread_setschedparam)>(::dlsym(RTLD_NEXT, "pthread_setschedparam"));
  if (phalanx::test::held.load() != nullptr && policy == SCHED_OTHER) return 0;
  return in_c_library(thread, policy, parameters);
}

int pthread_cond_clockwait(pthread_cond_t* condition, pthread_mutex_t* mutex, clockid_t id,
                           const timespec* until) {
  ClockPage* page = phalanx::test::held.load();
  const std::int64_t deadline = phalanx::test::of(*until);
  int result = ETIMEDOUT;
  const auto nap = [&](timespec real) {
    real.tv_nsec += phalanx::test::kNap;
    if (real.tv_nsec >= phalanx::test::kSecond) ++real.tv_sec, real.tv_nsec -= phalanx::test::kSecond;
    return pthread_cond_timedwait(condition, mutex, &real);
  };
  const auto look = [&](std::int64_t time) {
    if (time >= deadline) return false;
    timespec real{};
    ::syscall(SYS_clock_gettime, CLOCK_REALTIME, &real);
    result = nap(real);
    return result == ETIMEDOUT;
  };
  if (page != nullptr && id == CLOCK_MONOTONIC) {
    phalanx::test::wait_until(*page, WaitKind::kNap, deadline,
                              [&](ClockWait&) { return look(page->now.load()); });
    return result;
  }
  timespec now{};
  do ::syscall(SYS_clock_gettime, id, &now);
  while (look(phalanx::test::of(now)));
  return result;
}

}  // extern "C"
