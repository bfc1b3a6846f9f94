// SPDX-License-Identifier: Apache-2.0
// Reading recordings: tables as arrays, the motion, and the replay.
#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "phalanx/record/recordings.h"
#include "phalanx/record/replay.h"
#include "phalanx/registry/key_store.h"
#include "record/export/export_table.h"

namespace phalanx::python {
namespace {

namespace fs = std::filesystem;

/// The rows of a table: the numbers of one column after the other's.
struct Table {
  std::vector<ExportColumn> columns;
  std::vector<std::vector<double>> numbers;     ///< for each column; empty for texts
  std::vector<std::vector<std::string>> texts;  ///< for each column; empty for numbers
};
using Tables = std::map<std::string, Table>;

class MemoryTable final : public TableWriter {
 public:
  MemoryTable(const ExportTable& table, Table& into) : name_(table.name), into_(into) {
    into_.columns = table.columns;
    into_.numbers.resize(table.columns.size());
    into_.texts.resize(table.columns.size());
  }
  void add(const ExportRow& row) override {
    auto number = row.numbers.begin();
    auto text = row.texts.begin();
    for (std::size_t c = 0; c < into_.columns.size(); ++c) {
      if (into_.columns[c].is_text) {
        into_.texts[c].push_back(*text++);
      } else {
        const auto width = static_cast<std::ptrdiff_t>(into_.columns[c].width());
        into_.numbers[c].insert(into_.numbers[c].end(), number, number + width);
        number += width;
      }
    }
    ++rows_;
  }
  ExportedPart finish() override { return {.file = {}, .part = name_, .rows = rows_}; }

 private:
  std::string name_;
  Table& into_;
  std::uint64_t rows_ = 0;
};

class MemoryFormat final : public TableFormat {
 public:
  explicit MemoryFormat(Tables& tables) : tables_(tables) {}
  std::unique_ptr<TableWriter> begin(const ExportTable& table) override {
    return std::make_unique<MemoryTable>(table, tables_[table.name]);
  }

 private:
  Tables& tables_;
};

/// @returns "torque_nm" for a column that has labels
std::string name_of(const ExportColumn& column) {
  const std::string name = column.full_name(0);
  return column.labels.empty() ? name : name.substr(0, name.size() - column.labels[0].size() - 1);
}

py::dict as_arrays(Table table) {
  py::dict arrays;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const ExportColumn& column = table.columns[c];
    const py::str name(name_of(column));
    if (column.is_text) {
      arrays[name] = table.texts[c];
      continue;
    }
    const auto width = static_cast<py::ssize_t>(column.width());
    const auto rows = static_cast<py::ssize_t>(table.numbers[c].size()) / width;
    arrays[name] =
        take_doubles(std::move(table.numbers[c]), column.labels.empty() ? Shape{rows} : Shape{rows, width});
  }
  return arrays;
}

/// A recording and the keys to read it.
class Recording {
 public:
  /// Call it without the GIL.
  Recording(fs::path file, const std::string& keys, const std::string& passphrase) : file_(std::move(file)) {
    if (!keys.empty()) keys_ = KeyStore::open(keys, passphrase).finder();
    summary_ = summarise_recording(file_, keys_);
  }
  [[nodiscard]] const RecordingSummary& summary() const noexcept { return summary_; }
  [[nodiscard]] const FindRecordingKey& keys() const noexcept { return keys_; }
  [[nodiscard]] const fs::path& file() const noexcept { return file_; }

 private:
  fs::path file_;
  FindRecordingKey keys_;
  RecordingSummary summary_;
};

py::dict read_recorded_tables(const Recording& recording, const std::vector<std::string>& names,
                              const std::vector<std::string>& columns, const py::object& from,
                              const py::object& to, const py::object& progress) {
  check_function(progress, "progress");
  constexpr NumberRange kTime = between(0.0, 1e12);
  ExportOptions options;
  options.parts = names;
  options.columns = columns;
  if (!from.is_none()) options.from = read_number(from, "from_s", kTime);
  if (!to.is_none()) options.to = read_number(to, "to_s", kTime);
  Tables tables;
  {
    const Recording copy = recording;
    const py::gil_scoped_release release;
    read_tables(
        copy.file(), std::make_unique<MemoryFormat>(tables), options,
        [&](double part) { call_python(progress, part); }, copy.keys());
  }
  py::dict result;
  for (auto& [name, table] : tables) result[py::str(name)] = as_arrays(std::move(table));
  return result;
}

py::dict replay_of(const Recording& recording, const py::object& progress) {
  check_function(progress, "progress");
  ReplayResult result;
  {
    const Recording copy = recording;
    const py::gil_scoped_release release;
    result = replay(copy.file(), [&](double part) { call_python(progress, part); }, nullptr, copy.keys());
  }
  py::dict out;
  out["stations"] = result.stations;
  out["steps"] = result.steps;
  out["compared"] = result.compared;
  out["different"] = result.different;
  out["missing"] = result.missing;
  out["not_compared"] = result.not_compared;
  out["seconds"] = result.seconds;
  out["exact"] = result.exact;
  out["first_difference"] = result.first ? py::object(py::str(result.first->what)) : py::none();
  out["largest_torque_nm"] = result.largest_torque;
  out["recorded_by"] = result.recorded_by;
  return out;
}

template <class Member>
void bind_summary(py::class_<Recording>& recording, const char* name, Member RecordingSummary::* member,
                  const char* meaning) {
  recording.def_property_readonly(
      name, [member](const Recording& self) { return self.summary().*member; }, meaning);
}

}  // namespace

void bind_recording(py::module_& module) {
  py::class_<Recording> recording(module, "Recording", R"(A recording of a station; docs/recording.md.

file: path of a .mcap or .mcap.enc file.
keys: path of the key file for an encrypted recording; "": none.
passphrase: of the key file; "": it has none.)");
  close_class(recording);
  recording
      .def(py::init([](const fs::path& file, const fs::path& keys, const std::string& passphrase) {
             const py::gil_scoped_release release;
             return std::make_unique<Recording>(file, keys.string(), passphrase);
           }),
           py::arg("file"), py::arg("keys") = "", py::arg("passphrase") = "")
      .def("tables", &read_recorded_tables, py::arg("names") = std::vector<std::string>(),
           py::arg("columns") = std::vector<std::string>(), py::arg("from_s") = py::none(),
           py::arg("to_s") = py::none(), py::arg("progress") = py::none(),
           R"(Reads tables, as dicts of columns by the tables' names. Other Python threads run meanwhile.

A column is a float64 array, (n,), or (n, 20) with a value for each of JOINTS; texts are lists. Numbers that
do not exist are NaN. The names are those of the export; docs/recording.md.

names: of the tables; empty: all but "observations", which is made again by a replay.
columns: "torque" or "torque_nm_index_pip_flexion"; empty: all.
from_s, to_s: range of time since the beginning of the recording [s].
progress: called as progress(part), 0 to 1; what it raises ends the call.)")
      .def(
          "table",
          [](const Recording& self, const std::string& name) -> py::object {
            const py::dict one = read_recorded_tables(self, {name}, {}, py::none(), py::none(), py::none());
            return one[py::str(name)];
          },
          py::arg("name"),
          "Reads one table: steps, samples, angles, channels, hand, segments, observations, events.")
      .def(
          "motion",
          [](const Recording& self) {
            const Recording copy = self;
            const py::gil_scoped_release release;
            return std::make_shared<Motion>(recorded_motion(copy.file(), copy.keys()));
          },
          "Returns the measured angles of the longest station as a Motion, for simulate().")
      .def("replay", &replay_of, py::arg("progress") = py::none(),
           "Makes every step again and compares its bits; returns the counts by name.")
      .def_property_readonly(
          "state", [](const Recording& self) { return recording_state(self.summary()); },
          "\"whole\", or what is wrong, in words.")
      .def("__repr__", [](const Recording& self) {
        return fmt::format("<Recording {}: {}>", self.file().string(), recording_state(self.summary()));
      });
  bind_summary(recording, "trouble", &RecordingSummary::trouble,
               "Why nothing more is known; empty: all below is.");
  bind_summary(recording, "begin_utc_s", &RecordingSummary::begin, "Begin, UTC [s since 1970].");
  bind_summary(recording, "seconds", &RecordingSummary::seconds, "From the first to the last message [s].");
  bind_summary(recording, "steps", &RecordingSummary::steps, "Number of steps.");
  bind_summary(recording, "events", &RecordingSummary::events, "Number of events.");
  bind_summary(recording, "gaps", &RecordingSummary::gaps, "Number of gaps.");
  bind_summary(recording, "scene", &RecordingSummary::scene, "Scene of the first station.");
  bind_summary(recording, "device", &RecordingSummary::device, "Device of the first station.");
  bind_summary(recording, "version", &RecordingSummary::version, "Version of the program that recorded it.");
  bind_summary(recording, "encrypted", &RecordingSummary::encrypted, "True for an encrypted file.");
}

}  // namespace phalanx::python
