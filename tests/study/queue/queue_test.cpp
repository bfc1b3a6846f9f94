// SPDX-License-Identifier: Apache-2.0
// The queue on a real server, with trials whose answers are known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <stdexcept>
#include <utility>

#include "phalanx/record/made.h"
#include "phalanx/study/laboratory/outputs.h"
#include "phalanx/study/laboratory/study_file.h"
#include "phalanx/study/queue.h"
#include "study/laboratory/checked_inputs.h"
#include "study/laboratory/expect_refusal.h"
#include "study/laboratory/synthetic.h"
#include "study/queue/pace.h"
#include "study/queue/point_process.h"
#include "study/queue/postgres_server.h"
#include "study/queue/study_queue.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using testing::PostgresServer;
using testing::read_file;
using testing::TemporaryFolder;

constexpr double kLongLease = 3600.0;  // [s]; none ends while a test runs
constexpr double kNoLease = 1e-6;      // [s]; every one has ended, also after a start of the server

/// One server for the suite, with empty tables for each case.
class StudyQueueTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (!PostgresServer::programs().empty()) server_ = std::make_unique<PostgresServer>();
  }
  static void TearDownTestSuite() { server_.reset(); }
  void SetUp() override {
    if (!server_) {
      ASSERT_EQ(std::getenv("PHALANX_CI"), nullptr) << "PostgreSQL is missing (package postgresql-15)";
      GTEST_SKIP() << "PostgreSQL is not installed (package postgresql-15)";
    }
    sql("DROP SCHEMA IF EXISTS phalanx CASCADE");
  }

  static void sql(const std::string& statement) {
    soci::session session(soci::postgresql, server_->url());
    session << "SET client_min_messages = warning";
    session << statement;
  }
  static int number(const std::string& query) {
    soci::session session(soci::postgresql, server_->url());
    int result = -1;
    session << query, soci::into(result);
    return result;
  }
  static QueueServer address() { return {.url = server_->url(), .stopped = {}, .tell = {}}; }

  [[nodiscard]] JournalHeader header() const {
    return {.study = study_, .inputs = check_study(study_, testing::no_inputs), .commit = "test"};
  }
  /// Puts the study into the queue without waiting for results.
  void create(double lease_s = kLongLease) const { StudyQueue(address()).create(header(), lease_s, false); }
  /// The same for points that read `file`. @returns their check
  [[nodiscard]] StudyCheck create_reading(const std::filesystem::path& file) const {
    const StudyCheck check = [file](const Overrides&) {
      return StudyInputs{.text = "mass 1", .files = {}, .read = {file}};
    };
    StudyQueue(address()).create({.study = study_, .inputs = check_study(study_, check), .commit = "test"},
                                 kLongLease, false);
    return check;
  }
  [[nodiscard]] QueueWork work(const TrialFunction& trial, int jobs = 2) const {
    return work_on_queue(study_, testing::no_inputs, trial, address(),
                         {.commit = "test", .jobs = jobs, .finished = {}});
  }
  [[nodiscard]] QueuedResults run(const QueueRunOptions& options = {.commit = "test"}) const {
    return run_on_queue(study_, testing::no_inputs, folder_.path(), address(), options);
  }
  /// Those of one process on one thread.
  [[nodiscard]] std::vector<PointResult> alone() const {
    return run_study(study_, testing::no_inputs, testing::synthetic_trial, alone_.path(),
                     testing::options_for(1));
  }
  void expect_the_results_of_one_process(const QueuedResults& queued) const {
    EXPECT_TRUE(queued.whole);
    EXPECT_EQ(study_csv(study_, queued.results), study_csv(study_, alone()));
    EXPECT_EQ(read_file(folder_ / "points.jsonl"), read_file(alone_ / "points.jsonl"));
  }

  static std::unique_ptr<PostgresServer> server_;
  Study study_ = testing::study_of(testing::kTwelvePoints);
  TemporaryFolder folder_;
  TemporaryFolder alone_;
};
std::unique_ptr<PostgresServer> StudyQueueTest::server_;

TEST_F(StudyQueueTest, TheResultsAreThoseOfOneProcess) {
  create();
  const QueueWork done = work(testing::synthetic_trial);
  EXPECT_EQ(done.finished, 12);
  EXPECT_EQ(done.failed, 0);
  EXPECT_TRUE(done.whole);
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.workers WHERE ended IS NOT NULL AND jobs = 2"), 1);
  const QueuedResults queued = run();
  expect_the_results_of_one_process(queued);
  EXPECT_EQ(queued.processors, made_here().cpu);
}

TEST_F(StudyQueueTest, AFinishedPointIsNotMeasuredAgain) {
  create();
  static_cast<void>(work(testing::synthetic_trial));
  create();
  const QueueWork again =
      work([](const Overrides&, double, double, std::uint64_t) -> TrialResult { std::abort(); });
  EXPECT_EQ(again.finished, 0);
  EXPECT_EQ(again.failed, 0);
  EXPECT_TRUE(again.whole);
}

TEST_F(StudyQueueTest, PointsOfAJournalEnterAsFinished) {
  StudyQueue(address()).create(header(), kLongLease, false);
  const auto expected = alone();
  std::filesystem::copy_file(alone_ / "points.jsonl", folder_ / "points.jsonl");
  expect_the_results_of_one_process(run());
}

TEST_F(StudyQueueTest, AJournalThatContradictsTheQueueIsRefused) {
  create();
  std::string other = result_line(alone()[3]);
  other.replace(other.find("\"trials\":"), 9, "\"trials\":1");
  other.pop_back();
  StudyQueue queue(address());
  queue.join(header(), 1);
  queue.finish({{.index = 3, .seconds = 1.0, .result = other}});
  std::filesystem::copy_file(alone_ / "points.jsonl", folder_ / "points.jsonl");
  testing::expect_refusal([&] { static_cast<void>(run()); }, {"point 3", "different results"});
  EXPECT_EQ(read_file(folder_ / "points.jsonl"), read_file(alone_ / "points.jsonl"));
}

TEST_F(StudyQueueTest, ACrashCostsItsPointAndThreeQuarantineIt) {
  create();
  const auto crashing = [](const Overrides& overrides, double stiffness, double press, std::uint64_t seed) {
    if (testing::number_of(overrides, "synthetic.friction", 0.0) == 0.2 &&
        testing::number_of(overrides, "synthetic.gain", 1.0) == 2.0) {
      std::fprintf(stderr, "the last words\n");
      std::abort();
    }
    return testing::synthetic_trial(overrides, stiffness, press, seed);
  };
  const QueueWork done = work(crashing, 1);
  EXPECT_EQ(done.finished, 11);
  EXPECT_EQ(done.failed, kFailuresToQuarantine);
  EXPECT_TRUE(done.whole);
  const QueuedResults queued = run();
  EXPECT_FALSE(queued.whole);
  EXPECT_EQ(queued.results.size(), 11U);
  ASSERT_EQ(queued.quarantined.size(), 1U);
  EXPECT_EQ(queued.quarantined[0].index, 6);
  EXPECT_THAT(queued.quarantined[0].log, HasSubstr("ended by signal 6"));
  EXPECT_THAT(queued.quarantined[0].log, HasSubstr("the last words"));

  StudyQueue queue(address());  // when the cause is mended
  queue.create(header(), kLongLease, false);
  queue.retry_quarantined();
  EXPECT_EQ(work(testing::synthetic_trial).finished, 1);
  expect_the_results_of_one_process(run());
}

TEST_F(StudyQueueTest, ATrialThatThrowsFailsItsPoint) {
  create();
  const auto throwing = [](const Overrides& overrides, double stiffness, double press, std::uint64_t seed) {
    if (testing::number_of(overrides, "synthetic.friction", 0.0) == 0.3)
      throw std::runtime_error("no\nmesh \xff");
    return testing::synthetic_trial(overrides, stiffness, press, seed);
  };
  const QueueWork done = work(throwing);
  EXPECT_EQ(done.finished, 9);
  EXPECT_EQ(done.failed, 3 * kFailuresToQuarantine);
  const QueuedResults queued = run();
  ASSERT_EQ(queued.quarantined.size(), 3U);
  const std::string& log = queued.quarantined[2].log;
  EXPECT_THAT(log, MatchesRegex("(on [^:]+: no mesh [?](\n\n)?)+")) << "each failure, with its machine";
  EXPECT_EQ(std::count(log.begin(), log.end(), '?'), kFailuresToQuarantine) << log;
}

TEST_F(StudyQueueTest, AFailedPointIsLeftToAnotherMachineWhileOneWorks) {
  create();
  StudyQueue one(address());
  StudyQueue beside(address());
  StudyQueue other(address());
  for (StudyQueue* worker : {&one, &beside, &other}) worker->join(header(), 1);
  sql("UPDATE phalanx.workers SET host = 'another' WHERE id = (SELECT max(id) FROM phalanx.workers)");
  ASSERT_THAT(one.take(1), ElementsAre(0));
  one.fail(0, "no room in /tmp");
  EXPECT_THAT(one.take(1), ElementsAre(1));
  EXPECT_THAT(beside.take(1), ElementsAre(2)) << "on the same machine";
  EXPECT_THAT(other.take(1), ElementsAre(0));
  other.fail(0, "out of memory");
  EXPECT_THAT(one.take(1), ElementsAre(0)) << "the last failure was on the other machine";
  one.give_back({0, 1});
  beside.leave({2});
  EXPECT_THAT(other.take(1), ElementsAre(1)) << "given back";
  one.leave({});
  EXPECT_THAT(other.take(1), ElementsAre(0)) << "no other machine works";
  other.fail(0, "out of memory");
  other.leave({1});
  EXPECT_EQ(work(testing::synthetic_trial).finished, 11);
  const QueuedResults queued = run();
  ASSERT_EQ(queued.quarantined.size(), 1U);
  EXPECT_THAT(queued.quarantined[0].log, AllOf(HasSubstr("no room in /tmp"), HasSubstr("out of memory")));
}

TEST_F(StudyQueueTest, AProcessThatEndsInGoodOrderFailsItsPointToo) {
  create();
  const auto ending = [](const Overrides& overrides, double stiffness, double press, std::uint64_t seed) {
    if (testing::number_of(overrides, "synthetic.friction", 0.0) == 0.1) std::_Exit(0);
    return testing::synthetic_trial(overrides, stiffness, press, seed);
  };
  const QueueWork done = work(ending);
  EXPECT_EQ(done.finished, 9);
  EXPECT_EQ(done.failed, 3 * kFailuresToQuarantine);
  EXPECT_THAT(run().quarantined.at(0).log, HasSubstr("ended with code 0"));
}

// A trial of point 3 never ends; the others take no time.
TrialResult endless_at_point_3(const Overrides& overrides, double stiffness, double press,
                               std::uint64_t seed) {
  while (testing::number_of(overrides, "synthetic.friction", 0.0) == 0.3 &&
         testing::number_of(overrides, "synthetic.gain", 1.0) == 1.0)
    ::pause();
  return testing::synthetic_trial(overrides, stiffness, press, seed);
}

void wait_for_answer(const PointProcess& process) {
  pollfd answers{.fd = process.answers(), .events = POLLIN, .revents = 0};
  ASSERT_EQ(::poll(&answers, 1, -1), 1);
}

void read_until_the_end(PointProcess& process) {
  while (!process.ended()) static_cast<void>(process.read());
}

TEST(PointProcess, TheLimitIsOfEachPoint) {
  const Study study = testing::study_of(testing::kTwelvePoints);
  PointProcess process(study, endless_at_point_3);
  for (const int point : {0, 1, 2}) {
    process.give(point);
    process.pass(0.9, 1.0);
    while (!process.pending().empty()) static_cast<void>(process.read());
  }
  process.give(3);
  process.give(4);
  process.pass(0.9, 1.0);
  EXPECT_TRUE(process.read().empty());
  EXPECT_FALSE(process.ended());
  process.pass(0.2, 1.0);
  read_until_the_end(process);
  EXPECT_FALSE(process.ended_for_nothing());
  EXPECT_THAT(process.pending(), ElementsAre(3, 4));
  EXPECT_THAT(process.how_it_ended(), HasSubstr("the point took 1.1 s"));
}

TEST(PointProcess, APointThatWasMeasuredBeforeTheEndIsNoFailure) {
  const Study study = testing::study_of(testing::kTwelvePoints);
  PointProcess process(study, endless_at_point_3);
  process.give(0);
  process.give(3);
  wait_for_answer(process);
  process.pass(1.1, 1.0);  // it ends for point 0, whose answer was not read yet
  read_until_the_end(process);
  EXPECT_TRUE(process.ended_for_nothing());
  EXPECT_THAT(process.pending(), ElementsAre(3));
}

// No trial here ends, so that a limit of 1 ms is right on any machine.
TEST_F(StudyQueueTest, APointThatTakesTooLongFails) {
  create();
  try {
    static_cast<void>(work_on_queue(study_, testing::no_inputs,
                                    [](const Overrides&, double, double, std::uint64_t) -> TrialResult {
                                      for (;;) ::pause();
                                    },
                                    address(), {.commit = "test", .jobs = 2, .limit_s = 1e-3}));
    ADD_FAILURE() << "20 failures in a row end the worker";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("longer than its limit"));
  }
  EXPECT_EQ(number("SELECT sum(failures) FROM phalanx.points"), 20);
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE log LIKE '%longer than its limit%'"),
            number("SELECT count(*) FROM phalanx.points WHERE failures > 0"));
  for (const double limit : {-1.0, std::nan("")})
    testing::expect_refusal(
        [&] {
          static_cast<void>(work_on_queue(study_, testing::no_inputs, testing::synthetic_trial, address(),
                                          {.commit = "test", .limit_s = limit}));
        },
        {"limit", "out of range"});
}

TEST_F(StudyQueueTest, TheUsualLimitFollowsTheTrialsOfAPoint) {
  EXPECT_EQ(usual_point_limit(study_), 3600.0);
  study_.seeds = 10000;
  EXPECT_EQ(usual_point_limit(study_), most_trials(study_).per_point);  // 20 times 0.05 s
  EXPECT_GT(usual_point_limit(study_), 3600.0);
}

TEST_F(StudyQueueTest, AMachineOnWhichEveryPointFailsQuarantinesOnlyAFew) {
  create();
  EXPECT_THROW(static_cast<void>(work([](const Overrides&, double, double, std::uint64_t) -> TrialResult {
                 throw std::runtime_error("no room in /tmp");
               })),
               std::runtime_error);
  EXPECT_EQ(number("SELECT sum(failures) FROM phalanx.points"), 20);
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE worker IS NOT NULL"), 0) << "given back";
  const QueueWork other = work(testing::synthetic_trial);
  EXPECT_TRUE(other.whole);
  EXPECT_GE(other.finished, 12 - 20 / kFailuresToQuarantine);
}

TEST_F(StudyQueueTest, WorkersOfAnotherStudyProgramOrSceneAreRefused) {
  testing::expect_refusal([&] { static_cast<void>(work(testing::synthetic_trial)); },
                          {"no study of this name", "phalanx study run"});
  create();
  StudyQueue queue(address());
  JournalHeader other = header();
  other.commit = "other";
  testing::expect_refusal([&] { queue.join(other, 1); }, {"another version of the program", "other"});
  other = header();
  other.inputs = "other";
  testing::expect_refusal([&] { queue.join(other, 1); }, {"has changed since"});
  other = header();
  other.study.seeds = 4;
  testing::expect_refusal([&] { queue.join(other, 1); }, {"the study file has changed since"});
  sql("UPDATE phalanx.studies SET header = '{\"of\": \"a version to come\"}'");
  testing::expect_refusal([&] { queue.join(other, 1); }, {"begun by another version of the program"});
}

TEST_F(StudyQueueTest, TheFirstWorkersMathematicalFunctionsAreTheStudys) {
  create();
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.studies WHERE libm = ''"), 1);
  StudyQueue worker(address());
  worker.join(header(), 1);
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.studies WHERE libm = ''"), 0);
  sql("UPDATE phalanx.studies SET libm = 'other'");
  testing::expect_refusal([&] { StudyQueue(address()).join(header(), 1); },
                          {"rounds differently", "--restart"});
  EXPECT_NO_THROW(create()) << "the machine that collects measures nothing";
  worker.leave({});
  EXPECT_NO_THROW(StudyQueue(address()).join(header(), 1)) << "nothing was measured with the other functions";
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.studies WHERE libm = 'other'"), 0);
  sql("UPDATE phalanx.workers SET ended = now()");
  sql("UPDATE phalanx.studies SET libm = 'other'");
  sql("UPDATE phalanx.points SET result = '{}' WHERE point = 5");
  testing::expect_refusal([&] { StudyQueue(address()).join(header(), 1); }, {"rounds differently"});
}

TEST_F(StudyQueueTest, AWorkerWhoseMathematicalFunctionsWereReplacedMeanwhileStoresNothing) {
  create();
  StudyQueue cut_off(address());
  cut_off.join(header(), 1);
  EXPECT_THAT(cut_off.take(1), ElementsAre(0));
  sql("UPDATE phalanx.studies SET libm = 'other'");  // as a worker of another type does once this one's lease is over
  testing::expect_refusal([&] { cut_off.finish({{.index = 0, .seconds = 1.0, .result = "{}"}}); },
                          {"rounds differently", "--restart"});
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE result IS NOT NULL"), 0);
}

TEST_F(StudyQueueTest, AWorkerOneOfWhoseFilesChangesEndsAndStoresNothingMeasuredSince) {
  const auto file = folder_ / "device.toml";
  std::ofstream(file) << "mass = 1\n";
  const StudyCheck check = create_reading(file);
  const auto changing = [&](const Overrides& overrides, double k, double press, std::uint64_t seed) {
    if (testing::number_of(overrides, "synthetic.gain", 1.0) == 2.0) std::ofstream(file) << "mass = 10\n";
    return testing::synthetic_trial(overrides, k, press, seed);
  };
  const QueueWorkOptions options{.commit = "test", .jobs = 1, .finished = {}};
  try {
    static_cast<void>(work_on_queue(study_, check, changing, address(), options));
    ADD_FAILURE() << "points of both contents are in one study";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("device.toml"), HasSubstr("was changed")));
  }
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE result IS NOT NULL AND point >= 4"), 0)
      << "points 4 to 7 change the file";
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE worker IS NOT NULL AND result IS NULL"), 0)
      << "given back";
  std::ofstream(file) << "mass = 1\n";
  EXPECT_TRUE(work_on_queue(study_, check, testing::synthetic_trial, address(), options).whole);
}

TEST_F(StudyQueueTest, AJournalOfAnotherMachineDoesNotEnter) {
  create();
  StudyQueue worker(address());
  worker.join(header(), 1);
  sql("UPDATE phalanx.studies SET libm = 'other'");
  static_cast<void>(alone());
  std::filesystem::copy_file(alone_ / "points.jsonl", folder_ / "points.jsonl");
  testing::expect_refusal([&] { static_cast<void>(run()); }, {"rounds differently"});
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE result IS NOT NULL"), 0);
  EXPECT_EQ(read_file(folder_ / "points.jsonl"), read_file(alone_ / "points.jsonl"));
}

TEST_F(StudyQueueTest, AJournalThatIsRefusedIsNotMixedWithTheQueuesResults) {
  create();
  const auto points = alone();
  std::string line = result_line(points[3]);
  line.pop_back();
  sql("UPDATE phalanx.studies SET libm = 'other'");
  sql("UPDATE phalanx.points SET finished_at = now(), result = '" + line + "' WHERE point = 3");
  const JournalContent whole = read_journal(alone_ / "points.jsonl");
  const auto journal = folder_ / "points.jsonl";
  replace_journal(journal, {.header = whole.header, .points = {whole.points[0], whole.points[1]}});
  const std::string before = read_file(journal);
  for (int call = 0; call < 2; ++call) {
    testing::expect_refusal([&] { static_cast<void>(run()); }, {"the points of the journal", "differently"});
    EXPECT_EQ(read_file(journal), before);
  }
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE result IS NOT NULL"), 1);
}

// The process that measured it may have kept what it read from the other file: it must measure nothing more.
TEST_F(StudyQueueTest, AWorkerEndsThoughTheFileIsBackWhenItLooks) {
  create();
  const auto saw_another_file = [](const Overrides&, double, double, std::uint64_t) -> TrialResult {
    throw InputsChanged("device.toml: was changed");
  };
  EXPECT_THROW(static_cast<void>(work(saw_another_file)), std::runtime_error);
  EXPECT_EQ(number("SELECT sum(failures) FROM phalanx.points"), 0);
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE worker IS NOT NULL"), 0) << "given back";
}

TEST_F(StudyQueueTest, AChangedFileIsNoFailureOfItsPoints) {
  const auto file = folder_ / "device.toml";
  std::ofstream(file) << "mass = 1\n";
  const StudyCheck check = create_reading(file);
  const auto gone = [&](const Overrides&, double, double, std::uint64_t) -> TrialResult {
    std::filesystem::remove(file);
    throw std::runtime_error("device.toml: cannot be opened");
  };
  const QueueWorkOptions options{.commit = "test", .jobs = 2, .finished = {}};
  EXPECT_THROW(static_cast<void>(work_on_queue(study_, check, gone, address(), options)), std::runtime_error);
  EXPECT_EQ(number("SELECT sum(failures) FROM phalanx.points"), 0);
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE worker IS NOT NULL"), 0) << "given back";
}

TEST_F(StudyQueueTest, AJournalKeepsTheMathematicalFunctionsOfItsWorkers) {
  create();
  sql("UPDATE phalanx.studies SET libm = 'other'");
  std::string line = result_line(alone()[3]);
  line.pop_back();
  sql("UPDATE phalanx.points SET failures = 3 WHERE point <> 3");
  sql("UPDATE phalanx.points SET finished_at = now(), result = '" + line + "' WHERE point = 3");
  EXPECT_EQ(run().results.size(), 1U);
  EXPECT_EQ(read_journal(folder_ / "points.jsonl").header.libm, "other");
  sql("DELETE FROM phalanx.studies");
  QueueRunOptions options{.commit = "test"};
  options.progress = [](const StudyProgress&) { sql("UPDATE phalanx.points SET failures = 3"); };
  EXPECT_EQ(run(options).results.size(), 1U);
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.studies WHERE libm = 'other'"), 1) << "that of the journal";
  EXPECT_EQ(read_journal(folder_ / "points.jsonl").header.libm, "other");
  testing::expect_refusal([&] { StudyQueue(address()).join(header(), 1); },
                          {"this machine's", "differently"});
}

TEST_F(StudyQueueTest, ALeaseKeepsAPointUntilItEndsOrIsGivenBack) {
  create();
  StudyQueue one(address());
  StudyQueue two(address());
  one.join(header(), 1);
  two.join(header(), 1);
  EXPECT_THAT(one.take(3), ElementsAre(0, 1, 2));
  EXPECT_THAT(two.take(2), ElementsAre(3, 4));
  EXPECT_THAT(two.take(20), ElementsAre(5, 6, 7, 8, 9, 10, 11));
  EXPECT_THAT(two.take(20), IsEmpty());
  one.leave({0, 2});
  EXPECT_THAT(two.take(20), ElementsAre(0, 2));
}

// The server may choose a nested loop that executes the selection of points once for each row.
TEST_F(StudyQueueTest, ABatchIsNoLargerThanAskedForInANestedLoop) {
  create();
  sql("ANALYZE phalanx.points");
  QueueServer nested = address();
  nested.url += "&options=";
  for (const char* other : {"hashjoin", "mergejoin", "hashagg", "sort", "material"})
    nested.url += std::string("-c%20enable_") + other + "%3Doff%20";
  StudyQueue queue(nested);
  queue.join(header(), 1);
  EXPECT_THAT(queue.take(2), ElementsAre(0, 1));
}

TEST_F(StudyQueueTest, AnEndedLeaseGoesToAnotherWorkerWhoseResultCounts) {
  create(kNoLease);
  StudyQueue cut_off(address());
  StudyQueue other(address());
  cut_off.join(header(), 1);
  other.join(header(), 1);
  EXPECT_THAT(cut_off.take(1), ElementsAre(0));
  EXPECT_THAT(other.take(1), ElementsAre(0));
  cut_off.fail(0, "too late");
  EXPECT_EQ(number("SELECT failures FROM phalanx.points WHERE point = 0"), 0);
  other.finish({{.index = 0, .seconds = 1.0, .result = "{\"point\":0}"}});
  cut_off.finish({{.index = 0, .seconds = 2.0, .result = "{\"point\":0}"}});
  EXPECT_EQ(number("SELECT CAST(seconds AS integer) FROM phalanx.points WHERE point = 0"), 1);
  sql("UPDATE phalanx.workers SET place = 'elsewhere 7' WHERE id = (SELECT max(id) FROM phalanx.workers)");
  try {
    cut_off.finish({{.index = 0, .seconds = 2.0, .result = "{}"}});
    ADD_FAILURE() << "two machines compute differently";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("that of the first result (elsewhere 7)"));
  }
}

TEST_F(StudyQueueTest, ARenewalKeepsOnlyWhatTheWorkerKnowsOf) {
  create();
  StudyQueue queue(address());
  queue.join(header(), 1);
  EXPECT_THAT(queue.take(2), ElementsAre(0, 1));
  sql("UPDATE phalanx.points SET lease_end = '2000-01-01' WHERE lease_end IS NOT NULL");
  queue.renew({1});
  EXPECT_EQ(number("SELECT min(point) FROM phalanx.points WHERE lease_end < now()"), 0);
  EXPECT_EQ(number("SELECT min(point) FROM phalanx.points WHERE lease_end > now()"), 1);
}

// A measurement that takes longer than a third of the lease: its worker renews it again and again meanwhile.
TEST_F(StudyQueueTest, AWorkerRenewsTheLeasesOfWhatItMeasures) {
  constexpr double kShortLease = 0.3;  // [s]; a slow machine may let it end: the point is still this worker's
  create(kShortLease);
  const std::string url = server_->url();
  const auto waiting = [url](const Overrides& overrides, double stiffness, double press, std::uint64_t seed) {
    static bool waited = false;  // of the one process that measures
    if (!std::exchange(waited, true)) {
      soci::session session(soci::postgresql, url);
      std::string first;
      const auto lease_end = [&] {
        std::string text;
        session << "SELECT coalesce(CAST(max(lease_end) AS text), '') FROM phalanx.points", soci::into(text);
        return text;
      };
      for (int renewals = 0; renewals < 3;) {  // the test's time limit ends it otherwise
        const std::string now = lease_end();
        if (now != first) ++renewals;
        first = now;
      }
    }
    return testing::synthetic_trial(overrides, stiffness, press, seed);
  };
  EXPECT_EQ(work(waiting, 1).finished, 12);
}

TEST_F(StudyQueueTest, AfterAStartOfTheServerLeasesCountOnceMore) {
  create();
  StudyQueue queue(address());
  queue.join(header(), 1);
  EXPECT_THAT(queue.take(12).size(), 12U);
  sql("UPDATE phalanx.points SET lease_end = '2000-01-01'");
  StudyQueue other(address());
  other.join(header(), 1);
  EXPECT_THAT(other.take(1), IsEmpty()) << "the server runs for less than a lease";
  sql("UPDATE phalanx.studies SET lease_s = 0.000001");
  other.join(header(), 1);
  EXPECT_THAT(other.take(1), ElementsAre(0));
}

TEST_F(StudyQueueTest, AConnectionThatIsLostIsMadeAgain) {
  create();
  StudyQueue queue(address());
  queue.join(header(), 1);
  server_->stop();
  server_->start();
  EXPECT_THAT(queue.take(1), ElementsAre(0));
  server_->stop();
  server_->start();
  queue.finish({{.index = 0, .seconds = 1.0, .result = "{}"}});
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE result IS NOT NULL"), 1);
}

TEST_F(StudyQueueTest, AWorkerMayBeStoppedWhileTheServerIsAway) {
  create();
  QueueServer server = address();
  std::vector<std::string> told;
  server.tell = [&](const std::string& sentence) { told.push_back(sentence); };
  server.stopped = [&] { return !told.empty(); };
  StudyQueue queue(server);
  queue.join(header(), 1);
  server_->stop();
  EXPECT_THROW(static_cast<void>(queue.take(1)), QueueStopped);
  server_->start();
  ASSERT_EQ(told.size(), 1U);
  EXPECT_THAT(told[0], HasSubstr("the queue's server is away"));
}

TEST_F(StudyQueueTest, AWorkerTellsWhyTheServerIsAwayAndThatItIsBack) {
  create();
  QueueServer server = address();
  std::vector<std::string> told;
  server.tell = [&](const std::string& sentence) {
    told.push_back(sentence);
    if (told.size() == 1) server_->start();
  };
  StudyQueue queue(server);
  queue.join(header(), 1);
  server_->stop();
  EXPECT_THAT(queue.take(1), ElementsAre(0));
  EXPECT_THAT(told, ElementsAre(HasSubstr("is away ("), HasSubstr("is back")));
}

TEST_F(StudyQueueTest, AWorkerThatIsStoppedGivesItsPointsBack) {
  create();
  QueueServer server = address();
  int finished = 0;
  server.stopped = [&] { return finished > 0; };
  const QueueWork done =
      work_on_queue(study_, testing::no_inputs, testing::synthetic_trial, server,
                    {.commit = "test", .jobs = 1, .finished = [&](int count, double) { finished = count; }});
  EXPECT_FALSE(done.whole);
  EXPECT_GE(done.finished, 1);
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE result IS NULL AND worker IS NOT NULL"), 0);
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE result IS NOT NULL"), done.finished);
}

TEST_F(StudyQueueTest, ARunThatIsStoppedKeepsWhatItHasAndShowsIt) {
  create();
  StudyQueue queue(address());
  queue.join(header(), 1);
  const auto whole = alone();
  std::string line = result_line(whole[3]);
  line.pop_back();
  queue.finish({{.index = 3, .seconds = 1.0, .result = line}});
  bool shown = false;
  QueueServer server = address();
  server.stopped = [&] { return shown; };
  QueueRunOptions options{.commit = "test"};
  options.page = [&](const std::vector<PointResult>& results, const StudyProgress& progress) {
    EXPECT_EQ(results.size(), 1U);
    EXPECT_EQ(progress.done, 1);
    EXPECT_EQ(progress.total, 12);
    EXPECT_EQ(progress.workers, 1);
    shown = true;
  };
  const QueuedResults queued = run_on_queue(study_, testing::no_inputs, folder_.path(), server, options);
  EXPECT_FALSE(queued.whole);
  ASSERT_EQ(queued.results.size(), 1U);
  EXPECT_EQ(queued.results[0].index, 3);
  EXPECT_EQ(read_journal(folder_ / "points.jsonl").points.size(), 1U);
}

TEST_F(StudyQueueTest, ARestartMeasuresEveryPointAgain) {
  create();
  static_cast<void>(work(testing::synthetic_trial));
  StudyQueue(address()).create(header(), kLongLease, true);
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE result IS NULL"), 12);
}

TEST_F(StudyQueueTest, AStudyThatIsRemovedEndsWorkersAndRunWhichKeepsItsResults) {
  create();
  StudyQueue queue(address());
  queue.join(header(), 1);
  std::string line = result_line(alone()[3]);
  line.pop_back();
  queue.finish({{.index = 3, .seconds = 1.0, .result = line}});
  std::filesystem::copy_file(alone_ / "points.jsonl", folder_ / "points.jsonl");
  const std::string journal = read_file(folder_ / "points.jsonl");
  const std::string first =
      journal.substr(0, journal.find('\n', journal.find('\n') + 1) + 1);  // and one point
  std::ofstream(folder_ / "points.jsonl") << first;
  QueueRunOptions options{.commit = "test"};
  options.progress = [](const StudyProgress&) { sql("DELETE FROM phalanx.studies"); };
  EXPECT_THROW(static_cast<void>(run(options)), std::runtime_error);
  EXPECT_THROW(static_cast<void>(queue.has_unfinished()), std::runtime_error);
  const auto kept = read_journal(folder_ / "points.jsonl").points;
  ASSERT_EQ(kept.size(), 2U) << "that of the journal, and what was collected";
  EXPECT_EQ(kept[1].index, 3);
}

TEST_F(StudyQueueTest, ARestartThatCannotReachTheServerKeepsTheJournal) {
  static_cast<void>(alone());
  QueueServer nowhere = address();
  nowhere.url += "/nowhere";
  EXPECT_THROW(static_cast<void>(run_on_queue(study_, testing::no_inputs, alone_.path(), nowhere,
                                              {.commit = "test", .restart = true})),
               std::runtime_error);
  EXPECT_EQ(read_journal(alone_ / "points.jsonl").points.size(), 12U);
}

TEST_F(StudyQueueTest, ARestartThatTheServerRefusesKeepsTheJournal) {
  create();
  static_cast<void>(alone());
  sql("CREATE ROLE reader LOGIN");
  sql("GRANT USAGE ON SCHEMA phalanx TO reader");
  sql("GRANT SELECT ON ALL TABLES IN SCHEMA phalanx TO reader");
  QueueServer reader = address();
  reader.url.replace(reader.url.find("//") + 2, reader.url.find('@') - reader.url.find("//") - 2, "reader");
  try {
    static_cast<void>(
        run_on_queue(study_, testing::no_inputs, alone_.path(), reader, {.commit = "test", .restart = true}));
    ADD_FAILURE() << "the role may not remove the study";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("permission denied"), HasSubstr("the role that owns")));
  }
  EXPECT_EQ(read_journal(alone_ / "points.jsonl").points.size(), 12U);
}

TEST_F(StudyQueueTest, ALongJournalEntersAndIsCollectedInPortions) {
  study_ = testing::study_of(
      "scene = \"press_teapot\"\nseeds = 1\n[[axis]]\nkey = \"synthetic.friction\"\nfrom = 1\nto = "
      "4501\nstep = 1\n");
  static_cast<void>(alone());
  std::filesystem::copy_file(alone_ / "points.jsonl", folder_ / "points.jsonl");
  expect_the_results_of_one_process(run());
  EXPECT_EQ(number("SELECT count(*) FROM phalanx.points WHERE result IS NOT NULL"), 4501);
}

TEST(Pace, IsThatOfTheLastMinute) {
  using std::chrono::seconds;
  Pace pace;
  EXPECT_TRUE(std::isnan(pace.per_s()));
  const Pace::Time begin{};
  pace.add(begin, 100);
  EXPECT_TRUE(std::isnan(pace.per_s()));
  pace.add(begin + seconds(10), 120);
  EXPECT_DOUBLE_EQ(pace.per_s(), 2.0);
  pace.add(begin + seconds(60), 370);
  EXPECT_DOUBLE_EQ(pace.per_s(), 270.0 / 60.0);
  pace.add(begin + seconds(65), 395);
  EXPECT_DOUBLE_EQ(pace.per_s(), 275.0 / 55.0) << "the first is more than a minute ago";
  pace.add(begin + seconds(200), 395);
  EXPECT_TRUE(std::isnan(pace.per_s()));
}

TEST_F(StudyQueueTest, ALeaseOutOfRangeIsRefused) {
  for (const double lease : {0.0, -1.0, std::nan(""), 1e9})
    testing::expect_refusal([&] { create(lease); }, {"lease", "out of range"});
}

TEST_F(StudyQueueTest, TablesOfAnotherFormatAreRefused) {
  create();
  sql("UPDATE phalanx.format SET version = 99");
  EXPECT_THROW(create(), std::runtime_error);
  static_cast<void>(alone());
  EXPECT_THROW(static_cast<void>(run_on_queue(study_, testing::no_inputs, alone_.path(), address(),
                                              {.commit = "test", .restart = true})),
               std::runtime_error);
  EXPECT_EQ(read_journal(alone_ / "points.jsonl").points.size(), 12U) << "nothing was begun again";
}

TEST_F(StudyQueueTest, AServerThatIsNotThereIsNamedAtOnce) {
  QueueServer nowhere = address();
  nowhere.url += "/nowhere";
  EXPECT_THROW(StudyQueue queue(nowhere), std::runtime_error);
}

}  // namespace
}  // namespace phalanx
