// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <hdf5.h>

#include <array>
#include <cerrno>
#include <memory>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "record/export/export_table.h"

namespace phalanx {
namespace {

constexpr std::size_t kRowsInChunk = 1024;
constexpr unsigned kDeflate = 4;  ///< level of compression

[[noreturn]] void refused(const std::filesystem::path& file) {
  const int why = errno;
  throw std::runtime_error(fmt::format("{}: cannot be written ({})", file.string(),
                                       why == 0 ? "refused by HDF5" : std::generic_category().message(why)));
}

/// An open object of the HDF5 library.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close, const std::filesystem::path& file) : id_(id), close_(close) {
    if (id < 0) refused(file);
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  [[nodiscard]] hid_t id() const noexcept { return id_; }
  /// @returns false if the library could not write what it still held
  [[nodiscard]] bool closed() noexcept { return close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_;
  Close close_;
};

void check(herr_t result, const std::filesystem::path& file) {
  if (result < 0) refused(file);
}

Handle text_type(const std::filesystem::path& file) {
  Handle type(::H5Tcopy(H5T_C_S1), ::H5Tclose, file);
  check(::H5Tset_size(type.id(), H5T_VARIABLE), file);
  check(::H5Tset_cset(type.id(), H5T_CSET_UTF8), file);
  return type;
}

void put_attribute(hid_t object, const char* name, const std::string& value,
                   const std::filesystem::path& file) {
  const Handle type = text_type(file);
  const Handle space(::H5Screate(H5S_SCALAR), ::H5Sclose, file);
  const Handle attribute(::H5Acreate2(object, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
                         ::H5Aclose, file);
  const char* text = value.c_str();
  check(::H5Awrite(attribute.id(), type.id(), &text), file);
}

void put_attribute(hid_t object, const char* name, const std::vector<std::string>& values,
                   const std::filesystem::path& file) {
  const Handle type = text_type(file);
  const hsize_t size = values.size();
  const Handle space(::H5Screate_simple(1, &size, nullptr), ::H5Sclose, file);
  const Handle attribute(::H5Acreate2(object, name, type.id(), space.id(), H5P_DEFAULT, H5P_DEFAULT),
                         ::H5Aclose, file);
  std::vector<const char*> texts;
  for (const std::string& value : values) texts.push_back(value.c_str());
  check(::H5Awrite(attribute.id(), type.id(), texts.data()), file);
}

/// A data set that grows row by row: of one number or text a row, or of one number for each label.
class GrowingDataSet {
 public:
  GrowingDataSet(hid_t group, const ExportColumn& column, const std::filesystem::path& file)
      : file_(file),
        width_(column.width()),
        block_(!column.labels.empty()),
        type_(column.is_text ? text_type(file) : Handle(::H5Tcopy(H5T_NATIVE_DOUBLE), ::H5Tclose, file)),
        set_(create(group, column)) {
    if (!column.unit.empty()) put_attribute(set_.id(), "unit", column.unit, file);
    if (block_) put_attribute(set_.id(), "columns", column.labels, file);
  }

  void add(double value) { numbers_.push_back(value); }
  void add(const std::string& value) { texts_.push_back(value); }
  void write() {
    const hsize_t rows = texts_.empty() ? numbers_.size() / width_ : texts_.size();
    if (rows == 0) return;
    const std::array<hsize_t, 2> size = {rows_ + rows, width_};
    const std::array<hsize_t, 2> begin = {rows_, 0};
    const std::array<hsize_t, 2> part = {rows, width_};
    const int rank = block_ ? 2 : 1;
    errno = 0;
    check(::H5Dset_extent(set_.id(), size.data()), file_);
    const Handle to(::H5Dget_space(set_.id()), ::H5Sclose, file_);
    check(::H5Sselect_hyperslab(to.id(), H5S_SELECT_SET, begin.data(), nullptr, part.data(), nullptr), file_);
    const Handle from(::H5Screate_simple(rank, part.data(), nullptr), ::H5Sclose, file_);
    std::vector<const char*> texts;
    for (const std::string& text : texts_) texts.push_back(text.c_str());
    const void* values = texts_.empty() ? static_cast<const void*>(numbers_.data()) : texts.data();
    check(::H5Dwrite(set_.id(), type_.id(), from.id(), to.id(), H5P_DEFAULT, values), file_);
    rows_ += rows;
    numbers_.clear();
    texts_.clear();
  }

 private:
  [[nodiscard]] Handle create(hid_t group, const ExportColumn& column) const {
    const int rank = block_ ? 2 : 1;
    const std::array<hsize_t, 2> size = {0, width_};
    const std::array<hsize_t, 2> most = {H5S_UNLIMITED, width_};
    const std::array<hsize_t, 2> chunk = {kRowsInChunk, width_};
    const Handle space(::H5Screate_simple(rank, size.data(), most.data()), ::H5Sclose, file_);
    const Handle properties(::H5Pcreate(H5P_DATASET_CREATE), ::H5Pclose, file_);
    check(::H5Pset_chunk(properties.id(), rank, chunk.data()), file_);
    check(::H5Pset_shuffle(properties.id()), file_);
    check(::H5Pset_deflate(properties.id(), kDeflate), file_);
    return {::H5Dcreate2(group, column.name.c_str(), type_.id(), space.id(), H5P_DEFAULT, properties.id(),
                         H5P_DEFAULT),
            ::H5Dclose, file_};
  }

  const std::filesystem::path& file_;
  const std::size_t width_;
  const bool block_;
  const Handle type_;
  const Handle set_;
  hsize_t rows_ = 0;  ///< written
  std::vector<double> numbers_;
  std::vector<std::string> texts_;
};

class Hdf5Table final : public TableWriter {
 public:
  Hdf5Table(hid_t hdf5, const ExportTable& table, const std::filesystem::path& file)
      : table_(table),
        file_(file),
        group_(::H5Gcreate2(hdf5, table.name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), ::H5Gclose,
               file) {
    put_attribute(group_.id(), "description", table.meaning, file);
    for (const ExportColumn& column : table.columns)
      sets_.push_back(std::make_unique<GrowingDataSet>(group_.id(), column, file));
  }

  void add(const ExportRow& row) override {
    auto number = row.numbers.begin();
    auto text = row.texts.begin();
    for (std::size_t c = 0; c < sets_.size(); ++c)
      for (std::size_t i = 0; i < table_.columns[c].width(); ++i)
        if (table_.columns[c].is_text) {
          sets_[c]->add(*text++);
        } else {
          sets_[c]->add(*number++);
        }
    if (++rows_ % kRowsInChunk == 0) write();
  }
  ExportedPart finish() override {
    write();
    return {.file = file_, .part = table_.name, .rows = rows_};
  }

 private:
  void write() {
    for (const auto& set : sets_) set->write();
  }

  const ExportTable& table_;
  const std::filesystem::path& file_;
  const Handle group_;
  std::vector<std::unique_ptr<GrowingDataSet>> sets_;
  std::uint64_t rows_ = 0;
};

class Hdf5Format final : public TableFormat {
 public:
  Hdf5Format(const std::filesystem::path& file, const ExportOrigin& origin)
      : file_(file), hdf5_(create(file), ::H5Fclose, file) {
    put_attribute(hdf5_.id(), "recording", origin.name, file);
    put_attribute(hdf5_.id(), "recorded_by", "phalanx " + origin.version, file);
    put_attribute(hdf5_.id(), "begin_utc_ns", std::to_string(origin.begin_utc), file);
  }
  std::unique_ptr<TableWriter> begin(const ExportTable& table) override {
    return std::make_unique<Hdf5Table>(hdf5_.id(), table, file_);
  }
  void finish() override {
    errno = 0;
    check(::H5Fflush(hdf5_.id(), H5F_SCOPE_GLOBAL), file_);
    if (!hdf5_.closed()) refused(file_);
  }

 private:
  static hid_t create(const std::filesystem::path& file) {
    ::H5dont_atexit();  // after a failed write, the library's own end would crash the program
    ::H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // no messages of the library on the terminal
    const Handle access(::H5Pcreate(H5P_FILE_ACCESS), ::H5Pclose, file);
    check(::H5Pset_file_locking(access.id(), false, true), file);  // write_then_rename() holds the lock
    errno = 0;
    return ::H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id());
  }

  const std::filesystem::path file_;
  Handle hdf5_;
};

}  // namespace

std::unique_ptr<TableFormat> hdf5_format(const std::filesystem::path& file, const ExportOrigin& origin) {
  return std::make_unique<Hdf5Format>(file, origin);
}

}  // namespace phalanx
