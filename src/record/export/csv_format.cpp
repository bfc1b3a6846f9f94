// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>

#include "phalanx/record/output_file.h"
#include "record/export/export_table.h"

namespace phalanx {
namespace {

/// A table in a CSV file: a first line with the columns' names and units, texts in quotes, and empty fields for numbers that
/// do not exist.
class CsvTable final : public TableWriter {
 public:
  CsvTable(const std::filesystem::path& folder, const ExportTable& table)
      : table_(table), file_(folder / (table.name + ".csv")), out_(file_) {
    std::string head;
    for (const ExportColumn& column : table.columns)
      for (std::size_t i = 0; i < column.width(); ++i)
        head.append(head.empty() ? "" : ",").append(column.full_name(i));
    out_.text(head + "\n");
  }

  void add(const ExportRow& row) override {
    auto number = row.numbers.begin();
    auto text = row.texts.begin();
    bool first = true;
    for (const ExportColumn& column : table_.columns)
      for (std::size_t i = 0; i < column.width(); ++i) {
        if (!first) out_.text(",");
        first = false;
        if (column.is_text) {
          out_.text(quoted(*text++));
        } else {
          if (!std::isnan(*number)) out_.number(*number);
          ++number;
        }
      }
    out_.text("\n");
    ++rows_;
  }
  ExportedPart finish() override {
    out_.commit();
    return {.file = file_, .part = table_.name, .rows = rows_};
  }

 private:
  static std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
  }

  const ExportTable& table_;
  const std::filesystem::path file_;
  OutputFile out_;
  std::uint64_t rows_ = 0;
};

class CsvFormat final : public TableFormat {
 public:
  explicit CsvFormat(std::filesystem::path folder) : folder_(std::move(folder)) {}
  std::unique_ptr<TableWriter> begin(const ExportTable& table) override {
    return std::make_unique<CsvTable>(folder_, table);
  }

 private:
  const std::filesystem::path folder_;
};

}  // namespace

std::unique_ptr<TableFormat> csv_format(const std::filesystem::path& folder) {
  return std::make_unique<CsvFormat>(folder);
}

}  // namespace phalanx
