// SPDX-License-Identifier: Apache-2.0
// Reports of backup, restore, rebuild, deletion and export.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "phalanx/record/recording_keys.h"
#include "phalanx/registry/result.h"

namespace phalanx {

/// Function that reads the results of one recording, in the order of their numbers. The part of the recorded
/// exercises supplies it. It asks the given function for the key by the id that the file states. It throws
/// std::exception for a file that it cannot read.
using RecordedResultsOf = std::function<std::vector<ResultRow>(const std::filesystem::path& recording,
                                                               const FindRecordingKey& keys)>;

/// Result of Registry::rebuild().
struct RebuildReport {
  std::size_t patients = 0;
  std::size_t results = 0;  ///< rows after it
  std::size_t tests = 0;
  std::size_t notes = 0;
  std::size_t added = 0;    ///< rows of recordings that the registry did not have
  std::size_t changed = 0;  ///< rows that equal their encrypted recording only now
  std::vector<std::string>
      kept_without_file;            ///< "RECORDING NUMBER": rows whose recording is missing; they are kept
  std::vector<std::string> differ;  ///< rows that differ from a plain recording; they are kept as they were
  std::vector<std::string> not_assigned;  ///< recordings that no living patient owns, with the reason
  std::vector<std::string> unreadable;    ///< recordings that could not be read, with the reason
  std::vector<std::string> without_key;  ///< record ids whose key is missing; their data are kept as they are
  std::uint64_t damaged_events = 0;  ///< of journals; the database's rows replaced them as far as it had them
};

/// Result of Registry::backup().
struct BackupReport {
  std::filesystem::path
      folder;  ///< the backup: database, journal, accounts, audit log and a manifest with hashes; no keys
  std::size_t patients = 0;
  std::uint64_t bytes = 0;
};

/// Result of Registry::restore().
struct RestoreReport {
  std::size_t patients = 0;              ///< after it
  std::size_t events_added = 0;          ///< of the journal that were not here
  std::size_t deleted_stay_deleted = 0;  ///< patients of the backup that were deleted since
  std::vector<std::string> without_key;  ///< record ids whose key is not here
  std::uint64_t audit_lines_missing =
      0;  ///< lines of the audit log that neither the folder nor the backup has
  std::vector<std::string> damaged_files = {};  ///< of the backup: missing or changed; they were left out
  bool audit_log_left_out =
      false;  ///< the backup's audit log is neither a part nor a continuation of the one here
  bool accounts_left_out =
      false;  ///< no accounts can be read here, and the backup's cannot be opened with these keys
};

/// Result of Registry::delete_patient().
struct DeleteReport {
  std::string record;
  std::vector<std::filesystem::path> exports_removed;
  std::vector<std::filesystem::path> exports_missing;  ///< moved or copied: a person must remove them
  std::vector<std::string> encrypted_recordings;       ///< file names; unreadable from now on, copies too
  std::vector<std::string> plain_recordings;           ///< file names; a person must remove them
  std::uint64_t unreadable_rows =
      0;  ///< damaged, or without their key: exports and recordings that they named are not listed
};

/// Result of Registry::export_patient(): a JSON file and two tables, mode 0600.
struct ExportReport {
  std::vector<std::filesystem::path> files;
};

/// One file of an export in memory: Registry::export_texts().
struct ExportText {
  std::string name = {};  ///< "patient.json", "results.csv", "tests.csv"
  std::string type = {};  ///< media type
  std::string text = {};  ///< UTF-8
};

}  // namespace phalanx
