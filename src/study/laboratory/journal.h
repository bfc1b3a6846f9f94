// SPDX-License-Identifier: Apache-2.0
// The finished points of a study in a file that stays valid if the program is ended at any time: a header,
// then one line of JSON a point.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// Conditions of comparable results: lines of two journals may be merged only if all of this is equal.
struct JournalHeader {
  Study study;
  std::string inputs;  ///< fingerprint of the points' inputs (check_study())
  std::string commit;  ///< commit of the program
  std::string libm{};  ///< libm_text() of the machines that measured the points; empty: not known, fits any
};

/// Content of a journal.
struct JournalContent {
  JournalHeader header;
  std::vector<PointResult> points;  ///< in the order of the lines; each point once
};

/// @returns "points.jsonl", or "points.2-of-3.jsonl" for a shard.
[[nodiscard]] std::string journal_name(int shard, int of);

/// @returns why the lines of the two may not be merged, in words; empty if they may.
[[nodiscard]] std::string difference(const JournalHeader& journal, const JournalHeader& now);

/// Writes one line, with its end.
[[nodiscard]] std::string result_line(const PointResult& result);
/// Writes header and lines as one text.
[[nodiscard]] std::string journal_text(const JournalContent& content);

/// Reads a journal, without the bytes after the last complete line.
/// @throws std::invalid_argument naming the file, the line and the remedy. It refuses a file that is not a
/// journal, a damaged line, and a point that occurs twice with different results.
[[nodiscard]] JournalContent read_journal(const std::filesystem::path& file);
/// Reads a journal from text. @param file  name for messages
[[nodiscard]] JournalContent parse_journal(std::string text, const std::filesystem::path& file);

/// Replaces `file` with a whole journal. The data is on the disk before the file takes its name, and the name
/// before this returns: after a loss of power, `file` is the whole old or the whole new journal.
/// @throws std::runtime_error naming the file and the system's reason if it cannot be written
void replace_journal(const std::filesystem::path& file, const JournalContent& content);

/// A journal that is being written. It is locked (flock) as long as this object or its process lives, so that
/// two processes cannot write to one journal.
class Journal {
 public:
  /// Creates the file, or continues an existing one: an incomplete last line is cut off.
  /// @param restart  discards any existing content
  /// @throws std::invalid_argument with the remedy if another process holds it or it belongs to another study
  /// @throws std::runtime_error naming the file and the system's reason if it cannot be written
  Journal(std::filesystem::path file, const JournalHeader& header, bool restart);
  /// Creates the file or opens an existing one, and locks it; its content stays until begin().
  explicit Journal(std::filesystem::path file);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Takes up the content as the first constructor does. Once.
  void begin(const JournalHeader& header, bool restart);

  /// @returns the points that it held when it was opened.
  [[nodiscard]] const std::vector<PointResult>& finished() const noexcept { return finished_; }
  /// @returns JournalHeader::libm of those points; empty if there are none.
  [[nodiscard]] const std::string& libm() const noexcept { return libm_; }

  /// Adds one line by a single write and waits until it is on the disk. Thread-safe.
  /// @throws std::runtime_error if that fails; the file then ends with its last complete line.
  void append(const PointResult& result);

 private:
  void refuse_other_than_a_file() const;
  void lock();
  [[nodiscard]] std::string content() const;
  void take_up(const JournalHeader& header);
  void write_line(const std::string& line);
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path file_;
  int descriptor_;
  std::mutex mutex_;
  std::vector<PointResult> finished_;
  std::string libm_;
};

}  // namespace phalanx
