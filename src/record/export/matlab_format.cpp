// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <matio.h>

#include <array>
#include <boost/locale/encoding_utf.hpp>
#include <filesystem>
#include <fstream>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "record/export/export_table.h"

namespace phalanx {
namespace {

using Variable = std::unique_ptr<matvar_t, decltype(&::Mat_VarFree)>;

/// A variable of version 7 is smaller than 2 GiB, and all are in memory: this is for all tables together.
constexpr std::uint64_t kLargestFile = 2'000'000'000;  ///< [bytes]
constexpr std::uint64_t kCell = 500;                   ///< what a text takes besides its characters [bytes]

Variable checked(matvar_t* variable) {
  if (variable == nullptr) throw std::bad_alloc();
  return {variable, ::Mat_VarFree};
}

Variable matrix(const char* name, std::vector<double> values, std::size_t rows, std::size_t columns) {
  std::array<std::size_t, 2> size = {rows, columns};
  return checked(::Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), values.data(), 0));
}

/// A text in UTF-16, in which MATLAB keeps characters. Those of two units become U+FFFD: readers disagree on their length.
Variable characters(const char* name, const std::string& text) {
  std::u16string units;
  for (const char32_t code : boost::locale::conv::utf_to_utf<char32_t>(text))
    units += code > 0xFFFF ? char16_t{0xFFFD} : static_cast<char16_t>(code);
  std::array<std::size_t, 2> size = {units.empty() ? 0U : 1U, units.size()};
  return checked(::Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UTF16, 2, size.data(), units.data(), 0));
}

Variable cells(const char* name, const std::vector<std::string>& texts) {
  std::array<std::size_t, 2> size = {texts.size(), 1};
  Variable cell = checked(::Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, size.data(), nullptr, 0));
  for (std::size_t i = 0; i < texts.size(); ++i)
    ::Mat_VarSetCell(cell.get(), static_cast<int>(i), characters(nullptr, texts[i]).release());
  return cell;
}

Variable structure(const char* name, std::vector<const char*> fields) {
  const std::array<std::size_t, 2> size = {1, 1};
  fields.push_back(nullptr);
  return checked(::Mat_VarCreateStruct2(name, 2, size.data(), fields.data()));
}

void set(const Variable& structure, const char* field, Variable value) {
  ::Mat_VarSetStructFieldByName(structure.get(), field, 0, value.release());
}

/// The .mat file that the tables are written to.
class MatFile {
 public:
  MatFile(const std::filesystem::path& file, const ExportOrigin& origin)
      : file_(file),
        mat_(::Mat_CreateVer(file.c_str(), fmt::format("Phalanx recording {}", origin.name).c_str(),
                             MAT_FT_MAT5),
             ::Mat_Close) {
    if (!mat_) refused();
  }
  void write(const Variable& variable) {
    if (::Mat_VarWrite(mat_.get(), variable.get(), MAT_COMPRESSION_ZLIB) != 0) refused();
    ++variables_;
  }
  /// Counts what waits in memory. @throws std::invalid_argument if it is more than a file may have
  void reserve(std::uint64_t bytes) {
    bytes_ += bytes;
    if (bytes_ > kLargestFile)
      throw std::invalid_argument(
          "the tables are larger than the 2 GB that are written to a MATLAB file; choose fewer --parts or "
          "--columns, or a shorter time with --from and --to, or --format hdf5, which MATLAB reads with "
          "h5read");
  }
  /// Closes the file. The library does not tell that a disk is full: so the elements that are in the file are counted.
  void close() {
    mat_.reset();
    std::ifstream in(file_, std::ios::binary);
    const std::uint64_t size = std::filesystem::file_size(file_);
    std::uint64_t place = 128;  // behind the head
    std::uint64_t elements = 0;
    for (std::array<std::uint32_t, 2> tag{}; place < size; place += sizeof tag + tag[1], ++elements) {
      in.seekg(static_cast<std::streamoff>(place));
      if (!in.read(reinterpret_cast<char*>(tag.data()), sizeof tag)) refused();
    }
    if (place != size || elements != variables_) refused();
  }
  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }

 private:
  [[noreturn]] void refused() const {
    throw std::runtime_error(fmt::format("{}: cannot be written; is the disk full?", file_.string()));
  }

  const std::filesystem::path file_;
  std::unique_ptr<mat_t, decltype(&::Mat_Close)> mat_;
  std::uint64_t variables_ = 0;
  std::uint64_t bytes_ = 0;
};

/// A table as a struct: a field for each column with a row for each row, and `units` and `columns` with the same fields. It
/// is in memory until it is written.
class MatlabTable final : public TableWriter {
 public:
  MatlabTable(MatFile& mat, const ExportTable& table) : mat_(mat), table_(table) {
    for (const ExportColumn& column : table.columns)
      (column.is_text ? texts_ : numbers_).emplace_back(column);
  }

  void add(const ExportRow& row) override {
    std::size_t n = 0;
    for (auto& column : numbers_)
      for (auto& values : column.numbers) values.push_back(row.numbers[n++]);
    std::size_t t = 0;
    for (auto& column : texts_) column.texts.push_back(row.texts[t++]);
    ++rows_;
    std::uint64_t bytes = row.numbers.size() * sizeof(double);
    for (const std::string& text : row.texts) bytes += kCell + text.size();
    mat_.reserve(bytes);
  }
  ExportedPart finish() override {
    std::vector<const char*> fields;
    std::vector<const char*> with_unit;
    std::vector<const char*> with_labels;
    for (const ExportColumn& column : table_.columns) {
      fields.push_back(column.name.c_str());
      if (!column.unit.empty()) with_unit.push_back(column.name.c_str());
      if (!column.labels.empty()) with_labels.push_back(column.name.c_str());
    }
    fields.push_back("units");
    fields.push_back("columns");
    const Variable table = structure(table_.name.c_str(), fields);
    Variable units = structure("units", with_unit);
    Variable columns = structure("columns", with_labels);
    for (const ExportColumn& column : table_.columns) {
      if (!column.unit.empty()) set(units, column.name.c_str(), characters(nullptr, column.unit));
      if (!column.labels.empty()) set(columns, column.name.c_str(), cells(nullptr, column.labels));
    }
    for (Column& column : numbers_) {
      std::vector<double> all;
      all.reserve(rows_ * column.numbers.size());
      for (std::vector<double>& values : column.numbers) {
        all.insert(all.end(), values.begin(), values.end());
        std::vector<double>().swap(values);
      }
      set(table, column.name, matrix(nullptr, std::move(all), rows_, column.numbers.size()));
    }
    for (const Column& column : texts_) set(table, column.name, cells(nullptr, column.texts));
    set(table, "units", std::move(units));
    set(table, "columns", std::move(columns));
    mat_.write(table);
    return {.file = mat_.file(), .part = table_.name, .rows = rows_};
  }

 private:
  struct Column {
    explicit Column(const ExportColumn& column)
        : name(column.name.c_str()), numbers(column.is_text ? 0 : column.width()) {}
    const char* name;
    std::vector<std::vector<double>> numbers;  ///< for each label
    std::vector<std::string> texts;
  };

  MatFile& mat_;
  const ExportTable& table_;
  std::vector<Column> numbers_;
  std::vector<Column> texts_;
  std::uint64_t rows_ = 0;
};

class MatlabFormat final : public TableFormat {
 public:
  MatlabFormat(const std::filesystem::path& file, const ExportOrigin& origin) : mat_(file, origin) {
    const Variable about = structure("recording", {"name", "recorded_by", "begin_utc"});
    set(about, "name", characters(nullptr, origin.name));
    set(about, "recorded_by", characters(nullptr, "phalanx " + origin.version));
    set(about, "begin_utc", matrix(nullptr, {1e-9 * static_cast<double>(origin.begin_utc)}, 1, 1));
    mat_.write(about);
  }
  std::unique_ptr<TableWriter> begin(const ExportTable& table) override {
    return std::make_unique<MatlabTable>(mat_, table);
  }
  void finish() override { mat_.close(); }

 private:
  MatFile mat_;
};

}  // namespace

std::unique_ptr<TableFormat> matlab_format(const std::filesystem::path& file, const ExportOrigin& origin) {
  return std::make_unique<MatlabFormat>(file, origin);
}

}  // namespace phalanx
