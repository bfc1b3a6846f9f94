// SPDX-License-Identifier: Apache-2.0
// The registry's audit log: one line for each read and change of a patient, chained by SHA-256.
#pragma once

#include <cstdint>
#include <string>

namespace phalanx {

/// One line of the audit log. It never holds a code.
///
/// File `audit.jsonl`: one JSON object a line; `before` is the SHA-256 of the line before it without '\n', 64
/// zeros in the first. The head (number and hash of the newest line) is also kept beside the key file,
/// outside the data folder.
struct AuditEntry {
  std::uint64_t n = 0;  ///< from 1
  std::string time;     ///< UTC, "2026-05-04T09:30:00Z"
  std::string account;
  std::string
      action;  ///< "list", "show", "add", "edit", "delete", "add_result", "export", "sign_in_failed", ...
  std::string record;  ///< record id; "*": all patients; empty: no patient
  std::string detail;  ///< of restore: what is missing; of a change of accounts: the account; else empty
};

/// Result of the check of the audit log.
struct AuditCheck {
  bool whole = false;
  std::uint64_t lines = 0;         ///< that were read
  std::uint64_t first_broken = 0;  ///< number of the first line that is missing or changed; 0: none
  std::string text;                ///< for people, with the remedy
};

}  // namespace phalanx
