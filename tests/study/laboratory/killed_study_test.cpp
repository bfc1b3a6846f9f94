// SPDX-License-Identifier: Apache-2.0
// A study whose process is killed again and again loses no finished point and measures none twice.
#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>

#include <algorithm>
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

/// The study of slow_study.cpp in a process of its own.
class SlowStudy {
 public:
  explicit SlowStudy(const std::filesystem::path& out) {
    std::string program = PHALANX_SLOW_STUDY, folder = out.string(), pause = "1000";
    char* arguments[] = {program.data(), folder.data(), pause.data(), nullptr};
    started_ = ::posix_spawn(&process_, program.c_str(), nullptr, nullptr, arguments, environ) == 0;
  }
  [[nodiscard]] bool started() const { return started_; }
  /// Kills it, unless it has ended. @returns whether it had ended by itself, well.
  bool kill_and_wait() const {
    ::kill(process_, SIGKILL);
    int status = 0;
    ::waitpid(process_, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) || WEXITSTATUS(status) == 0) << "failed by itself";
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
  }

 private:
  pid_t process_ = 0;
  bool started_ = false;
};

/// Complete lines only.
std::string complete_lines(const std::string& text) { return text.substr(0, text.rfind('\n') + 1); }

TEST(KilledStudy, LosesAndRepeatsNoFinishedPoint) {
  constexpr unsigned kSeed = 20260502;
  SCOPED_TRACE(::testing::Message() << "seed " << kSeed);
  std::mt19937 random(kSeed);
  const TemporaryFolder folder;
  const auto journal = folder / "points.jsonl";
  int kills = 0;
  for (int round = 0;; ++round) {
    ASSERT_LT(round, 200) << "no progress";
    const std::string before = complete_lines(read_file(journal));
    const SlowStudy study(folder.path());
    ASSERT_TRUE(study.started());
    // Later rounds get more time, so that there is an end on the slowest machine.
    std::this_thread::sleep_for(
        std::chrono::milliseconds(random() % (100U + 20U * static_cast<unsigned>(round))));
    const bool finished = study.kill_and_wait();
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

  const TemporaryFolder undisturbed;
  const Study study = testing::study_of(testing::kTwelvePoints);
  const auto results = run_study(study, testing::no_inputs, testing::synthetic_trial, undisturbed.path(),
                                 testing::options_for(2));
  EXPECT_EQ(read_file(folder / "study.csv"), study_csv(study, results));
}

}  // namespace
}  // namespace phalanx
