// SPDX-License-Identifier: Apache-2.0
// The rows of the conformance test. docs/conform.md has the same table; a test compares them.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace phalanx {

class ConformHost;

enum class ConformOutcome { kPass, kFail, kNotApplicable };

/// Finding of one row.
struct ConformFinding {
  ConformOutcome outcome = ConformOutcome::kPass;
  std::string observed;  ///< figures; for kNotApplicable the reason
};

/// One requirement of docs/link.md and its test.
struct ConformRow {
  std::string_view id;
  std::string_view section;  ///< of docs/link.md
  std::string_view requirement;
  std::string_view stimulus;
  std::string_view expected;
  ConformFinding (*check)(ConformHost& host);
};

/// @returns all rows, in the order in which they are tested.
[[nodiscard]] std::span<const ConformRow> conform_rows();

/// @returns the rows as a table in Markdown.
[[nodiscard]] std::string conform_table();

}  // namespace phalanx
