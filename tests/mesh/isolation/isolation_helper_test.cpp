// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/isolation/isolation_helper.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <stdexcept>
#include <string>

#include "phalanx/mesh/import.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx::mesh {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string backwards(const std::string& input) { return {input.rbegin(), input.rend()}; }
std::string parent_of(const std::string&) { return std::to_string(::getppid()); }
/// 0: there is no such process.
pid_t parent_of_process(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/status");
  pid_t parent = 0;
  for (std::string word; file >> word;)
    if (word == "PPid:" && file >> parent) return parent;
  return 0;
}
/// Of the processes that live now.
int children_of(pid_t parent) {
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string name = entry.path().filename().string();
    if (std::isdigit(static_cast<unsigned char>(name[0])) == 0) continue;
    if (parent_of_process(std::stoi(name)) == parent) ++count;
  }
  return count;
}
/// The parent of the process that forked this one: the helper, if there is one.
std::string parent_of_forker(const std::string&) { return std::to_string(parent_of_process(::getppid())); }
std::string refused(const std::string& input) { throw std::invalid_argument(input); }
std::string crashed(const std::string&) { std::abort(); }
std::string endless(const std::string&) {
  for (std::atomic<unsigned> i = 0;; ++i) {
  }
}
TriangleMesh torus(const std::string& triangles) { return make_torus(0.1, 0.03, std::stoi(triangles)); }

/// The process that forked for it.
std::string forker() { return run_isolated_work(parent_of, "", "cup.obj", {}); }

std::string helper_refusal(IsolatedWork work, const std::string& input) {
  try {
    (void)run_isolated_work(work, input, "cup.obj", {.cpu_seconds = 1, .wall_seconds = 300.0});
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

TEST(IsolationHelper, ForksInThisProcessesPlaceWhileItLives) {
  const std::string self = std::to_string(::getpid());
  EXPECT_FALSE(has_isolation_helper());
  EXPECT_EQ(forker(), self);
  {
    const IsolationHelper helper;
    EXPECT_TRUE(has_isolation_helper());
    EXPECT_NE(forker(), self);
    EXPECT_NE(forker(), self);
  }
  EXPECT_FALSE(has_isolation_helper());
  EXPECT_EQ(forker(), self);
}

// Ctrl-C at a terminal reaches the helper as well as the program, which alone decides what it means.
TEST(IsolationHelper, GoesOnAfterCtrlC) {
  const IsolationHelper helper;
  const auto pid_of_helper = [] { return std::stoi(run_isolated_work(parent_of_forker, "", "cup.obj", {})); };
  const pid_t pid = pid_of_helper();
  ASSERT_GT(pid, 1);
  ASSERT_NE(pid, ::getppid());
  ASSERT_EQ(::kill(pid, SIGINT), 0);
  EXPECT_EQ(pid_of_helper(), pid);
}

TEST(IsolationHelper, EndsWithoutAWord) {
  ::testing::internal::CaptureStderr();
  {
    const IsolationHelper helper;
    EXPECT_EQ(run_isolated_work(backwards, "abc", "cup.obj", {}), "cba");
  }
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

// An errno of EINTR that an earlier call left does not make it wait for the helper twice.
TEST(IsolationHelper, EndsOnceWhateverTheErrorOfBefore) {
  {
    const IsolationHelper helper;
    errno = EINTR;
  }
  EXPECT_FALSE(has_isolation_helper());
}

// Without a standard input the job that reaches the helper has number 0.
TEST(IsolationHelper, WorksForAProgramWithoutAStandardInput) {
  const int kept = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 100);
  ::close(STDIN_FILENO);
  {
    const IsolationHelper helper;
    EXPECT_NE(forker(), std::to_string(::getpid()));
  }
  if (kept < 0) return;
  ::dup2(kept, STDIN_FILENO);
  ::close(kept);
}

TEST(IsolationHelper, HandsBytesAndMeshesThroughBitByBit) {
  const IsolationHelper helper;
  std::string text(300'000, 'x');  // more than a socket holds
  text[7] = '\0';
  EXPECT_EQ(run_isolated_work(backwards, text, "cup.obj", {}), backwards(text));
  EXPECT_EQ(run_isolated_work(backwards, "", "cup.obj", {}), "");
  const TriangleMesh made = torus("50000");
  const TriangleMesh got = run_isolated_mesh(torus, "50000", "torus", {});
  EXPECT_EQ(got.vertices, made.vertices);
  EXPECT_EQ(got.triangles, made.triangles);
}

TEST(IsolationHelper, TellsHowItWentInTheSameWords) {
  const IsolationHelper helper;
  EXPECT_EQ(helper_refusal(refused, "cup.obj: too pretty"), "cup.obj: too pretty");
  EXPECT_THAT(helper_refusal(crashed, ""), AllOf(StartsWith("cup.obj: "), HasSubstr("crashed")));
  EXPECT_THAT(helper_refusal(endless, ""), AllOf(StartsWith("cup.obj: "), HasSubstr("not done after 1 s")));
  EXPECT_EQ(run_isolated_work(backwards, "abc", "cup.obj", {}), "cba") << "it has outlived all that";
}

TEST(IsolationHelper, ServesSeveralAtOnce) {
  const IsolationHelper helper;
  auto slow = std::async(std::launch::async, [] { return helper_refusal(endless, ""); });
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(run_isolated_work(backwards, std::to_string(100 + i), "cup.obj", {}),
              backwards(std::to_string(100 + i)));
  EXPECT_THAT(slow.get(), HasSubstr("not done"));
}

TEST(IsolationHelper, ImportsTheSameMesh) {
  const std::string obj = "v 0 0 0\nv 60 0 0\nv 0 60 0\nv 0 0 60\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
  const auto import_it = [&] {
    return import_and_check_from_memory(obj.data(), obj.size(), "obj", {.size = 0.06}).mesh;
  };
  const TriangleMesh direct = import_it();
  const IsolationHelper helper;
  const TriangleMesh helped = import_it();
  EXPECT_EQ(helped.vertices, direct.vertices);
  EXPECT_EQ(helped.triangles, direct.triangles);
  EXPECT_THROW((void)import_and_check_from_memory("nonsense", 8, "obj"), std::invalid_argument);
}

/// Asks until the helper answers: one that is killed may take a job with it.
std::string answer_of_next_helper(IsolatedWork work) {
  for (int i = 0; i < 1000; ++i) {
    try {
      return run_isolated_work(work, "", "cup.obj", {});
    } catch (const std::invalid_argument& refused) {
      EXPECT_THAT(refused.what(), AllOf(StartsWith("cup.obj: "), HasSubstr("was ended from outside")));
      ::usleep(10'000);
    }
  }
  return "none";
}

/// Standard error is a pipe, as long as it lives.
class PipedErrors {
 public:
  PipedErrors() : kept_(::fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 100)) {
    if (::pipe2(ends_.data(), O_CLOEXEC) == 0) ::dup2(ends_[1], STDERR_FILENO);
  }
  ~PipedErrors() {
    ::dup2(kept_, STDERR_FILENO);
    for (const int end : {kept_, ends_[0], ends_[1]}) ::close(end);
  }
  PipedErrors(const PipedErrors&) = delete;
  PipedErrors& operator=(const PipedErrors&) = delete;

  /// From here on it takes nothing.
  void fill() {
    const int flags = ::fcntl(ends_[1], F_GETFL);
    ::fcntl(ends_[1], F_SETFL, flags | O_NONBLOCK);
    const std::string block(4096, 'x');
    while (::write(ends_[1], block.data(), block.size()) > 0) {
    }
    ::fcntl(ends_[1], F_SETFL, flags);
  }
  /// Waits until a line has come.
  std::string line() {
    std::string text;
    for (char c = 0; c != '\n' && ::read(ends_[0], &c, 1) == 1;) text += c;
    return text;
  }

 private:
  int kept_;
  std::array<int, 2> ends_{-1, -1};
};

// Killed from outside, as by a system that is out of memory: another one takes its place, not this program.
TEST(IsolationHelper, IsReplacedOnceItIsKilled) {
  PipedErrors errors;
  const IsolationHelper helper;
  const std::string self = std::to_string(::getpid());
  for (int i = 0; i < 2; ++i) {
    const pid_t killed = std::stoi(answer_of_next_helper(parent_of_forker));
    ASSERT_EQ(::kill(killed, SIGKILL), 0);
    const std::string next = answer_of_next_helper(parent_of_forker);
    EXPECT_NE(next, self);
    EXPECT_NE(next, std::to_string(::getppid())) << "this process has forked";
    EXPECT_NE(next, std::to_string(killed));
    EXPECT_EQ(::kill(killed, 0), -1) << "it stays as a zombie";
    EXPECT_EQ(run_isolated_work(backwards, "abc", "cup.obj", {}), "cba");
    EXPECT_THAT(errors.line(), HasSubstr("was ended (signal 9); another one takes"));
  }
}

// A terminal after Ctrl-S, or a pipe that is not read.
TEST(IsolationHelper, IsReplacedWhileStandardErrorTakesNothing) {
  PipedErrors errors;
  const IsolationHelper helper;
  errors.fill();
  pid_t supervisor = 0;
  for (int i = 0; i < 3; ++i) {
    const pid_t killed = std::stoi(answer_of_next_helper(parent_of_forker));
    supervisor = parent_of_process(killed);
    ASSERT_EQ(::kill(killed, SIGKILL), 0);
  }
  EXPECT_NE(answer_of_next_helper(parent_of_forker), "none");
  EXPECT_LE(children_of(supervisor), 2) << "more than the helper and one process that waits to write";
}

// Its table of files is full, so that a job comes without its connection: that job is refused, no more.
TEST(IsolationHelper, GoesOnAfterAJobThatItCouldNotReceive) {
  const IsolationHelper helper;
  const std::string pid = run_isolated_work(parent_of_forker, "", "cup.obj", {});
  rlimit before{};
  ASSERT_EQ(::prlimit(std::stoi(pid), RLIMIT_NOFILE, nullptr, &before), 0);
  const rlimit full{.rlim_cur = 3, .rlim_max = before.rlim_max};
  ASSERT_EQ(::prlimit(std::stoi(pid), RLIMIT_NOFILE, &full, nullptr), 0);
  EXPECT_THAT(helper_refusal(backwards, "abc"), HasSubstr("try again"));
  ASSERT_EQ(::prlimit(std::stoi(pid), RLIMIT_NOFILE, &before, nullptr), 0);
  EXPECT_EQ(run_isolated_work(parent_of_forker, "", "cup.obj", {}), pid);
}

// More input than a socket holds, for a helper that stands still.
TEST(IsolationHelper, RefusesWorkThatCannotBeHandedOver) {
  const IsolationHelper helper;
  const pid_t pid = std::stoi(run_isolated_work(parent_of_forker, "", "cup.obj", {}));
  ASSERT_EQ(::kill(pid, SIGSTOP), 0);
  const std::string input(4'000'000, 'x');
  EXPECT_THROW((void)run_isolated_work(backwards, input, "cup.obj", {.transfer_seconds = 0.05}),
               std::invalid_argument);
  ASSERT_EQ(::kill(pid, SIGCONT), 0);
  EXPECT_EQ(run_isolated_work(backwards, "abc", "cup.obj", {}), "cba");
}

TEST(IsolationHelper, WorkIsRefusedInWordsWhenItsSupervisorIsKilled) {
  const IsolationHelper helper;
  const pid_t supervisor =
      parent_of_process(std::stoi(run_isolated_work(parent_of_forker, "", "cup.obj", {})));
  ASSERT_GT(supervisor, 1);
  ASSERT_EQ(::kill(supervisor, SIGKILL), 0);
  std::string answer;
  for (int i = 0; i < 1000 && answer.find("start it again") == std::string::npos; ++i) {
    try {
      EXPECT_NE(run_isolated_work(parent_of, "", "cup.obj", {}), std::to_string(::getpid()));
    } catch (const std::invalid_argument& refused) {
      answer = refused.what();
    }
    ::usleep(10'000);
  }
  EXPECT_EQ(answer,
            "cup.obj: the processes that read meshes were ended from outside; end this program and start it "
            "again");
}

// An errno of EINTR that an earlier call left is inherited by the helper, and makes it ask for no second job
// before it has done the first.
TEST(IsolationHelper, BeginsWithItsFirstJobWhateverTheErrorOfBefore) {
  errno = EINTR;
  const IsolationHelper helper;
  EXPECT_EQ(run_isolated_work(backwards, "abc", "cup.obj", {.cpu_seconds = 1, .wall_seconds = 1.0}), "cba");
}

}  // namespace
}  // namespace phalanx::mesh
