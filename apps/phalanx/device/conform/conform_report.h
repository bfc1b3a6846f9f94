// SPDX-License-Identifier: Apache-2.0
// A conformance test and its report: for the terminal, and as Markdown, HTML and JSON.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "device/conform/conform_host.h"
#include "device/conform/conform_row.h"

namespace phalanx {

/// A row with its finding.
struct ConformResult {
  const ConformRow* row = nullptr;
  ConformFinding finding;
};

/// Findings of all rows.
struct ConformReport {
  std::string address;
  std::string device;   ///< serial number, rate, channels; empty: none answered
  std::string program;  ///< version and commit of this program
  std::string date;     ///< day and time; empty in a report that is compared
  double torque = 0.0;  ///< largest torque that was commanded [Nm]
  double seconds = 0.0;
  std::vector<ConformResult> results;

  [[nodiscard]] int count(ConformOutcome outcome) const;
  /// @returns true if no row failed.
  [[nodiscard]] bool conforms() const { return count(ConformOutcome::kFail) == 0; }
  /// @returns the verdict in one sentence.
  [[nodiscard]] std::string verdict() const;
};

/// Tests all rows, and leaves the device without a session, also if an exception ends the test. A row that
/// cannot be tested to its end has failed.
/// @param on_result  called with each result
/// @throws what the port throws
[[nodiscard]] ConformReport run_conformance(ConformPort& port, const ConformSettings& settings,
                                            const std::function<void(const ConformResult&)>& on_result = {});

/// Names an outcome: "pass", "FAIL", "not applicable".
[[nodiscard]] std::string_view conform_outcome_name(ConformOutcome outcome);
[[nodiscard]] std::string conform_markdown(const ConformReport& report);
[[nodiscard]] std::string conform_html(const ConformReport& report);
[[nodiscard]] std::string conform_json(const ConformReport& report);

}  // namespace phalanx
