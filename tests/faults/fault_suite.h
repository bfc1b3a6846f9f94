// SPDX-License-Identifier: Apache-2.0
// The scenarios of all tests of this program run side by side before the first test begins;
// a test looks at what its own has left.
#pragma once

#include <string>

#include "faults/two_processes.h"

namespace phalanx::testing {

/// Adds a scenario, as a static object beside the test that uses it. It runs if the test `test` is to run.
class Registered {
 public:
  Registered(const std::string& test, const std::string& variant, Scenario scenario);
};

/// A line typed at the host's terminal, at a time of the controller's process [s].
[[nodiscard]] Event type_at(double at, const std::string& line);

/// What the scenario has left. @throws std::runtime_error with its problem if it did not come to its end
[[nodiscard]] const Outcome& outcome(const std::string& test, const std::string& variant = {});

/// One line of the table in docs/safety.md: "| fault | required | seen |"; scripts/safety_table.sh gathers
/// them.
void print_row(const std::string& fault, const std::string& required, const std::string& seen);

}  // namespace phalanx::testing
