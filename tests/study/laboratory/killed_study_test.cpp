// SPDX-License-Identifier: Apache-2.0
// A study whose process is killed again and again loses no finished point and measures none twice.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <random>
#include <set>
#include <string>
#include <thread>

#include "phalanx/study/laboratory/outputs.h"
#include "record/temporary_folder.h"
#include "study/laboratory/journal.h"
#include "study/laboratory/synthetic.h"

extern char** environ;

namespace phalanx {
namespace {

using testing::read_file;
using testing::TemporaryFolder;

/// The study of stepped_study.cpp in a process of its own.
class SteppedStudy {
 public:
  /// May begin so many trials.
  SteppedStudy(const std::filesystem::path& out, int trials) {
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) return;
    steps_ = ends[1];
    const std::string bytes(static_cast<std::size_t>(trials), '.');
    std::string program = PHALANX_STEPPED_STUDY, folder = out.string();
    char* arguments[] = {program.data(), folder.data(), nullptr};
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, ends[0], STDIN_FILENO);
    started_ = ::write(steps_, bytes.data(), bytes.size()) == static_cast<ssize_t>(bytes.size()) &&
               ::posix_spawn(&process_, program.c_str(), &files, nullptr, arguments, environ) == 0;
    posix_spawn_file_actions_destroy(&files);
    ::close(ends[0]);
  }
  SteppedStudy(const SteppedStudy&) = delete;
  SteppedStudy& operator=(const SteppedStudy&) = delete;
  ~SteppedStudy() {
    if (steps_ >= 0) ::close(steps_);
  }
  [[nodiscard]] bool started() const { return started_; }
  /// Until it has begun all the trials that it may, or has ended.
  void wait() const {
    int left = 1;
    siginfo_t ended{};
    while (::ioctl(steps_, FIONREAD, &left) == 0 && left > 0 &&
           ::waitid(P_PID, static_cast<id_t>(process_), &ended, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           ended.si_pid == 0)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  /// Kills it, unless it has ended. @returns whether it had ended by itself, well.
  [[nodiscard]] bool kill_and_wait() const {
    ::kill(process_, SIGKILL);
    int status = 0;
    ::waitpid(process_, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0) << "failed by itself";
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

 private:
  pid_t process_ = 0;
  int steps_ = -1;
  bool started_ = false;
};

/// Complete lines only.
std::string complete_lines(const std::string& text) { return text.substr(0, text.rfind('\n') + 1); }

TEST(KilledStudy, LosesAndRepeatsNoFinishedPoint) {
  const TemporaryFolder undisturbed;
  const Study study = testing::study_of(testing::kTwelvePoints);
  std::atomic<int> trials = 0;
  const auto counted = [&](const Overrides& overrides, double stiffness, double press, std::uint64_t seed) {
    ++trials;
    return testing::synthetic_trial(overrides, stiffness, press, seed);
  };
  const auto results =
      run_study(study, testing::no_inputs, counted, undisturbed.path(), testing::options_for(2));

  constexpr unsigned kSeed = 20260502;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  const TemporaryFolder folder;
  const auto journal = folder / "points.jsonl";
  int kills = 0;
  for (int round = 0;; ++round) {
    ASSERT_LT(round, 200) << "no progress";
    const std::string before = complete_lines(read_file(journal));
    // More than two of the twelve points together, so that there is progress; less than a third of all, so
    // that three kills come before the end.
    const int most = trials / 5 + static_cast<int>(random() % static_cast<unsigned>(trials / 10));
    const SteppedStudy process(folder.path(), most);
    ASSERT_TRUE(process.started());
    if (round % 2 == 0) process.wait();  // else wherever it has come to
    const bool finished = process.kill_and_wait();
    ASSERT_TRUE(read_file(journal).starts_with(before)) << "a finished point was lost";
    if (finished) break;
    ++kills;
  }
  EXPECT_GE(kills, 3);
  const std::string text = read_file(journal);
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 12) << "a point was measured twice";
  std::set<int> points;
  for (const PointResult& point : read_journal(journal).points) points.insert(point.index);
  EXPECT_EQ(points.size(), 12U);

  EXPECT_EQ(read_file(folder / "study.csv"), study_csv(study, results));
}

}  // namespace
}  // namespace phalanx
