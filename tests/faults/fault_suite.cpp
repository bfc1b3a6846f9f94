// SPDX-License-Identifier: Apache-2.0
#include "faults/fault_suite.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <map>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

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

void run(Entry& entry) {
  try {
    entry.outcome = TwoProcesses(entry.scenario).go();
  } catch (const std::exception& error) {
    entry.outcome.problem = error.what();
  }
}

std::size_t at_once() { return std::max(2U, std::thread::hardware_concurrency()); }

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
