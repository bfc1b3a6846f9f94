// SPDX-License-Identifier: Apache-2.0
// The finished points of a study in a file that survives whatever ends the program: a header, then one line
// of JSON a point.
#pragma once

#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "phalanx/study/laboratory/study.h"

namespace phalanx {

/// What makes results comparable: lines of two journals may be put together only if all of this is the same.
struct JournalHeader {
  Study study;
  std::string inputs;  ///< fingerprint of what the points read (check_study())
  std::string commit;  ///< of the program
};

struct JournalContent {
  JournalHeader header;
  std::vector<PointResult> points;  ///< in the order of the lines; each point once
};

/// "points.jsonl", or "points.2-of-3.jsonl"
[[nodiscard]] std::string journal_name(int shard, int of);

/// Why the lines of the two may not be put together, in words; empty if they may.
[[nodiscard]] std::string difference(const JournalHeader& journal, const JournalHeader& now);

/// One line, with its end.
[[nodiscard]] std::string result_line(const PointResult& result);
/// Header and lines as one text.
[[nodiscard]] std::string journal_text(const JournalContent& content);

/// Reads a journal; what follows the last complete line is left out. @throws std::invalid_argument naming the
/// file, the line and the remedy if it is no journal, if a point stands there twice with different results,
/// or if a line is damaged.
[[nodiscard]] JournalContent read_journal(const std::filesystem::path& file);

/// Puts a whole journal in the place of `file`. It is on the disk before it takes the name, and the name
/// before this returns: after a loss of power `file` is the old journal or the new one, whole.
/// @throws std::runtime_error naming the file and the system's reason if it cannot be written
void replace_journal(const std::filesystem::path& file, const JournalContent& content);

/// A journal that is being written. It is locked (flock) as long as this object or its process lives, so that
/// two processes cannot write to one.
class Journal {
 public:
  /// Creates the file, or takes up the one that is there: an incomplete last line is cut off.
  /// @param restart  what is there is thrown away, whatever it is
  /// @throws std::invalid_argument with the remedy if another process holds it or it belongs to another
  /// study;
  ///         std::runtime_error naming the file and the system's reason if it cannot be written.
  Journal(std::filesystem::path file, const JournalHeader& header, bool restart);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The points that it held when it was opened.
  [[nodiscard]] const std::vector<PointResult>& finished() const noexcept { return finished_; }

  /// Adds one line by a single write and waits until it is on the disk. Thread-safe.
  /// @throws std::runtime_error if that fails; the file then ends with its last complete line.
  void append(const PointResult& result);

 private:
  void refuse_other_than_a_file() const;
  void lock();
  void take_up(const JournalHeader& header);
  void write_line(const std::string& line);
  [[noreturn]] void fail(const char* what) const;

  std::filesystem::path file_;
  int descriptor_;
  std::mutex mutex_;
  std::vector<PointResult> finished_;
};

}  // namespace phalanx
