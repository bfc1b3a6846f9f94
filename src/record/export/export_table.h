// SPDX-License-Identifier: Apache-2.0
// The tables that a recording becomes, whatever file format they are written in.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "phalanx/record/export_recording.h"

namespace phalanx {

/// Columns of a table that have one unit: one, or one for each label.
struct ExportColumn {
  std::string name;                      ///< "torque"
  std::string unit = {};                 ///< "Nm"; empty: none
  std::vector<std::string> labels = {};  ///< "index_pip_flexion"; empty: a single column
  bool is_text = false;

  [[nodiscard]] std::size_t width() const noexcept { return labels.empty() ? 1 : labels.size(); }
  /// @returns the column's name with unit and label: "torque_nm_index_pip_flexion"
  [[nodiscard]] std::string full_name(std::size_t i) const;
};

/// Form of a table.
struct ExportTable {
  std::string name;     ///< "steps"
  std::string meaning;  ///< one line
  std::vector<ExportColumn> columns;
  bool if_named =
      false;  ///< is written only if ExportOptions::parts names it: each of its rows is computed again
};

/// @returns the name of a segment with underscores: "index_finger_tip"
[[nodiscard]] std::string segment_label(int segment);

/// @returns all tables. A row has its values in this order of columns
[[nodiscard]] const std::vector<ExportTable>& export_tables();

/// One row. Numbers that do not exist are NaN.
struct ExportRow {
  std::vector<double> numbers;     ///< of all columns that are no text, in their order
  std::vector<std::string> texts;  ///< of the others

  void clear() noexcept {
    numbers.clear();
    texts.clear();
  }
};

/// Writes the rows of one table in a file format.
class TableWriter {
 public:
  TableWriter() = default;
  TableWriter(const TableWriter&) = delete;
  TableWriter& operator=(const TableWriter&) = delete;
  virtual ~TableWriter() = default;

  virtual void add(const ExportRow& row) = 0;
  /// Writes what is left; no rows come any more
  virtual ExportedPart finish() = 0;
};

/// Makes the writers of a file format.
class TableFormat {
 public:
  TableFormat() = default;
  TableFormat(const TableFormat&) = delete;
  TableFormat& operator=(const TableFormat&) = delete;
  virtual ~TableFormat() = default;

  /// @param table  outlives the writer
  [[nodiscard]] virtual std::unique_ptr<TableWriter> begin(const ExportTable& table) = 0;
  /// Ends the file, after all writers have finished.
  virtual void finish() {}
};

/// Where a recording comes from, for files that state it.
struct ExportOrigin {
  std::string name;             ///< of the recording's file
  std::string version;          ///< of the program that recorded it
  std::uint64_t begin_utc = 0;  ///< of its first message [ns since 1970]
};

/// Reads a recording and hands its rows to a format of the caller's own.
/// @param options  of kCsv: parts, columns, from and to
/// @param on_progress, keys  as export_recording()
/// @throws as export_recording(), and what `format` throws
std::vector<ExportedPart> read_tables(const std::filesystem::path& recording,
                                      std::unique_ptr<TableFormat> format, const ExportOptions& options,
                                      const std::function<void(double)>& on_progress,
                                      const FindRecordingKey& keys);

[[nodiscard]] std::unique_ptr<TableFormat> csv_format(const std::filesystem::path& folder);
[[nodiscard]] std::unique_ptr<TableFormat> hdf5_format(const std::filesystem::path& file,
                                                       const ExportOrigin& origin);
[[nodiscard]] std::unique_ptr<TableFormat> matlab_format(const std::filesystem::path& file,
                                                         const ExportOrigin& origin);

}  // namespace phalanx
