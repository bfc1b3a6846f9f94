// SPDX-License-Identifier: Apache-2.0
#include "support/held_clock/held_clock.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace phalanx::test {
namespace {

constexpr std::int64_t kNever = INT64_MAX;
constexpr double kShortestNap = 10e-6;  ///< real time between two looks at the threads [s]
constexpr double kLongestNap = 500e-6;
constexpr double kHang = 120.0;  ///< real seconds for which a thread may run without a wait

double real_seconds() noexcept {
  timespec t{};
  ::syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void real_sleep(double seconds) noexcept {
  const timespec t{static_cast<time_t>(seconds),
                   static_cast<long>(1e9 * (seconds - static_cast<double>(static_cast<time_t>(seconds))))};
  ::syscall(SYS_nanosleep, &t, nullptr);
}

}  // namespace

struct HeldClock::Threads {
  /// What the kernel says of one thread. Its files stay open: they are read thousands of times.
  class ThreadFiles {
   public:
    ThreadFiles(std::int32_t process, std::int32_t thread) : pid(process), tid(thread) {
      const std::string folder = "/proc/" + std::to_string(pid) + "/task/" + std::to_string(tid);
      state_ = ::open((folder + "/stat").c_str(), O_RDONLY | O_CLOEXEC);
      turns_ = ::open((folder + "/schedstat").c_str(), O_RDONLY | O_CLOEXEC);
    }
    ThreadFiles(ThreadFiles&& other) noexcept
        : pid(other.pid),
          tid(other.tid),
          state_(std::exchange(other.state_, -1)),
          turns_(std::exchange(other.turns_, -1)) {}
    ThreadFiles(const ThreadFiles&) = delete;
    ThreadFiles& operator=(const ThreadFiles&) = delete;
    ThreadFiles& operator=(ThreadFiles&&) = delete;
    ~ThreadFiles() {
      if (state_ >= 0) ::close(state_);
      if (turns_ >= 0) ::close(turns_);
    }

    /// 'S' sleeping, 'R' running or ready, 'T' stopped, ...; 0: it has ended
    [[nodiscard]] char state() noexcept {
      char text[512];
      const ssize_t size = ::pread(state_, text, sizeof text - 1, 0);
      if (size <= 0) return 0;
      text[size] = '\0';
      const char* field = std::strrchr(text, ')');  // the name before it may hold anything
      if (field == nullptr || field[1] != ' ') return 0;
      const char state = field[2];
      for (int i = 2; i < 20 && field != nullptr; ++i) field = std::strchr(field + 1, ' ');
      siblings = field != nullptr ? std::atoi(field) : 0;
      return state;
    }
    /// How often it has been given a processor.
    [[nodiscard]] unsigned long turns() const noexcept {
      char text[96];
      const ssize_t size = ::pread(turns_, text, sizeof text - 1, 0);
      if (size <= 0) return 0;
      text[size] = '\0';
      const char* last = std::strrchr(text, ' ');
      return last != nullptr ? std::strtoul(last, nullptr, 10) : 0;
    }

    std::int32_t pid;
    std::int32_t tid;
    ClockWait* wait = nullptr;  ///< its place on the page; nullptr: none known
    unsigned long seen = 0;     ///< turns() at the first look
    int siblings = 0;           ///< threads of its process, at the last state()
    int listed = 0;             ///< that are known

   private:
    int state_ = -1;
    int turns_ = -1;
  };

  std::vector<ThreadFiles> all;
  std::uint32_t changes = 0;
  std::vector<std::int32_t> watched;  ///< of this process
  std::vector<std::int32_t> ignored;
  std::size_t busy = 0;  ///< of all: who was at work at the last look, and is looked at first

  void read(ClockPage& page) {
    all.clear();
    for (auto& place : page.process) {
      const std::int32_t pid = place.load();
      if (pid != 0 && !read_process(pid)) place.store(0);
    }
    for (const std::int32_t tid : watched) all.emplace_back(::getpid(), tid);
    for (ClockWait& wait : page.wait) {  // of what has ended
      const std::int32_t tid = wait.tid.load();
      const bool there =
          std::ranges::any_of(all, [&](const ThreadFiles& thread) { return thread.tid == tid; });
      if (tid != 0 && !there && ::kill(wait.pid.load(), 0) != 0) {
        wait.kind.store(WaitKind::kNone);
        wait.tid.store(0);
      }
    }
  }
  bool read_process(std::int32_t pid) {
    const std::string folder = "/proc/" + std::to_string(pid) + "/task";
    DIR* directory = ::opendir(folder.c_str());
    if (directory == nullptr) return false;
    const std::size_t first = all.size();
    int count = 0;
    while (const dirent* entry = ::readdir(directory)) {
      const std::int32_t tid = std::atoi(entry->d_name);
      if (tid <= 0) continue;
      ++count;
      if (std::ranges::find(ignored, tid) == ignored.end()) all.emplace_back(pid, tid);
    }
    ::closedir(directory);
    for (std::size_t i = first; i < all.size(); ++i) all[i].listed = count;
    return true;
  }
  /// It has entered its sleep and has not been woken: the kernel need not be asked.
  static bool sleeps_for_time(ThreadFiles& thread, ClockPage& page) {
    if (thread.wait == nullptr || thread.wait->tid.load() != thread.tid) {
      thread.wait = nullptr;
      for (ClockWait& wait : page.wait)
        if (wait.tid.load() == thread.tid) thread.wait = &wait;
    }
    return thread.wait != nullptr && thread.wait->kind.load() == WaitKind::kSleep &&
           thread.wait->woken.load() == 0;
  }
  [[nodiscard]] bool stopped(std::int32_t tid) {
    for (ThreadFiles& thread : all)
      if (thread.tid == tid) {
        const char state = thread.state();
        return state == 'T' || state == 'Z' || state == 'X' || state == 0;
      }
    return true;
  }
};

HeldClock::HeldClock() : HeldClock(std::string()) {}

HeldClock::HeldClock(const std::string& file) : threads_(std::make_unique<Threads>()) {
  descriptor_ = file.empty() ? ::memfd_create("held_clock", MFD_CLOEXEC)
                             : ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (descriptor_ < 0 || ::ftruncate(descriptor_, sizeof(ClockPage)) != 0)
    throw std::runtime_error("held clock: no memory for it: " + std::string(std::strerror(errno)));
  file_ = file.empty() ? "/proc/" + std::to_string(::getpid()) + "/fd/" + std::to_string(descriptor_) : file;
  void* memory = ::mmap(nullptr, sizeof(ClockPage), PROT_READ | PROT_WRITE, MAP_SHARED, descriptor_, 0);
  if (memory == MAP_FAILED) throw std::runtime_error("held clock: its memory cannot be mapped");
  page_ = static_cast<ClockPage*>(memory);  // zeros are an empty page
  std::int64_t fresh = 0;
  page_->now.compare_exchange_strong(fresh, ClockPage::kBegin);
  page_->changes.fetch_add(1);
}

HeldClock::~HeldClock() {
  // Mapped for ever: a process that holds itself has threads that may look once more.
  ::close(descriptor_);
}

std::vector<std::string> HeldClock::environment(const std::string& library) const {
  return {std::string(kClockVariable) + "=" + file_, "LD_PRELOAD=" + library};
}

double HeldClock::now() const noexcept {
  return 1e-9 * static_cast<double>(page_->now.load() - ClockPage::kBegin);
}

bool HeldClock::holds(std::int32_t pid) const noexcept {
  return std::ranges::any_of(page_->process, [&](const auto& place) { return place.load() == pid; });
}

void HeldClock::watch_thread(std::int32_t tid) {
  threads_->watched.push_back(tid);
  page_->changes.fetch_add(1);
}

void HeldClock::ignore_thread(std::int32_t tid) {
  threads_->ignored.push_back(tid);
  page_->changes.fetch_add(1);
}

/// Looks twice: a thread that was woken between the looks runs at the second, or has had another turn.
bool HeldClock::all_sleep() {
  if (page_->forking.load() > 0) return false;
  const auto works = [](char state) { return state == 'R' || state == 'D'; };
  std::size_t& busy = threads_->busy;
  if (busy < threads_->all.size() && works(threads_->all[busy].state())) return false;
  bool others = false;  // than those that are known
  for (int look = 0; look < 2; ++look) {
    for (auto& thread : threads_->all) {
      if (thread.tid != thread.pid && Threads::sleeps_for_time(thread, *page_))
        continue;  // the first one tells of new ones
      const unsigned long turns = thread.turns();
      const char state = thread.state();
      others = others || state == 0 || state == 'X' ||
               (state != 'Z' && thread.listed != 0 && thread.siblings != thread.listed);
      if (works(state) || (look == 1 && turns != thread.seen)) {
        busy = static_cast<std::size_t>(&thread - threads_->all.data());
        return false;
      }
      thread.seen = turns;
    }
  }
  if (others) page_->changes.fetch_add(1);
  return threads_->changes == page_->changes.load();
}

/// Ends the waits whose time has come.
void HeldClock::wake_due(std::int64_t now) {
  for (ClockWait& wait : page_->wait) {
    const WaitKind kind = wait.kind.load();
    if (kind == WaitKind::kNone || wait.deadline.load() > now) continue;
    std::uint32_t waiting = 0;
    if (!wait.woken.compare_exchange_strong(waiting, 1)) continue;
    if (kind == WaitKind::kSleep) futex(&wait.woken, FUTEX_WAKE, INT_MAX);
    if (kind == WaitKind::kPoll) ::syscall(SYS_tgkill, wait.pid.load(), wait.tid.load(), wake_signal());
  }
}

/// Whether all that is due has been done. @returns when the next wait ends (kNever: there is none), or
/// nothing while a thread is at work
std::optional<std::int64_t> HeldClock::next_wait() {
  const std::uint32_t changes = page_->changes.load();
  if (changes != threads_->changes) {
    threads_->read(*page_);
    threads_->changes = changes;
  }
  const std::int64_t now = page_->now.load();
  wake_due(now);
  if (!all_sleep()) return std::nullopt;
  std::int64_t next = kNever;
  for (const ClockWait& wait : page_->wait) {
    if (wait.kind.load() == WaitKind::kNone) continue;
    const std::int64_t deadline = wait.deadline.load();
    if (deadline >= next || threads_->stopped(wait.tid.load())) continue;
    if (deadline <= now) return std::nullopt;  // it is waking up
    next = deadline;
  }
  return next;
}

void HeldClock::move_to(std::int64_t t) {
  std::int64_t now = page_->now.load();
  while (now < t && !page_->now.compare_exchange_weak(now, t)) {
  }
  wake_due(t);
}

void HeldClock::advance_to(double t) {
  ::prctl(PR_SET_TIMERSLACK, 1);
  ask_for_the_processor(2);
  const std::int64_t until = ClockPage::kBegin + static_cast<std::int64_t>(1e9 * t);
  std::int64_t before = -1;
  double moved = real_seconds();
  double nap = kShortestNap;
  for (;;) {
    const std::optional<std::int64_t> next = next_wait();
    const std::int64_t now = page_->now.load();
    if (next && now >= until) return;
    if (next) {
      move_to(std::min(*next, until));
      nap = kShortestNap;
    } else {
      real_sleep(nap);
      nap = std::min(2.0 * nap, kLongestNap);
    }
    if (std::exchange(before, now) != now) moved = real_seconds();
    if (real_seconds() - moved > kHang)
      throw std::runtime_error("held clock: a thread has been running for two minutes");
  }
}

void HeldClock::run(const std::function<bool()>& ended, double pace) {
  ::prctl(PR_SET_TIMERSLACK, 1);
  ask_for_the_processor(2);
  double nap = kShortestNap;
  double moved = real_seconds();
  while (!ended()) {
    const std::optional<std::int64_t> next = next_wait();
    std::int64_t until = kNever;
    if (pace > 0.0)
      until = page_->now.load() + static_cast<std::int64_t>(1e9 * pace * (real_seconds() - moved));
    if (next && *next != kNever && *next <= until) {
      move_to(*next);
      moved = real_seconds();  // what a busy computer has made late is not made up for
      nap = kShortestNap;
    } else {
      real_sleep(nap);
      nap = std::min(2.0 * nap, kLongestNap);
    }
  }
}

}  // namespace phalanx::test
