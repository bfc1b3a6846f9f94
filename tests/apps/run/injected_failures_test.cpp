// SPDX-License-Identifier: Apache-2.0
// Each write, open, fsync, fork, mapping, thread and allocation of `run`, `simulate` and `study` fails once
// for each call stack: the program ends by itself, says what failed, and keeps what it promised.
// PHALANX_FAILING_STACK=HASH makes one of them fail alone.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "apps/run/failing_program.h"
#include "apps/run/running_station.h"

namespace phalanx::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Files = std::map<std::string, std::string>;

constexpr unsigned kSeed = 1;

void expect_no_partial_file(const Files& files) {
  for (const auto& [name, content] : files) EXPECT_EQ(name.find(".partial"), std::string::npos) << name;
}

/// A command of the program: how it is run, and what it promises however it ends.
class Command {
 public:
  explicit Command(std::vector<std::string> arguments, std::string runs_from = {}, std::string typed = {})
      : program_(std::move(arguments), std::move(runs_from), std::move(typed)) {}
  Command(const Command&) = delete;
  Command& operator=(const Command&) = delete;
  virtual ~Command() = default;

  /// Runs it undisturbed.
  std::vector<Failure> record() {
    const TemporaryFolder folder;
    prepare(folder);
    std::vector<Failure> failures = program_.record(folder);
    whole_ = files_in(folder);
    return failures;
  }

  /// Runs it with one call that fails. @returns whether that call was made
  bool check(const Failure& failure) const {
    const TemporaryFolder folder;
    prepare(folder);
    const Files before = files_in(folder);
    const Outcome outcome = program_.run(folder, failure);
    SCOPED_TRACE(failure.text() + "\n" + outcome.stack + "standard error: " + outcome.err);
    expect_an_end_in_words(outcome);
    const Files after = files_in(folder);
    if (outcome.exit == 2) {
      EXPECT_EQ(after, before) << "wrong input: nothing was to be written";
    }
    expect_promises(folder, failure, outcome, after);
    return outcome.failed;
  }

 protected:
  virtual void prepare(const TemporaryFolder& /*folder*/) const {}
  virtual void expect_promises(const TemporaryFolder& folder, const Failure& failure, const Outcome& outcome,
                               const Files& files) const = 0;
  [[nodiscard]] const FailingProgram& program() const { return program_; }
  [[nodiscard]] const Files& whole() const { return whole_; }  ///< files of the run without a failure

 private:
  static void expect_an_end_in_words(const Outcome& outcome) {
    static const std::regex words("(^|\n)phalanx[a-z ]*: [^\n]{10,}\n");
    EXPECT_THAT(outcome.exit, ::testing::AnyOf(0, 1, 2));
    if (outcome.exit != 0) {
      EXPECT_TRUE(std::regex_search(outcome.err, words));
    }
  }

  const FailingProgram program_;
  Files whole_;
};

class Run : public Command {
 public:
  Run()
      : Command({"run", "index_ball", "--headless", "--no-realtime", "--rate-hz", "200", "--seconds", "2",
                 "--log", "x.csv", "--summary", "y.json"},
                "phalanx-record", "set force.stiffness_n_per_mm=0.9") {}

 private:
  void expect_promises(const TemporaryFolder& folder, const Failure& failure, const Outcome& outcome,
                       const Files& files) const override {
    const bool log = files.contains("x.csv");
    const bool partial = files.contains("x.csv.partial");
    const bool given_up = outcome.err.find("the log ends here: ") != std::string::npos;
    std::vector<LoggedStep> steps;
    ASSERT_NO_THROW(steps = read_steps(folder / (log ? "x.csv" : "x.csv.partial")));
    if (outcome.exit == 0) {
      ASSERT_TRUE(log && !partial && files.contains("y.json"));
      const auto summary = nlohmann::json::parse(files.at("y.json"));
      EXPECT_EQ(summary["steps"], steps.size());
      EXPECT_EQ(summary["records_lost"], 0);
    }
    if (given_up) {  // it goes on without a log, which says so
      EXPECT_EQ(outcome.exit, 1);
      EXPECT_THAT(outcome.err,
                  HasSubstr(partial ? "what was written is in x.csv.partial" : "nothing was written"));
      EXPECT_THAT(outcome.out, HasSubstr("ended at zero torque"));
      EXPECT_TRUE(files.contains("y.json"));
    } else if (failure.running && outcome.failed) {
      EXPECT_TRUE(log || partial);
    }
    // A JSON value's destructor needs memory, and must not throw: then the program can only end at once.
    if (failure.running && outcome.err.ends_with("phalanx: out of memory\n")) {
      EXPECT_TRUE(log) << "it ended before its log was finished";
    }
    if (!given_up && !steps.empty()) {
      EXPECT_EQ(steps.back().largest_torque, 0.0);
    }
  }
};

class Simulate : public Command {
 public:
  Simulate() : Command({"simulate", "index_ball", "--seconds", "0.2", "--out", "o", "--poses", "--plot"}) {}

 private:
  void expect_promises(const TemporaryFolder& /*folder*/, const Failure& /*failure*/, const Outcome& outcome,
                       const Files& files) const override {
    expect_no_partial_file(files);
    for (const auto& [name, content] : files) {
      if (name != "o/summary.json") {
        EXPECT_EQ(content, whole().at(name)) << name;
      }
    }
    if (outcome.exit == 0) {
      EXPECT_TRUE(files.contains("o/summary.json"));
    }
    if (files.contains("o/summary.json")) {  // it is written last: then the others are there, too
      EXPECT_EQ(files.size(), whole().size());
      EXPECT_TRUE(nlohmann::json::accept(files.at("o/summary.json")));
    }
  }
};

class Study : public Command {
 public:
  /// @param begun  of two points the journal has the first one; else there is one point, and no journal
  explicit Study(bool begun)
      : Command({"study", "s.toml", "--out", "o", "--jobs", "1"}), points_(begun ? "[0, 1]" : "[0]") {
    if (!begun) return;
    const TemporaryFolder folder;
    prepare(folder);
    static_cast<void>(program().run(folder));
    const std::string journal = files_in(folder).at(kJournal);
    begun_ = journal.substr(0, journal.find('\n', journal.find('\n') + 1) + 1);
  }

 private:
  static constexpr const char* kJournal = "o/points.jsonl";

  void prepare(const TemporaryFolder& folder) const override {
    std::ofstream(folder / "s.toml") << "scene = \"index_ball\"\nseeds = 1\n"
                                        "[set]\n\"hand.meshes\" = \"capsules\"\n"
                                        "[[axis]]\nkey = \"device.scale.sheath_friction\"\nvalues = "
                                     << points_ << "\n";
    if (begun_.empty()) return;
    std::filesystem::create_directory(folder / "o");
    std::ofstream(folder / kJournal) << begun_;
  }

  void expect_promises(const TemporaryFolder& folder, const Failure& /*failure*/, const Outcome& outcome,
                       const Files& files) const override {
    expect_no_partial_file(files);
    const auto found = files.find(kJournal);
    const std::string journal = found != files.end() ? found->second : "";
    EXPECT_THAT(journal, StartsWith(begun_));
    EXPECT_THAT(whole().at(kJournal), StartsWith(journal));
    if (outcome.exit == 0 || files.contains("o/summary.json")) expect_results(files);
    const bool has_points = journal.find('\n') + 1 < journal.size();
    if (outcome.exit == 0 || journal.empty() || !has_points) return;
    const Outcome again = program().run(folder);  // the same command goes on where it stopped
    EXPECT_EQ(again.exit, 0) << again.err;
    expect_results(files_in(folder));
  }
  void expect_results(const Files& files) const {
    for (const auto& [name, content] : whole()) {
      ASSERT_TRUE(files.contains(name)) << name;
      if (name == kJournal || name == "o/study.csv") {
        EXPECT_EQ(files.at(name), content) << name;
      }
    }
  }

  const std::string points_;
  std::string begun_;
};

const std::vector<const char*> kCommands{"simulate", "run", "study", "study_begun"};

std::unique_ptr<Command> make(const std::string& name) {
  if (name == "run") return std::make_unique<Run>();
  if (name == "simulate") return std::make_unique<Simulate>();
  return std::make_unique<Study>(name == "study_begun");
}

/// Shuffled, so that the first of them are of as many different kinds as there are.
std::vector<Failure> by_kind_in_turn(std::vector<Failure> failures) {
  std::mt19937 random(kSeed);
  std::ranges::shuffle(failures, random);
  std::map<std::tuple<test::FailingCall, bool, bool>, std::size_t> count;
  std::vector<std::pair<std::size_t, Failure>> turns;
  for (const Failure& failure : failures)
    turns.emplace_back(count[{failure.call, failure.running, failure.child}]++, failure);
  std::ranges::stable_sort(turns, {}, &std::pair<std::size_t, Failure>::first);
  std::vector<Failure> result;
  for (const auto& [turn, failure] : turns) result.push_back(failure);
  return result;
}

/// Checks the first `wanted` failures. A call is not made where the program's threads run in another order than when
/// it was recorded, as on a busy computer; then the next one of its kind takes its place, up to three times.
void check_some(const Command& command, const std::vector<Failure>& failures, std::size_t wanted) {
  ASSERT_FALSE(failures.empty());
  const auto kind = [](const Failure& failure) {
    return std::tuple(failure.call, failure.running, failure.child);
  };
  std::size_t tried = 0;
  for (std::size_t i = 0; i < std::min(wanted, failures.size()); ++i) {
    bool made = false;
    int left = 4;
    for (std::size_t n = i; n < failures.size() && left > 0 && !made; ++n) {
      if (kind(failures[n]) != kind(failures[i])) continue;
      made = command.check(failures[n]);
      if (::testing::Test::HasFatalFailure()) return;
      ++tried;
      --left;
    }
    EXPECT_TRUE(made) << "kind " << i << ": no call of four has a call stack that was recorded";
  }
  std::printf("%zu calls for %zu failures; seed %u\n", tried, wanted, kSeed);
}

/// Most calls that fail must be those that were meant: threads may come to another one first.
void check_all(const Command& command, const std::vector<Failure>& failures) {
  std::size_t failed = 0;
  for (const Failure& failure : failures) {
    if (command.check(failure)) ++failed;
    if (::testing::Test::HasFatalFailure()) return;
  }
  std::printf("%zu calls, of which %zu failed; seed %u\n", failures.size(), failed, kSeed);
  EXPECT_GE(10 * failed, 9 * failures.size()) << "their call stacks are other ones than were recorded";
}

class InjectedFailures : public ::testing::TestWithParam<const char*> {};

TEST_P(InjectedFailures, OfASampleLoseNothingThatWasPromised) {
  constexpr std::size_t kSample = 5;
  const auto command = make(GetParam());
  std::vector<Failure> failures = by_kind_in_turn(command->record());
  ASSERT_GT(failures.size(), 1000U);
  if (const char* wanted = std::getenv("PHALANX_FAILING_STACK")) {
    const std::uint64_t stack = std::strtoull(wanted, nullptr, 16);
    std::erase_if(failures, [&](const Failure& failure) { return failure.stack != stack; });
  }
  check_some(*command, failures, kSample);
}
INSTANTIATE_TEST_SUITE_P(Of, InjectedFailures, ::testing::ValuesIn(kCommands),
                         [](const auto& command) { return std::string(command.param); });

// An exception that a destructor or a thread lets out; here in the middle of a press.
TEST(TerminatedRun, EndsAtZeroTorqueAndKeepsItsLog) {
  const FailingProgram program({"run", "index_ball", "--headless", "--no-realtime", "--rate-hz", "200",
                                "--seconds", "4", "--log", "x.csv"},
                               "phalanx-record", "");
  const TemporaryFolder folder;
  const Outcome outcome = program.terminate(folder, 1.5);
  EXPECT_EQ(outcome.exit, 128 + SIGABRT);
  EXPECT_THAT(outcome.err, HasSubstr("phalanx: ended by an error of the program\n"));
  const std::vector<LoggedStep> steps = read_steps(folder / "x.csv.partial");
  ASSERT_GT(static_cast<double>(steps.size()), 1.5 * RunningStation::kRate);
  EXPECT_TRUE(std::ranges::any_of(steps, [](const LoggedStep& s) { return s.largest_torque > 0.1; }))
      << "it never pushed";
  EXPECT_EQ(steps.back().largest_torque, 0.0);
  EXPECT_EQ(steps.back().state, "stopped");
}

TEST(TerminatedRun, LetsGoWhileStandardErrorTakesNothing) {
  const FailingProgram program({"run", "index_ball", "--headless", "--no-realtime", "--rate-hz", "200",
                                "--seconds", "4", "--log", "x.csv"},
                               "phalanx-record", "");
  const TemporaryFolder folder;
  constexpr double kReads = 5.5;
  const Outcome outcome = program.terminate(folder, 1.5, kReads);
  EXPECT_EQ(outcome.exit, 128 + SIGABRT);
  EXPECT_THAT(outcome.err, HasSubstr("phalanx: ended by an error of the program\n"));
  const std::vector<LoggedStep> steps = read_steps(folder / "x.csv.partial");
  EXPECT_TRUE(std::ranges::any_of(steps, [](const LoggedStep& s) { return s.largest_torque > 0.1; }))
      << "it never pushed";
  const auto stopped = std::ranges::find(steps, "stopped", &LoggedStep::state);
  ASSERT_NE(stopped, steps.end());
  EXPECT_LT(stopped->time, kReads - 1.0);
  EXPECT_EQ(steps.back().largest_torque, 0.0);
}

/// Parts that run side by side: those failures whose call stack's hash, divided by the number of parts, leaves
/// this remainder.
constexpr std::size_t kParts = 8;
using Part = std::tuple<std::size_t, std::size_t>;  // number of the command, remainder

void check_part(const Part& of, std::size_t parts) {
  const auto [number, part] = of;
  std::set<std::uint64_t> known;  // of the commands before it, such as their arguments' parser
  for (std::size_t i = 0; i < number; ++i)
    for (const Failure& failure : make(kCommands[i])->record()) known.insert(failure.stack);
  const auto command = make(kCommands[number]);
  std::vector<Failure> mine;
  for (const Failure& failure : command->record()) {
    if (!known.contains(failure.stack) && failure.stack % parts == part) mine.push_back(failure);
  }
  ASSERT_FALSE(mine.empty());
  check_all(*command, mine);
}

class EveryThirtiethInjectedFailure : public ::testing::TestWithParam<Part> {};
TEST_P(EveryThirtiethInjectedFailure, LosesNothingThatWasPromised) { check_part(GetParam(), 30); }
INSTANTIATE_TEST_SUITE_P(Of, EveryThirtiethInjectedFailure,
                         ::testing::Combine(::testing::Range<std::size_t>(0, kCommands.size()),
                                            ::testing::Values<std::size_t>(0)));

class SoakInjectedFailures : public ::testing::TestWithParam<Part> {};
TEST_P(SoakInjectedFailures, LoseNothingThatWasPromised) { check_part(GetParam(), kParts); }
INSTANTIATE_TEST_SUITE_P(Of, SoakInjectedFailures,
                         ::testing::Combine(::testing::Range<std::size_t>(0, kCommands.size()),
                                            ::testing::Range<std::size_t>(0, kParts)));

}  // namespace
}  // namespace phalanx::testing
