// SPDX-License-Identifier: Apache-2.0
#include "phalanx/study/laboratory/run_study.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>

#include <atomic>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "phalanx/record/made.h"
#include "phalanx/record/output_file.h"
#include "phalanx/study/laboratory/outputs.h"
#include "record/temporary_folder.h"
#include "study/laboratory/checked_inputs.h"
#include "study/laboratory/expect_refusal.h"
#include "study/laboratory/journal.h"
#include "study/laboratory/study_json.h"
#include "study/laboratory/synthetic.h"

namespace phalanx {
namespace {

using testing::expect_refusal;
using ::testing::HasSubstr;
using testing::no_inputs;
using testing::options_for;
using testing::read_file;
using testing::study_of;
using testing::synthetic_trial;
using testing::TemporaryFolder;

const Study& twelve_points() {
  static const Study study = study_of(testing::kTwelvePoints);
  return study;
}

std::string csv_of(const std::vector<PointResult>& results) { return study_csv(twelve_points(), results); }

/// An undisturbed run.
const std::string& expected_csv() {
  static const std::string csv = [] {
    const TemporaryFolder folder;
    return csv_of(run_study(twelve_points(), no_inputs, synthetic_trial, folder.path(), options_for(1)));
  }();
  return csv;
}

// By hand: gain x (500 + 4000 friction) - 5, down to the grid of 0.1 N/mm, 4 N/mm at most.
TEST(RunStudy, FindsTheLimitOfEveryPoint) {
  const TemporaryFolder folder;
  const auto results = run_study(twelve_points(), no_inputs, synthetic_trial, folder.path(), options_for(2));
  const std::vector<double> limits = {400, 800, 1200, 1600, 900, 1700, 2500, 3300, 1400, 2600, 3800, 4000};
  ASSERT_EQ(results.size(), limits.size());
  for (std::size_t i = 0; i < limits.size(); ++i) {
    EXPECT_EQ(results[i].index, static_cast<int>(i));
    EXPECT_EQ(results[i].k_lim, limits[i]) << i;
    EXPECT_EQ(results[i].at_least, i == 11) << i;
  }
}

TEST(RunStudy, GivesTheSameForAnyNumberOfThreads) {
  for (const int jobs : {1, 2, 4, 7}) {
    const TemporaryFolder folder;
    const auto results =
        run_study(twelve_points(), no_inputs, synthetic_trial, folder.path(), options_for(jobs));
    EXPECT_EQ(csv_of(results), expected_csv()) << jobs;
  }
}

TEST(RunStudy, GoesOnWhereItStoppedAndRepeatsNothing) {
  const TemporaryFolder folder;
  std::atomic<int> calls{0};
  const auto counted = [&](const Overrides& overrides, double k, double press, std::uint64_t seed) {
    ++calls;
    return synthetic_trial(overrides, k, press, seed);
  };
  static_cast<void>(run_study(twelve_points(), no_inputs, counted, folder.path(), options_for(2)));
  const int all = calls;
  EXPECT_GT(all, 0);
  // The last two lines are lost.
  std::string text = read_file(folder / "points.jsonl");
  for (int i = 0; i < 2; ++i) text.resize(text.rfind('\n', text.size() - 2) + 1);
  write_text_file(folder / "points.jsonl", text);
  calls = 0;
  const auto resumed = run_study(twelve_points(), no_inputs, counted, folder.path(), options_for(2));
  EXPECT_EQ(csv_of(resumed), expected_csv());
  EXPECT_GT(calls, 0);
  EXPECT_LT(calls, all / 2);
  calls = 0;
  const auto again = run_study(twelve_points(), no_inputs, counted, folder.path(), options_for(2));
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(csv_of(again), expected_csv());
}

// What was written of the whole study stays while it is whole, and goes before a point is measured again.
TEST(RunStudy, RemovesTheOutputsOfAStudyThatIsNoLongerWhole) {
  const TemporaryFolder folder;
  const auto run = [&](const TrialFunction& trial) {
    return run_study(twelve_points(), no_inputs, trial, folder.path(), options_for(2));
  };
  const TrialFunction broken = [](const Overrides&, double, double, std::uint64_t) -> TrialResult {
    throw std::runtime_error("the tendon broke");
  };
  write_study_outputs(folder.path(), twelve_points(), run(synthetic_trial), {});
  static_cast<void>(run(broken));  // nothing is left to measure
  EXPECT_TRUE(std::filesystem::exists(folder / "summary.json"));
  EXPECT_TRUE(std::filesystem::exists(folder / "study.csv"));
  std::string text = read_file(folder / "points.jsonl");
  text.resize(text.rfind('\n', text.size() - 2) + 1);
  write_text_file(folder / "points.jsonl", text);
  EXPECT_THROW(static_cast<void>(run(broken)), std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(folder / "summary.json"));
  EXPECT_FALSE(std::filesystem::exists(folder / "study.csv"));
}

TEST(RunStudy, ReportsItsProgress) {
  const TemporaryFolder folder;
  StudyOptions options = options_for(2);
  std::vector<StudyProgress> seen;
  options.progress = [&](const StudyProgress& progress) { seen.push_back(progress); };
  static_cast<void>(run_study(twelve_points(), no_inputs, synthetic_trial, folder.path(), options));
  ASSERT_EQ(seen.size(), 13U);
  EXPECT_TRUE(std::isnan(seen[0].remaining_s));
  for (int i = 0; i <= 12; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)].done, i);
  EXPECT_EQ(seen.back().total, 12);
  EXPECT_EQ(seen.back().remaining_s, 0.0);
  seen.clear();
  static_cast<void>(run_study(twelve_points(), no_inputs, synthetic_trial, folder.path(), options));
  ASSERT_EQ(seen.size(), 1U);
  EXPECT_EQ(seen[0].resumed, 12);
}

// At the pace of this run: of twelve points ten are there from before, so that after the first of the two as
// much time is left as it took.
TEST(RunStudy, TellsTheTimeThatIsLeftAtThePaceOfThisRunAlone) {
  const TemporaryFolder folder;
  StudyOptions options = options_for(2);
  std::vector<StudyProgress> seen;
  options.progress = [&](const StudyProgress& progress) { seen.push_back(progress); };
  const auto expect_pace = [&](int from, int to) {
    ASSERT_EQ(seen.size(), static_cast<std::size_t>(to - from + 1));
    for (const StudyProgress& now : seen) {
      EXPECT_EQ(now.resumed, from);
      if (now.done == from) continue;
      EXPECT_DOUBLE_EQ(now.remaining_s, now.elapsed_s / (now.done - from) * (to - now.done)) << now.done;
    }
  };
  static_cast<void>(run_study(twelve_points(), no_inputs, synthetic_trial, folder.path(), options));
  expect_pace(0, 12);
  std::string text = read_file(folder / "points.jsonl");
  for (int i = 0; i < 2; ++i) text.resize(text.rfind('\n', text.size() - 2) + 1);
  write_text_file(folder / "points.jsonl", text);
  seen.clear();
  static_cast<void>(run_study(twelve_points(), no_inputs, synthetic_trial, folder.path(), options));
  expect_pace(10, 12);
}

// Friction 0.2 fails at first: its three points are missing, the nine others are kept; then it works.
TEST(RunStudy, KeepsThePointsBesideOneThatThrows) {
  const TemporaryFolder folder;
  bool broken = true;
  std::atomic<int> calls{0};
  const auto trial = [&](const Overrides& overrides, double k, double press, std::uint64_t seed) {
    ++calls;
    if (broken && testing::number_of(overrides, "synthetic.friction", 0.0) == 0.2)
      throw std::runtime_error("the tendon broke");
    return synthetic_trial(overrides, k, press, seed);
  };
  try {
    static_cast<void>(run_study(twelve_points(), no_inputs, trial, folder.path(), options_for(2)));
    ADD_FAILURE() << "nothing thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("3 of the points failed, first point 2 (none, friction 0.2): the tendon broke"));
  }
  const int before = calls;
  broken = false;
  calls = 0;
  EXPECT_EQ(csv_of(run_study(twelve_points(), no_inputs, trial, folder.path(), options_for(2))),
            expected_csv());
  EXPECT_LT(calls, before);
}

TEST(RunStudy, ChecksEveryPointBeforeAnythingRuns) {
  const TemporaryFolder folder;
  const auto check = [](const Overrides& overrides) -> StudyInputs {
    if (testing::number_of(overrides, "synthetic.gain", 1.0) == 3.0) throw SceneError("is not a known key");
    return {};
  };
  const auto never = [](const Overrides&, double, double, std::uint64_t) -> TrialResult {
    ADD_FAILURE() << "ran";
    return {};
  };
  expect_refusal(
      [&] { static_cast<void>(run_study(twelve_points(), check, never, folder / "out", options_for(2))); },
      {"study synthetic", "point 8", "friction 0", "is not a known key"});
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST(CheckStudy, DoesNotDependOnTheNumberOfThreads) {
  const Study study = testing::study_of(
      "scene = \"press_teapot\"\nseeds = 1\n[[axis]]\nkey = \"synthetic.friction\"\nfrom = 1\nto = "
      "9001\nstep = 1\n");
  const auto text_of = [](const Overrides& overrides) {
    return std::to_string(testing::number_of(overrides, "synthetic.friction", 0.0));
  };
  const auto check = [&](const Overrides& overrides) {
    return StudyInputs{.text = text_of(overrides), .files = {}};
  };
  const std::string alone = check_study(study, check, 1);
  for (const int jobs : {0, 2, 7}) EXPECT_EQ(check_study(study, check, jobs), alone) << jobs;
  const auto refusing = [&](const Overrides& overrides) -> StudyInputs {
    if (testing::number_of(overrides, "synthetic.friction", 0.0) >= 5000.0) throw SceneError("too rough");
    return check(overrides);
  };
  for (const int jobs : {1, 7})
    expect_refusal([&] { static_cast<void>(check_study(study, refusing, jobs)); },
                   {"point 4999", "friction 5000", "too rough"});
  const auto stopped = [&](const Overrides&) -> StudyInputs { throw std::runtime_error("stopped"); };
  for (const int jobs : {1, 7})
    EXPECT_THROW(static_cast<void>(check_study(study, stopped, jobs)), std::runtime_error);
}

TEST(RunStudy, KnowsWhenWhatThePointsReadHasChanged) {
  const TemporaryFolder folder;
  std::string device = "light";
  const auto check = [&](const Overrides&) { return StudyInputs{.text = device, .files = {}}; };
  static_cast<void>(run_study(twelve_points(), check, synthetic_trial, folder.path(), options_for(2)));
  device = "heavy";
  EXPECT_THROW(
      static_cast<void>(run_study(twelve_points(), check, synthetic_trial, folder.path(), options_for(2))),
      std::invalid_argument);
  StudyOptions restart = options_for(2);
  restart.restart = true;
  EXPECT_EQ(csv_of(run_study(twelve_points(), check, synthetic_trial, folder.path(), restart)),
            expected_csv());
}

TEST(RunStudy, EndsIfAFileOfItsInputsChangesAndGoesOnOnceThatIsRestored) {
  const TemporaryFolder folder;
  for (const bool content_is_compared : {true, false}) {
    const auto file = folder / "device.toml";
    const auto out = folder / (content_is_compared ? "a" : "b");
    write_text_file(file, "mass = 1\n");
    const auto check = [&](const Overrides&) {
      StudyInputs inputs{.text = "mass 1", .files = {}, .read = {}};
      (content_is_compared ? inputs.files : inputs.read).push_back(file);
      return inputs;
    };
    const auto changing = [&](const Overrides& overrides, double k, double press, std::uint64_t seed) {
      // Point 8 is the first of the third variant.
      if (testing::number_of(overrides, "synthetic.gain", 1.0) == 3.0) write_text_file(file, "mass = 10\n");
      return synthetic_trial(overrides, k, press, seed);
    };
    try {
      static_cast<void>(run_study(twelve_points(), check, changing, out, options_for(1)));
      ADD_FAILURE() << "points of both contents are in one result";
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::AllOf(HasSubstr("device.toml"), HasSubstr("was changed"),
                                                 HasSubstr("--restart")));
    }
    EXPECT_EQ(read_journal(out / "points.jsonl").points.size(), 8U);
    if (content_is_compared) {
      EXPECT_THROW(static_cast<void>(run_study(twelve_points(), check, synthetic_trial, out, options_for(1))),
                   std::invalid_argument);
    }
    write_text_file(file, "mass = 1\n");
    EXPECT_EQ(csv_of(run_study(twelve_points(), check, synthetic_trial, out, options_for(1))),
              expected_csv());
  }
}

// What the points of a study read, and what was compared, must be one state of each file.
TEST(CheckStudy, RefusesAFileThatChangesMeanwhile) {
  const TemporaryFolder folder;
  const auto file = folder / "device.toml";
  struct Change {
    int call;  // after which the file is written: 1 to 12 read it for a point, 13 for the first one once more
    std::string content;
  };
  for (const Change& change :
       {Change{2, "mass = 10\n"}, Change{13, "mass = 10\n"}, Change{13, "mass = 1\n"}}) {
    write_text_file(file, "mass = 1\n");
    int calls = 0;
    const auto check = [&](const Overrides&) {
      StudyInputs inputs{.text = read_file(file), .files = {}, .read = {file}};
      if (++calls == change.call) write_text_file(file, change.content);
      return inputs;
    };
    try {
      static_cast<void>(check_study(twelve_points(), check, 1));
      ADD_FAILURE() << change.call << " " << change.content;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::AllOf(HasSubstr("device.toml"), HasSubstr("while the points")));
    }
    EXPECT_EQ(calls, 13);
  }
  int calls = 0;
  const auto broken = [&](const Overrides&) -> StudyInputs {
    if (++calls == 13) throw std::invalid_argument("device.toml: is no TOML");
    return {.text = "mass 1", .files = {}, .read = {file}};
  };
  EXPECT_THROW(static_cast<void>(check_study(twelve_points(), broken, 1)), std::runtime_error);
}

TEST(CheckedTrial, EndsATrialDuringWhichAnotherFileStoodInThePlaceOfOne) {
  const TemporaryFolder folder;
  const auto file = folder / "device.toml";
  const auto aside = folder / "aside.toml";
  write_text_file(file, "mass = 1\n");
  InputFiles files;
  EXPECT_TRUE(files.add(file));
  EXPECT_FALSE(files.add(file));
  const TrialFunction trial = synthetic_trial;
  const TrialFunction checked = checked_trial(trial, files);
  EXPECT_NO_THROW(static_cast<void>(checked({}, 300.0, 3.0, 1)));
  std::filesystem::rename(file, aside);
  EXPECT_THROW(static_cast<void>(checked({}, 300.0, 3.0, 1)), std::runtime_error);
  write_text_file(file, "mass = 1\n");  // of the same size, at another place on the disk
  EXPECT_THROW(static_cast<void>(checked({}, 300.0, 3.0, 1)), std::runtime_error);
  std::filesystem::rename(aside, file);
  EXPECT_NO_THROW(static_cast<void>(checked({}, 300.0, 3.0, 1))) << "as it was";
}

// A build with changes is not told from another one by its commit alone.
TEST(RunStudy, NamesTheProgramWithItsFingerprintWhereTheCommitDoesNotSayAll) {
  const std::string commit = built_from_commit();
  const bool says_all = commit != "unknown" && !commit.ends_with("-dirty");
  const std::string version = program_version();
  EXPECT_THAT(version, ::testing::StartsWith(commit));
  EXPECT_EQ(version.size(), commit.size() + (says_all ? 0 : 1 + 16));
  EXPECT_EQ(program_version(), version);
}

// Measuring on would be for nothing. Once there is room again, the same call does all of it.
TEST(RunStudy, EndsIfTheJournalCannotBeWritten) {
  const TemporaryFolder folder;
  StudyOptions options = options_for(2);
  std::atomic<int> calls{0};
  const auto filling = [&](const Overrides& overrides, double k, double press, std::uint64_t seed) {
    // From here on no file of this process may grow: the journal's header is in place, its first point is
    // not.
    if (calls++ == 0) {
      rlimit limit{};
      ::getrlimit(RLIMIT_FSIZE, &limit);
      limit.rlim_cur = static_cast<rlim_t>(std::filesystem::file_size(folder / "points.jsonl"));
      ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    return synthetic_trial(overrides, k, press, seed);
  };
  rlimit before{};
  ::getrlimit(RLIMIT_FSIZE, &before);
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  EXPECT_THROW(static_cast<void>(run_study(twelve_points(), no_inputs, filling, folder.path(), options)),
               std::runtime_error);
  ::setrlimit(RLIMIT_FSIZE, &before);
  ::signal(SIGXFSZ, handler);
  const std::string header = read_file(folder / "points.jsonl");
  EXPECT_EQ(std::count(header.begin(), header.end(), '\n'), 1);
  EXPECT_EQ(csv_of(run_study(twelve_points(), no_inputs, synthetic_trial, folder.path(), options)),
            expected_csv());
}

class Shards : public ::testing::Test {
 protected:
  void run(int index, const std::string& into) const {
    StudyOptions options = options_for(2);
    options.shard = {.index = index, .count = 3};
    const auto results = run_study(twelve_points(), no_inputs, synthetic_trial, folder / into, options);
    EXPECT_EQ(results.size(), 4U);
    for (const PointResult& result : results) EXPECT_EQ(result.index % 3, index - 1);
  }
  TemporaryFolder folder;
};

TEST_F(Shards, MergeIntoWhatOneRunGives) {
  run(1, "a");
  run(2, "a");  // two journals in one folder
  run(3, "b");
  const MergedStudy merged = merge_studies({folder / "a", folder / "b"}, folder / "all");
  EXPECT_EQ(study_csv(merged.study, merged.results), expected_csv());
  // And the merged folder can be taken up as if it had never been in parts.
  const auto never = [](const Overrides&, double, double, std::uint64_t) -> TrialResult {
    ADD_FAILURE() << "ran";
    return {};
  };
  EXPECT_EQ(csv_of(run_study(twelve_points(), no_inputs, never, folder / "all", options_for(2))),
            expected_csv());
}

TEST_F(Shards, AreListedIfTheyAreMissing) {
  run(1, "a");
  run(3, "b");
  try {
    static_cast<void>(merge_studies({folder / "a", folder / "b"}, folder / "all"));
    ADD_FAILURE() << "merged";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("4 of 12 points are missing: 1, 4, 7, 10;"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "all"));
}

// Of 12 points 1, 2, 3, 5, 6, 9 and 11 are gone: three in a row, two in a row, and two alone.
TEST_F(Shards, MissingPointsInARowAreListedAsARange) {
  const std::vector<PointResult> whole =
      run_study(twelve_points(), no_inputs, synthetic_trial, folder / "a", options_for(2));
  JournalContent left = read_journal(folder / "a" / "points.jsonl");
  left.points.clear();
  for (const int kept : {0, 4, 7, 8, 10}) left.points.push_back(whole[static_cast<std::size_t>(kept)]);
  write_text_file(folder / "a" / "points.jsonl", journal_text(left));
  expect_refusal([&] { static_cast<void>(merge_studies({folder / "a"}, folder / "all")); },
                 {"7 of 12 points are missing: 1-3, 5-6, 9, 11;"});
}

TEST_F(Shards, ManyMissingPointsAreCounted) {
  const Study study =
      study_of("scene = \"a\"\nseeds = 1\n[[axis]]\nkey = \"b\"\nfrom = 0\nto = 99\nstep = 1");
  StudyOptions half = options_for(2);
  half.shard = {.index = 1, .count = 2};
  static_cast<void>(run_study(study, no_inputs, synthetic_trial, folder / "a", half));
  expect_refusal([&] { static_cast<void>(merge_studies({folder / "a"}, folder / "all")); },
                 {"50 of 100 points are missing: 1, 3, ", ", 37, 39 and 30 more; run the shards"});
}

TEST_F(Shards, OfAnotherStudyAreRefused) {
  run(1, "a");
  StudyOptions options = options_for(2);
  options.commit = "newer";
  static_cast<void>(run_study(twelve_points(), no_inputs, synthetic_trial, folder / "b", options));
  EXPECT_THROW(static_cast<void>(merge_studies({folder / "a", folder / "b"}, folder / "all")),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(merge_studies({folder / "nothing"}, folder / "all")), std::invalid_argument);
}

TEST_F(Shards, OfMachinesThatRoundDifferentlyAreRefused) {
  run(1, "a");
  run(2, "b");
  run(3, "c");
  const auto file = folder / "b/points.2-of-3.jsonl";
  JournalContent other = read_journal(file);
  EXPECT_EQ(other.header.libm, read_journal(folder / "a/points.1-of-3.jsonl").header.libm);
  other.header.libm = "other";
  replace_journal(file, other);
  expect_refusal(
      [&] { static_cast<void>(merge_studies({folder / "a", folder / "b", folder / "c"}, folder / "all")); },
      {"points.2-of-3.jsonl", "rounds differently"});
  other.points.clear();
  replace_journal(file, other);
  expect_refusal(
      [&] { static_cast<void>(merge_studies({folder / "a", folder / "b", folder / "c"}, folder / "all")); },
      {"4 of 12 points are missing"});
}

TEST_F(Shards, MustAgreeWhereTheyOverlap) {
  run(1, "a");
  static_cast<void>(run_study(twelve_points(), no_inputs, synthetic_trial, folder / "b", options_for(2)));
  EXPECT_EQ(merge_studies({folder / "a", folder / "b"}, folder / "c").results.size(), 12U);
  std::string text = read_file(folder / "a/points.1-of-3.jsonl");
  const std::size_t at = text.find("\"trials\":") + 9;
  text[at] = text[at] == '1' ? '2' : '1';
  write_text_file(folder / "a/points.1-of-3.jsonl", text);
  try {
    static_cast<void>(merge_studies({folder / "a", folder / "b"}, folder / "d"));
    ADD_FAILURE() << "merged";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), HasSubstr("different results"));
  }
}

TEST_F(Shards, AreRefusedUnderAnotherName) {
  run(1, "a");
  std::filesystem::create_directories(folder / "b");
  std::filesystem::rename(folder / "a/points.1-of-3.jsonl", folder / "b/points.2-of-3.jsonl");
  StudyOptions options = options_for(2);
  options.shard = {.index = 2, .count = 3};
  EXPECT_THROW(
      static_cast<void>(run_study(twelve_points(), no_inputs, synthetic_trial, folder / "b", options)),
      std::invalid_argument);
}

TEST(Shard, IsReadFromText) {
  EXPECT_EQ(parse_shard("2/3").index, 2);
  EXPECT_EQ(parse_shard("2/3").count, 3);
  for (const char* text : {"", "2", "0/3", "4/3", "2/3x", "/3", "2/", "-1/3", "a/b", "1//2"})
    EXPECT_THROW(static_cast<void>(parse_shard(text)), std::invalid_argument) << text;
}

TEST(StudyOutputs, HaveOneRowAPoint) {
  const std::string& csv = expected_csv();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 13);
  EXPECT_THAT(csv, ::testing::StartsWith("point,variant,synthetic.friction,k_lim_n_per_mm,at_least,"));
  EXPECT_THAT(
      csv,
      HasSubstr(
          "\n6,smoothing,0.2,2.5,false,false,false,true,2.5,2.0,5,2.25,0.05,0.02,300.0,500.0,3.0,5.0,62,0,"));
  EXPECT_THAT(csv, HasSubstr("\n11,\"wall, \"\"local\"\"\",0.3,4.0,true,"));
}

TEST(StudyOutputs, LeaveEmptyWhatThereIsNot) {
  PointResult result;
  result.k_lim = 0.0;
  EXPECT_THAT(study_csv(study_of("scene = \"a\""), {result}),
              HasSubstr("\n0,0.0,false,false,false,false,,,0,,,,,,,,0,0,\n"));
}

TEST(StudyOutputs, SummariseWithEveryCheckedStiffness) {
  const TemporaryFolder folder;
  const auto results = run_study(twelve_points(), no_inputs, synthetic_trial, folder.path(), options_for(2));
  write_study_outputs(folder.path(), twelve_points(), results,
                      {.commit = "test", .cpu = "", .compiler = "", .build_type = "", .date = ""});
  const std::string text = read_file(folder / "summary.json");
  EXPECT_EQ(text, nlohmann::ordered_json::parse(text).dump(2) + "\n");
  const auto summary = nlohmann::json::parse(text);
  EXPECT_EQ(summary["made"]["commit"], "test");
  EXPECT_EQ(summary["study"]["seeds"], 5);
  ASSERT_EQ(summary["points"].size(), 12U);
  const auto& point = summary["points"][6];
  EXPECT_EQ(point["variant"], "smoothing");
  EXPECT_EQ(point["values"]["synthetic.friction"], 0.2);
  EXPECT_EQ(point["k_lim_n_per_mm"], 2.5);
  EXPECT_EQ(point["checked"].size(), results[6].checked.size());
  EXPECT_EQ(point["checked"][0]["verdict"], "stable");
  EXPECT_EQ(read_file(folder / "study.csv"), expected_csv());
}

/// Every number is another: 2.5 N/mm are 2500 N/m, 1.25 mm are 1.25e-3 m, 31 ms are 0.031 s, 2 mJ are 0.002
/// J.
PointResult numbered_result() {
  PointResult result;
  result.index = 6;
  result.k_lim = 2500.0;
  result.at_least = true;
  result.non_monotone = false;
  result.ends_in_invalid = true;
  result.stable = false;
  result.measured_at = 2400.0;
  result.k_eff = 1900.0;
  result.k_eff_seeds = 4;
  result.peak_depth = 1.25e-3;
  result.force_swing = 0.375;
  result.position_swing = 0.02e-3;
  result.ghost_s = {.mean = 0.031, .largest = 0.042};
  result.ghost_energy = {.mean = 0.002, .largest = 0.003};
  result.trials = 62;
  result.invalid_trials = 3;
  result.why_invalid = "say \"no\"";
  result.checked = {{.n_per_mm = 2.6,
                     .verdict = Verdict::kUnstable,
                     .seeds_run = 5,
                     .force_swing = 2.25,
                     .position_swing = 0.875e-3}};
  return result;
}

TEST(StudyOutputs, EveryColumnIsInTheUnitOfItsName) {
  const Made made{.commit = "c", .cpu = "p", .compiler = "g", .build_type = "b", .date = "d"};
  const auto summary = nlohmann::json::parse(study_summary_json(twelve_points(), {numbered_result()}, made));
  EXPECT_EQ(
      summary["made"],
      (nlohmann::json{{"commit", "c"}, {"cpu", "p"}, {"compiler", "g"}, {"build_type", "b"}, {"date", "d"}}));
  ASSERT_EQ(summary["points"].size(), 1U);
  EXPECT_EQ(summary["points"][0], (nlohmann::json{{"point", 6},
                                                  {"variant", "smoothing"},
                                                  {"values", {{"synthetic.friction", 0.2}}},
                                                  {"k_lim_n_per_mm", 2.5},
                                                  {"at_least", true},
                                                  {"non_monotone", false},
                                                  {"ends_in_invalid", true},
                                                  {"stable", false},
                                                  {"measured_at_n_per_mm", 2.4},
                                                  {"k_eff_n_per_mm", 1.9},
                                                  {"k_eff_seeds", 4},
                                                  {"peak_depth_mm", 1.25},
                                                  {"force_swing_n", 0.375},
                                                  {"position_swing_mm", 0.02},
                                                  {"ghost_mean_ms", 31.0},
                                                  {"ghost_largest_ms", 42.0},
                                                  {"ghost_energy_mean_mj", 2.0},
                                                  {"ghost_energy_largest_mj", 3.0},
                                                  {"trials", 62},
                                                  {"invalid_trials", 3},
                                                  {"why_invalid", "say \"no\""},
                                                  {"checked",
                                                   {{{"n_per_mm", 2.6},
                                                     {"verdict", "unstable"},
                                                     {"seeds_run", 5},
                                                     {"force_swing_n", 2.25},
                                                     {"position_swing_mm", 0.875}}}}}));
  EXPECT_THAT(
      study_csv(twelve_points(), {numbered_result()}),
      HasSubstr("\n6,smoothing,0.2,2.5,true,false,true,false,2.4,1.9,4,1.25,0.375,0.02,31.0,42.0,2.0,3.0,"
                "62,3,\"say \"\"no\"\"\"\n"));
}

// The journal keeps SI units, to the last bit.
TEST(StudyOutputs, EveryFieldOfAJournalsLineIsInTheUnitOfItsName) {
  const auto line = nlohmann::json::parse(result_line(numbered_result()));
  EXPECT_EQ(line, (nlohmann::json{{"point", 6},
                                  {"k_lim_n_per_m", 2500.0},
                                  {"at_least", true},
                                  {"non_monotone", false},
                                  {"ends_in_invalid", true},
                                  {"stable", false},
                                  {"measured_at_n_per_m", 2400.0},
                                  {"k_eff_n_per_m", 1900.0},
                                  {"k_eff_seeds", 4},
                                  {"peak_depth_m", 1.25e-3},
                                  {"force_swing_n", 0.375},
                                  {"position_swing_m", 0.02e-3},
                                  {"ghost_s", {{"mean", 0.031}, {"largest", 0.042}}},
                                  {"ghost_energy_j", {{"mean", 0.002}, {"largest", 0.003}}},
                                  {"trials", 62},
                                  {"invalid_trials", 3},
                                  {"why_invalid", "say \"no\""},
                                  {"checked",
                                   {{{"n_per_mm", 2.6},
                                     {"verdict", "unstable"},
                                     {"seeds_run", 5},
                                     {"force_swing_n", 2.25},
                                     {"position_swing_m", 0.875e-3}}}}}));
}

// What was yes is no the second time.
TEST(StudyOutputs, EveryFieldOfAJournalsLineIsReadBack) {
  for (const bool yes : {false, true}) {
    PointResult result = numbered_result();
    result.at_least = result.ends_in_invalid = yes;
    result.non_monotone = result.stable = !yes;
    EXPECT_EQ(result_line(result_from_json(result_to_json(result))), result_line(result));
  }
}

// (0.7 - 0.1) / 0.1 is 5.999... in binary: 0.1, 0.2, ..., 0.7 are seven values whatever the last bit says.
TEST(StiffnessGrid, HasItsLastValueHoweverTheStepIsRounded) {
  const StiffnessGrid grid{.min_n_per_mm = 0.1, .max_n_per_mm = 0.7, .step_n_per_mm = 0.1};
  ASSERT_EQ(grid.size(), 7);
  EXPECT_EQ(grid.n_per_mm(6), 0.7);
  EXPECT_EQ(grid.at(2), 300.0) << "0.3 N/mm";
}

}  // namespace
}  // namespace phalanx
