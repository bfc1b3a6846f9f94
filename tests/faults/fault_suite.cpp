// SPDX-License-Identifier: Apache-2.0
#include "faults/fault_suite.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "faults/reactions.h"

namespace phalanx::testing {
namespace {

struct Entry {
  std::string test;
  Scenario scenario;
  Outcome outcome;
};

/// By "test/variant".
std::map<std::string, Entry>& entries() {
  static std::map<std::string, Entry> all;
  return all;
}

bool is_to_run(const std::string& name) {
  const ::testing::UnitTest& all = *::testing::UnitTest::GetInstance();
  for (int s = 0; s < all.total_test_suite_count(); ++s) {
    const ::testing::TestSuite& suite = *all.GetTestSuite(s);
    for (int t = 0; t < suite.total_test_count(); ++t) {
      const ::testing::TestInfo& test = *suite.GetTestInfo(t);
      if (test.name() == name && test.should_run()) return true;
    }
  }
  return false;
}

/// The patient closes his hand in the first half second. A host that comes later finds his fingers in the
/// object already, where they feel nothing until they have left it: there would be no contact to disturb.
bool joined_in_time(const Outcome& outcome) {
  constexpr std::int64_t kClosing = 350000;
  const ControllerRows& rows = outcome.logs.controller;
  const std::size_t start =
      first_row(rows, 0, [](const ControllerRow& row) { return row.state == "starting"; });
  return start < rows.size() && rows[start].time_us <= kClosing;
}

/// Whether no busy machine has come between: of the faults of what comes late, only those that the scenario
/// makes.
bool is_undisturbed(const Entry& entry) {
  const std::vector<std::string>& own = entry.scenario.late;
  return std::ranges::none_of(entry.outcome.faults, [&](const std::string& fault) {
    const bool late = fault == "no_sample" || fault == "step_too_old" || fault == "overload";
    return late && std::ranges::find(own, fault) == own.end();
  });
}

/// What this busy machine has disturbed gets another chance.
void run(Entry& entry) {
  constexpr int kTries = 3;
  try {
    for (int i = 0; i < kTries; ++i) {
      entry.outcome = TwoProcesses(entry.scenario).go();
      if (joined_in_time(entry.outcome) && is_undisturbed(entry)) return;
      fmt::print("{}: a busy machine came between, which {}\n", entry.test,
                 joined_in_time(entry.outcome) ? fmt::format("made {}", fmt::join(entry.outcome.faults, ", "))
                                               : std::string("let the host join too late"));
    }
    if (!joined_in_time(entry.outcome))
      entry.outcome.problem = "this machine is too busy: the host never joined before the patient's squeeze";
  } catch (const std::exception& error) {
    entry.outcome.problem = error.what();
  }
}

std::size_t at_once() {
  const char* given = std::getenv("PHALANX_FAULTS_AT_ONCE");
  return given != nullptr ? std::stoul(given) : 6;
}

class AllScenarios : public ::testing::Environment {
 public:
  void SetUp() override {
    std::signal(SIGPIPE, SIG_IGN);  // a line typed to a process that has ended
    std::vector<Entry*> waiting;
    for (auto& [name, entry] : entries())
      if (is_to_run(entry.test)) waiting.push_back(&entry);
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t i = next++; i < waiting.size(); i = next++) run(*waiting[i]);
    };
    std::vector<std::thread> workers;
    for (std::size_t i = 0; i < std::min(at_once(), waiting.size()); ++i) workers.emplace_back(work);
    for (std::thread& worker : workers) worker.join();
  }
};

// GoogleTest owns it.
const ::testing::Environment* const kAllScenarios = ::testing::AddGlobalTestEnvironment(new AllScenarios);

std::string key(const std::string& test, const std::string& variant) { return test + "/" + variant; }

}  // namespace

Registered::Registered(const std::string& test, const std::string& variant, Scenario scenario) {
  entries()[key(test, variant)] = {.test = test, .scenario = std::move(scenario), .outcome = {}};
}

Event type_at(double at, const std::string& line) {
  return {at, [line](TwoProcesses& both) { both.host().type(line); }};
}

const Outcome& outcome(const std::string& test, const std::string& variant) {
  const Outcome& result = entries().at(key(test, variant)).outcome;
  if (!result.problem.empty()) throw std::runtime_error(result.problem);
  return result;
}

void print_row(const std::string& fault, const std::string& required, const std::string& seen) {
  fmt::print("| {} | {} | {} |\n", fault, required, seen);
  std::fflush(stdout);
}

}  // namespace phalanx::testing
