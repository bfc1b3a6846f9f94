// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/isolation/isolated.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <new>
#include <stdexcept>
#include <string>

#include "phalanx/mesh/primitives.h"
#include "support/sanitized.h"

namespace phalanx::mesh {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string reading_refusal(const std::function<TriangleMesh()>& read) {
  try {
    (void)run_isolated(read, "cup.3ds", {.cpu_seconds = 1, .wall_seconds = 300.0});
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

TEST(RunIsolated, HandsTheMeshBackBitByBit) {
  const TriangleMesh made = make_torus(0.1, 0.03, 50'000);  // more than a pipe holds
  const TriangleMesh got = run_isolated([&] { return made; }, "torus", {});
  EXPECT_EQ(got.vertices, made.vertices);
  EXPECT_EQ(got.triangles, made.triangles);
}

TEST(RunIsolated, HandsATextBackAndEndsWorkThatLoops) {
  std::string text(200'000, 'x');  // more than a pipe holds
  text[7] = '\0';
  EXPECT_EQ(run_isolated_text([&] { return text; }, "cup.obj", {}), text);
  const auto loop = []() -> std::string {
    for (std::atomic<unsigned> i = 0;; ++i) {
    }
  };
  EXPECT_THROW((void)run_isolated_text(loop, "cup.obj", {.cpu_seconds = 1, .wall_seconds = 300.0}),
               std::invalid_argument);
}

// A serial port is locked until its last descriptor is closed: the child's would be one.
TEST(RunIsolated, HoldsNoFileOfItsParentOpen) {
  const int file = ::open("/dev/null", O_RDONLY);
  const int high = ::fcntl(file, F_DUPFD, 200);  // a number that the child has no use for
  ASSERT_GE(high, 200);
  const auto open_there = [&] { return std::string(::fcntl(high, F_GETFD) < 0 ? "none" : "some"); };
  EXPECT_EQ(open_there(), "some");
  EXPECT_EQ(run_isolated_text(open_there, "cup.obj", {}), "none");
  ::close(high);
  ::close(file);
}

TEST(RunIsolated, PassesARefusalOnWordByWord) {
  EXPECT_EQ(reading_refusal([]() -> TriangleMesh { throw std::invalid_argument("cup.3ds: too pretty"); }),
            "cup.3ds: too pretty");
}

TEST(RunIsolated, TurnsACrashIntoARefusal) {
  EXPECT_THAT(reading_refusal([]() -> TriangleMesh { std::abort(); }),
              AllOf(StartsWith("cup.3ds: "), HasSubstr("crashed")));
  EXPECT_THAT(reading_refusal([]() -> TriangleMesh {
                std::raise(SIGSEGV);
                return {};
              }),
              HasSubstr("crashed"));
  EXPECT_THAT(reading_refusal([]() -> TriangleMesh { std::_Exit(0); }), HasSubstr("crashed"));
}

TEST(RunIsolated, StopsALoop) {
  EXPECT_THAT(reading_refusal([]() -> TriangleMesh {
                for (std::atomic<unsigned> i = 0;; ++i) {
                }
              }),
              AllOf(StartsWith("cup.3ds: "), HasSubstr("not done after 1 s")));
}

// Sleeping takes no time on the processor.
TEST(RunIsolated, EndsAReaderThatSleeps) {
  try {
    (void)run_isolated(
        []() -> TriangleMesh {
          for (;;) ::pause();
        },
        "cup.3ds", {.cpu_seconds = 1, .wall_seconds = 1.0});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), AllOf(StartsWith("cup.3ds: "), HasSubstr("not done after 1 s")));
  }
}

TEST(RunIsolated, SaysWhenMemoryRunsOut) {
  EXPECT_THAT(reading_refusal([]() -> TriangleMesh { throw std::bad_alloc(); }), HasSubstr("memory"));
}

// 256 MiB where 64 MiB may be had.
TEST(RunIsolated, GivesTheWorkNoMoreMemoryThanItsLimit) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer's allocator ends the process in its own words";
  const auto greedy = [] {
    const std::string text(std::size_t{256} << 20, 'x');
    return text.substr(text.size() - 1);
  };
  try {
    (void)run_isolated_text(greedy, "cup.obj", {.memory_bytes = std::uint64_t{64} << 20});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), AllOf(StartsWith("cup.obj: "), HasSubstr("wanted more than 64 MiB")));
  }
}

// An errno of EINTR that an earlier call left causes no second try: one reader has ended, one is too slow.
TEST(RunIsolated, IsNotMisledByAnErrorOfBefore) {
  const auto end_at_once = []() -> TriangleMesh { std::_Exit(0); };
  errno = EINTR;
  EXPECT_THAT(reading_refusal(end_at_once), HasSubstr("crashed"));
  const auto too_slow = []() -> std::string {
    for (;;) ::pause();
  };
  try {
    errno = EINTR;
    (void)run_isolated_text(too_slow, "cup.obj", {.cpu_seconds = 1, .wall_seconds = 0.0});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), HasSubstr("not done after 0 s"));
  }
}

TEST(RunIsolated, ShowsNobodyWhatAReaderPrints) {
  const auto outputs = [] {
    return std::filesystem::read_symlink("/proc/self/fd/1").string() + " " +
           std::filesystem::read_symlink("/proc/self/fd/2").string();
  };
  EXPECT_EQ(run_isolated_text(outputs, "cup.obj", {}), "/dev/null /dev/null");
}

// Address space alone, without a page of memory: 1.5 GiB more than the program has can be had, 2.5 GiB not.
TEST(RunIsolated, GivesTheWorkTwoGibibytesAndThreeSecondsIfNothingElseIsAskedFor) {
  const auto mapped = [](std::size_t bytes) -> std::string {
    return ::mmap(nullptr, bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0) == MAP_FAILED
               ? "none"
               : "some";
  };
  EXPECT_EQ(run_isolated_text([&] { return mapped(std::size_t{3} << 29); }, "cup.obj", {}), "some");
  EXPECT_EQ(run_isolated_text([&] { return mapped(std::size_t{5} << 29); }, "cup.obj", {}), "none");
  const auto limits = [] {
    rlimit seconds{};
    rlimit core{};
    ::getrlimit(RLIMIT_CPU, &seconds);
    ::getrlimit(RLIMIT_CORE, &core);
    return std::to_string(seconds.rlim_cur) + " " + std::to_string(core.rlim_cur);
  };
  EXPECT_EQ(run_isolated_text(limits, "cup.obj", {}), "3 0");
}

/// Into the one pipe that a child has, which leads to its parent; then the child ends.
[[noreturn]] void say_and_end(const std::string& bytes) {
  for (int fd = STDERR_FILENO + 1; fd < 1024; ++fd) {
    struct stat status{};
    if (::fstat(fd, &status) != 0 || !S_ISFIFO(status.st_mode)) continue;
    if (::write(fd, bytes.data(), bytes.size()) < 0) std::_Exit(1);
  }
  std::_Exit(0);
}

/// The first byte says that a result follows, the next eight how many letters it has.
std::string claim_of_letters(std::uint64_t count, const std::string& letters) {
  std::string bytes(1, '\1');
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  return bytes + letters;
}

// A reader that has written over its own memory: 100 letters are announced and three come.
TEST(RunIsolated, TakesNoResultThatBreaksOff) {
  try {
    (void)run_isolated_text([]() -> std::string { say_and_end(claim_of_letters(100, "cup")); }, "cup.obj",
                            {});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), AllOf(StartsWith("cup.obj: "), HasSubstr("crashed")));
  }
}

// 2^60 letters are fewer than the limit of 2^61 and more than this process can have: that is no crash of the
// reader's.
TEST(RunIsolated, SaysThatItsOwnMemoryRanOut) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer's allocator ends the process in its own words";
  const auto claim = []() -> std::string { say_and_end(claim_of_letters(std::uint64_t{1} << 60, "cup")); };
  EXPECT_THROW((void)run_isolated_text(claim, "cup.obj", {.memory_bytes = std::uint64_t{1} << 61}),
               std::bad_alloc);
}

// The program handles a signal after 0.1 of the 0.3 s that the reader takes.
TEST(RunIsolated, WaitsOnAfterASignal) {
  static volatile std::sig_atomic_t rung = 0;
  rung = 0;
  struct sigaction now{};
  struct sigaction before{};
  now.sa_handler = [](int) { rung = 1; };
  ASSERT_EQ(::sigaction(SIGALRM, &now, &before), 0);
  itimerval soon{};
  soon.it_value.tv_usec = 100'000;
  ASSERT_EQ(::setitimer(ITIMER_REAL, &soon, nullptr), 0);
  const auto slow = [] {
    ::usleep(300'000);
    return std::string("cup");
  };
  EXPECT_EQ(run_isolated_text(slow, "cup.obj", {}), "cup");
  EXPECT_TRUE(rung == 1);
  ::sigaction(SIGALRM, &before, nullptr);
}

// Without a standard input the pipe from the reader has number 0.
TEST(RunIsolated, ClosesAPipeOfNumberNought) {
  const int kept = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 100);
  ::close(STDIN_FILENO);
  const std::string text = run_isolated_text([] { return std::string("cup"); }, "cup.obj", {});
  const bool closed = ::fcntl(STDIN_FILENO, F_GETFD) < 0;
  if (kept >= 0) {
    ::dup2(kept, STDIN_FILENO);
    ::close(kept);
  }
  EXPECT_EQ(text, "cup");
  EXPECT_TRUE(closed);
}

// 40 of 48 MiB. The 24 MiB that were prepared for the reader are part of these, not besides.
TEST(RunIsolated, LeavesAllItsMemoryToTheWork) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer's allocator has memory of its own";
  ::malloc_trim(0);  // what this process has to spare would be the reader's
  const auto large = [] {
    const std::string text(std::size_t{40} << 20, 'x');
    return text.substr(text.size() - 3);
  };
  EXPECT_EQ(run_isolated_text(large, "cup.obj", {.memory_bytes = std::uint64_t{48} << 20}), "xxx");
}

}  // namespace
}  // namespace phalanx::mesh
