// SPDX-License-Identifier: Apache-2.0
// What `phalanx patient` prints about patients, results and tests.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/registry/patient.h"
#include "phalanx/registry/result.h"

namespace phalanx {

/// Replaces control characters by blanks: a stored text must not control the terminal.
[[nodiscard]] std::string printable(std::string_view text);

/// Describes all fields but the entry check, a line each.
[[nodiscard]] std::string patient_text(const Patient& patient, const std::string& today);

/// Describes the entry checks, a line each with its origin: the newest one that was measured, and that of the
/// patient's fields if it was entered by hand.
[[nodiscard]] std::string entry_checks_text(const Patient& patient, std::span<const ResultRow> results);

/// Describes one result: a line for it, and one for each score with its origin, or with the reason why it
/// has no value.
[[nodiscard]] std::string result_text(const ResultRow& row);

/// Describes one entered test in a line.
[[nodiscard]] std::string test_text(const EnteredTest& test);

}  // namespace phalanx
