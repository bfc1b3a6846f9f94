// SPDX-License-Identifier: Apache-2.0
#include "support/held_clock/held_clock.h"

#include <dirent.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace phalanx::test {
namespace {

constexpr double kShortestNap = 10e-6;  ///< real time between two looks at the threads [s]
constexpr double kLongestNap = 500e-6;
constexpr double kLongestPacedNap = 5e-3;  ///< real time for which a paced clock that is ahead sleeps [s]
constexpr std::int64_t kLongStep = 1'000'000'000;  ///< [ns]; before it the threads are looked at once more
constexpr double kLookAgain = 2e-3;                ///< real time until then [s]
constexpr unsigned kLooksBetween = 16;             ///< looks at the threads for one at the end of a process
constexpr double kHang = 120.0;                    ///< real seconds for which a thread may run without a wait

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

/// The threads of all processes under the clock, as /proc tells of them. Its files stay open: they are read
/// thousands of times.
struct HeldClock::Threads {
  class File {
   public:
    explicit File(const std::string& path) : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
    File(File&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    File& operator=(File&&) = delete;
    ~File() {
      if (descriptor_ >= 0) ::close(descriptor_);
    }
    /// @returns the text, ended by a zero; empty if what it tells of has ended
    template <std::size_t kSize>
    const char* read(std::array<char, kSize>& text) const noexcept {
      const ssize_t size = ::pread(descriptor_, text.data(), kSize - 1, 0);
      text[size > 0 ? static_cast<std::size_t>(size) : 0] = '\0';
      return text.data();
    }
    /// Of a folder that lists threads: how many there are; 0 if it is gone.
    [[nodiscard]] std::size_t entries() const noexcept {
      struct stat folder{};
      return ::fstat(descriptor_, &folder) == 0 && folder.st_nlink > 2 ? folder.st_nlink - 2 : 0;
    }

   private:
    int descriptor_ = -1;
  };

  struct Process {
    File folder;
    std::size_t threads = 0;  ///< that are listed
  };

  struct Thread {
    static constexpr unsigned long kNoTurns = ~0UL;

    Thread(const std::string& folder, std::int32_t id)
        : tid(id), stat(folder + "/stat"), schedstat(folder + "/schedstat"), call(folder + "/syscall") {}

    /// 'S' sleeping, 'R' running or ready, 'T' stopped, 'Z' a process that nobody has waited for; 0: it has
    /// ended
    [[nodiscard]] char state() const noexcept {
      std::array<char, 128> text{};
      const char* field = std::strrchr(stat.read(text), ')');  // the name before it may hold anything
      return field != nullptr && field[1] == ' ' ? field[2] : '\0';
    }
    /// How often it has been given a processor.
    [[nodiscard]] unsigned long turns() const noexcept {
      std::array<char, 96> text{};
      const char* last = std::strrchr(schedstat.read(text), ' ');
      return last != nullptr ? std::strtoul(last, nullptr, 10) : 0;
    }
    /// It is not on a processor and does not wait for one. The state is 'S' before a thread has found that it
    /// must sleep (waitpid() reaps a child in this state), and stays so if it is preempted there: state() and
    /// turns() do not tell that it will run on. Where this file must not be read, true.
    [[nodiscard]] bool is_off_processors() const noexcept {
      std::array<char, 16> text{};
      return std::strncmp(call.read(text), "running", 7) != 0;
    }
    /// It has entered its sleep and has not been woken: the kernel need not be asked.
    [[nodiscard]] bool sleeps_for_time(ClockPage& page) noexcept {
      if (wait == nullptr || wait->tid.load() != tid) {
        wait = nullptr;
        for (ClockWait& place : page.wait)
          if (place.tid.load() == tid) wait = &place;
      }
      return wait != nullptr && wait->kind.load() == WaitKind::kSleep && wait->woken.load() == 0;
    }

    std::int32_t tid;
    File stat;
    File schedstat;
    File call;
    ClockWait* wait = nullptr;  ///< its place on the page; nullptr: none known
    unsigned long seen = 0;     ///< turns() at the first look
    /// turns() when it was last found off the processors and not ready. While they are the same it has not run, and is
    /// off them still: is_off_processors(), the slowest of these files, need not be read.
    unsigned long asleep = kNoTurns;
  };

  static bool works(char state) noexcept { return state == 'R' || state == 'D'; }

  std::vector<Process> processes;
  std::vector<Thread> all;
  std::uint32_t changes = 0;
  std::vector<std::int32_t> watched;  ///< of this process
  std::vector<std::int32_t> ignored;
  std::size_t busy = 0;  ///< of all: the one that was at work at the last look, which is looked at first

  void read(ClockPage& page) {
    all.clear();
    processes.clear();
    for (auto& place : page.process) {
      const std::int32_t pid = place.load();
      if (pid != 0 && !read_process(pid)) place.store(0);
    }
    for (const std::int32_t tid : watched) all.emplace_back("/proc/self/task/" + std::to_string(tid), tid);
    for (ClockWait& wait : page.wait) {
      const std::int32_t tid = wait.tid.load();
      // A place that is just being taken has no process yet; kill(0, 0) succeeds.
      if (tid == 0 || knows(tid) || ::kill(wait.pid.load(), 0) == 0 || errno != ESRCH) continue;
      wait.give_back();  // its process has ended
    }
  }
  /// @returns false: it is gone
  bool read_process(std::int32_t pid) {
    const std::string folder = "/proc/" + std::to_string(pid) + "/task";
    DIR* directory = ::opendir(folder.c_str());
    if (directory == nullptr) return false;
    Process& process = processes.emplace_back(Process{.folder = File(folder), .threads = 0});
    while (const dirent* entry = ::readdir(directory)) {
      const std::int32_t tid = std::atoi(entry->d_name);
      if (tid <= 0) continue;
      ++process.threads;
      const std::string path = folder + "/" + entry->d_name;
      if (std::ranges::find(ignored, tid) == ignored.end()) all.emplace_back(path, tid);
    }
    ::closedir(directory);
    return true;
  }
  [[nodiscard]] bool knows(std::int32_t tid) const {
    return std::ranges::any_of(all, [&](const Thread& thread) { return thread.tid == tid; });
  }
  /// A thread that has ended, or of a process that is stopped: it does not end its wait.
  [[nodiscard]] bool does_not_wake(std::int32_t tid) const {
    const auto thread = std::ranges::find_if(all, [&](const Thread& one) { return one.tid == tid; });
    if (thread == all.end()) return true;
    const char state = thread->state();
    return state == 'T' || state == 'Z' || state == 'X' || state == 0;
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

void HeldClock::delay_loop(double seconds) noexcept {
  page_->loop_delay.store(static_cast<std::int64_t>(1e9 * seconds));
}

/// Looks twice. A thread that is off the processors after its turns are counted, and at the second look is
/// not ready and has had no other turn, was asleep when the first look ended; so all were at that moment.
bool HeldClock::all_sleep() {
  if (page_->forking.load() > 0) return false;
  std::vector<Threads::Thread>& all = threads_->all;
  std::size_t& busy = threads_->busy;
  if (busy < all.size() && Threads::works(all[busy].state())) return false;
  for (int look = 0; look < 2; ++look) {
    for (std::size_t i = 0; i < all.size(); ++i) {
      Threads::Thread& thread = all[i];
      if (thread.sleeps_for_time(*page_)) continue;
      const unsigned long before = look == 0 ? thread.turns() : 0;
      if (look == 0 && before != 0 &&
          before == thread.asleep) {  // it has not run since: the second look asks if it is ready
        thread.seen = before;
        continue;
      }
      const bool runs = look == 0 && !thread.is_off_processors();
      const char state = thread.state();
      const unsigned long turns = look == 0 ? before : thread.turns();  // the last word of the second look
      if (state == 0 || state == 'X') {  // it has ended, and another may have taken its place
        page_->changes.fetch_add(1);
        return false;
      }
      if (runs || Threads::works(state) || (look == 1 && turns != thread.seen)) {
        busy = i;
        return false;
      }
      thread.seen = turns;
      thread.asleep = look == 0 ? Threads::Thread::kNoTurns : turns;
    }
    for (const Threads::Process& process : threads_->processes) {
      if (process.folder.entries() == process.threads) continue;
      page_->changes.fetch_add(1);  // threads or processes have come or gone
      return false;
    }
  }
  return threads_->changes == page_->changes.load();
}

/// The kernel delivers a terminal's bytes in a thread of its own, which a busy computer delays; a poll() that
/// begins waits for that thread. Once after each new wait, threads that poll a terminal begin again.
/// @returns true if there is one
bool HeldClock::look_at_terminals() {
  const std::uint32_t waits = page_->waits.load();
  if (std::exchange(waits_seen_, waits) == waits) return false;
  bool sent = false;
  for (const ClockWait& wait : page_->wait)
    if (wait.kind.load() == WaitKind::kPoll && wait.terminal.load() &&
        !threads_->does_not_wake(wait.tid.load()))
      sent |= ::syscall(SYS_tgkill, wait.pid.load(), wait.tid.load(), wake_signal()) == 0;
  return sent;
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
  if (!all_sleep() || look_at_terminals()) {
    looked_again_ = false;
    return std::nullopt;
  }
  std::vector<const ClockWait*> left_out;  // of threads that do not wake
  for (;;) {
    const ClockWait* first = nullptr;
    std::int64_t next = kNever;
    for (const ClockWait& wait : page_->wait) {
      const std::int64_t deadline = wait.deadline.load();
      if (wait.kind.load() == WaitKind::kNone || deadline >= next ||
          std::ranges::find(left_out, &wait) != left_out.end())
        continue;
      first = &wait;
      next = deadline;
    }
    if (first == nullptr) return kNever;
    if (threads_->does_not_wake(first->tid.load())) {
      left_out.push_back(first);
      continue;
    }
    if (next <= now) return std::nullopt;  // it is waking up
    return next;
  }
}

/// A step of more than a second mostly ends at a limit against hangs, which would be a false one if a thread
/// had been missed: one whose processor may not be asked about (is_off_processors()), or that the kernel has
/// something to deliver to. All threads are looked at again, a moment later.
/// @returns whether that is still to be done
bool HeldClock::look_again_before(std::int64_t t) {
  if (t - page_->now.load() <= kLongStep || std::exchange(looked_again_, true)) return false;
  real_sleep(kLookAgain);
  return true;
}

void HeldClock::move_to(std::int64_t t) {
  std::int64_t now = page_->now.load();
  while (now < t && !page_->now.compare_exchange_weak(now, t)) {
  }
  looked_again_ = false;
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
    if (next && !look_again_before(std::min(*next, until))) {
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

void HeldClock::run(const std::function<bool()>& ended, const std::function<double()>& pace_now) {
  ::prctl(PR_SET_TIMERSLACK, 1);
  ask_for_the_processor(2);
  double nap = kShortestNap;
  double moved = real_seconds();
  double pace = 0.0;
  for (unsigned look = 0; look % kLooksBetween != 0 || !ended(); ++look) {
    const double wanted = pace_now ? pace_now() : 0.0;
    if (std::exchange(pace, wanted) != wanted) moved = real_seconds();
    const std::optional<std::int64_t> next = next_wait();
    std::int64_t until = kNever;
    if (pace > 0.0)
      until = page_->now.load() + static_cast<std::int64_t>(1e9 * pace * (real_seconds() - moved));
    if (next && *next != kNever && *next <= until && !look_again_before(*next)) {
      move_to(*next);
      moved = real_seconds();  // what a busy computer has made late is not made up for
      nap = kShortestNap;
    } else {
      // All threads sleep until the pace reaches the next wait: there is nothing to look at before.
      const double early = next && *next > until ? 1e-9 * static_cast<double>(*next - until) / pace : 0.0;
      real_sleep(std::clamp(early, nap, kLongestPacedNap));
      nap = std::min(2.0 * nap, kLongestNap);
    }
  }
}

}  // namespace phalanx::test
