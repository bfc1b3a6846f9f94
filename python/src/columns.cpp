// SPDX-License-Identifier: Apache-2.0
#include "columns.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "phalanx/core/nearest_name.h"

namespace phalanx::python {
namespace {

constexpr py::ssize_t kNumber = sizeof(double);

template <class Value>
constexpr char type_of() {
  if constexpr (std::is_same_v<Value, double>) return 'd';
  if constexpr (std::is_same_v<Value, bool>) return '?';
  if constexpr (std::is_same_v<Value, std::uint64_t>) return 'Q';
  return 'I';
}

/// A single value. @param member  of Snapshot
template <auto member>
Column single(const char* name, const char* meaning) {
  using Value = std::remove_cvref_t<decltype(std::declval<Snapshot>().*member)>;
  return {.name = name,
          .meaning = meaning,
          .type = type_of<Value>(),
          .shape = {},
          .strides = {},
          .row_bytes = sizeof(Value),
          .first = [](const Snapshot& s) -> const void* { return &(s.*member); }};
}

/// One number for each joint or digit. @param member  an array of Snapshot
template <auto member>
Column each(const char* name, const char* meaning) {
  using Values = std::remove_cvref_t<decltype(std::declval<Snapshot>().*member)>;
  return {.name = name,
          .meaning = meaning,
          .shape = {static_cast<py::ssize_t>(std::tuple_size_v<Values>)},
          .strides = {kNumber},
          .row_bytes = sizeof(Values),
          .first = [](const Snapshot& s) -> const void* { return (s.*member).data(); }};
}

/// A number, a flag or a vector for each segment. @param member  of SegmentSnapshot
template <auto member>
Column segment(const char* name, const char* meaning) {
  using Value = std::remove_cvref_t<decltype(std::declval<SegmentSnapshot>().*member)>;
  Column column{.name = name,
                .meaning = meaning,
                .type = type_of<Value>(),
                .shape = {kSegments},
                .strides = {sizeof(SegmentSnapshot)},
                .rows = kSegments,
                .row_bytes = sizeof(Value),
                .first = [](const Snapshot& s) -> const void* { return &(s.segment[0].*member); }};
  if constexpr (std::is_same_v<Value, Vec3>) {
    column.type = 'd';
    column.shape.push_back(3);
    column.strides.push_back(kNumber);
  }
  return column;
}

/// A part of each segment's pose. @param poses  of Snapshot   @param part  of Pose
template <auto poses, auto part>
Column pose(const char* name, const char* meaning) {
  using Value = std::remove_cvref_t<decltype(std::declval<Pose>().*part)>;
  Column column{.name = name,
                .meaning = meaning,
                .shape = {kSegments, 3},
                .strides = {sizeof(Pose), kNumber},
                .rows = kSegments,
                .row_bytes = sizeof(Value),
                .recorded = false,
                .first = [](const Snapshot& s) -> const void* { return &((s.*poses)[0].*part); }};
  if constexpr (std::is_same_v<Value, Mat3>) {  // Eigen stores column after column
    column.shape.push_back(3);
    column.strides.push_back(3 * kNumber);
  }
  return column;
}

Column not_recorded(Column column) {
  column.recorded = false;
  return column;
}

std::vector<Column> make_columns() {
  using S = Snapshot;
  using P = SegmentSnapshot;
  return {
      single<&S::tick>("tick", "Number of the step."),
      single<&S::time_s>("time_s", "Time of the last used sample [s]."),
      single<&S::status>("status", "Bits of Status."),
      each<&S::hcp_angle>("hcp_angle_rad", "Measured angles of the joints [rad], (20,)."),
      each<&S::gdp_angle>("gdp_angle_rad", "Angles of the shown hand's joints [rad], (20,)."),
      each<&S::torque>("torque_nm",
                       "Commanded torques of the joints, of the contacts on the finger [Nm], (20,)."),
      segment<&P::contact>("contact", "True for a segment with a contact record, (16,)."),
      segment<&P::depth>("depth_m", "Depth of each segment's contact, not below 0 [m], (16,)."),
      segment<&P::force_raw>("force_raw_n", "Magnitude that the force law gives [N], (16,)."),
      segment<&P::force>("force_n", "Magnitude sent, after caps and stabiliser [N], (16,)."),
      segment<&P::point>("point_m", "Contact point on the shown segment, in the world frame [m], (16, 3)."),
      segment<&P::normal>("normal", "Direction of the force on the finger, in the world frame [-], (16, 3)."),
      segment<&P::slid>("slid_m", "Tangential offset between measured and shown contact point [m], (16,)."),
      segment<&P::friction>("friction_n", "Friction force on the finger, in the world frame [N], (16, 3)."),
      segment<&P::spin>("spin_nm", "Friction's moment about the contact's mean normal [Nm], (16,)."),
      segment<&P::slips>("slips", "True for a segment that slips, in sliding mode, (16,)."),
      segment<&P::slip_speed>("slip_speed_m_per_s", "Speed of the contact along the surface [m/s], (16,)."),
      segment<&P::oscillating>("oscillating", "True for a segment whose force oscillates, (16,)."),
      not_recorded(segment<&P::oscillation_frequency>("oscillation_frequency_hz",
                                                      "Frequency of the oscillation, else 0 [Hz], (16,).")),
      not_recorded(segment<&P::oscillation_swing>(
          "oscillation_swing_n", "Last swing of the oscillation, peak to peak, else 0 [N], (16,).")),
      not_recorded(single<&S::stiffness_factor>("stiffness_factor", "Factor on the law's force [-].")),
      not_recorded(each<&S::measured_torque>("measured_torque_nm",
                                             "Torques that the device measured; NaN: none [Nm], (20,).")),
      not_recorded(each<&S::measured_force>("measured_force_n",
                                            "Forces that the device measured; NaN: none [N], (5,).")),
      pose<&S::hcp_pose, &Pose::p>("hcp_position_m",
                                   "Origins of the measured segments, in the world frame [m], (16, 3)."),
      pose<&S::hcp_pose, &Pose::R>("hcp_rotation",
                                   "Rotation matrices of the measured segments [-], (16, 3, 3)."),
      pose<&S::gdp_pose, &Pose::p>("gdp_position_m",
                                   "Origins of the shown segments, in the world frame [m], (16, 3)."),
      pose<&S::gdp_pose, &Pose::R>("gdp_rotation",
                                   "Rotation matrices of the shown segments [-], (16, 3, 3)."),
  };
}

}  // namespace

py::object Column::of(const Snapshot& snapshot, const py::object& owner) const {
  const void* data = first(snapshot);
  if (!shape.empty()) return view_of(type, shape, strides, data, owner);
  if (type == 'd') return py::float_(*static_cast<const double*>(data));
  if (type == 'Q') return py::int_(*static_cast<const std::uint64_t*>(data));
  return py::int_(*static_cast<const std::uint32_t*>(data));
}

const std::vector<Column>& columns() {
  static const std::vector<Column> kColumns = make_columns();
  return kColumns;
}

std::vector<const Column*> chosen_columns(const py::object& names) {
  std::vector<const Column*> chosen;
  if (names.is_none()) {
    for (const Column& column : columns())
      if (column.recorded) chosen.push_back(&column);
    return chosen;
  }
  if (!py::isinstance<py::list>(names) && !py::isinstance<py::tuple>(names))
    throw py::type_error("columns: give a list of names, or None");
  std::vector<std::string> known;
  for (const Column& column : columns()) known.push_back(column.name);
  for (const py::handle name : names) {
    if (!py::isinstance<py::str>(name)) throw py::type_error("columns: every name must be a text");
    const std::string text = name.cast<std::string>();
    const auto it = std::find(known.begin(), known.end(), text);
    if (it == known.end())
      throw py::value_error(fmt::format("columns: there is no '{}'; {}known: {}", text,
                                        did_you_mean(text, known), fmt::join(known, ", ")));
    const Column* column = &columns()[static_cast<std::size_t>(it - known.begin())];
    if (std::find(chosen.begin(), chosen.end(), column) == chosen.end()) chosen.push_back(column);
  }
  return chosen;
}

Run::Run(const std::vector<const Column*>& columns, std::size_t ticks) {
  std::size_t bytes_a_tick = 1;
  for (const Column* column : columns) bytes_a_tick += column->bytes();
  if (ticks > kMostBytes / bytes_a_tick)
    throw std::invalid_argument(fmt::format(
        "{} ticks of {} bytes need more than 8 GiB; choose fewer columns or seconds", ticks, bytes_a_tick));
  for (const Column* column : columns) {
    data_.emplace_back(column, std::vector<std::byte>());
    data_.back().second.reserve(ticks * column->bytes());
  }
}

void Run::add(const Snapshot& snapshot) {
  for (auto& [column, bytes] : data_) {
    const auto* from = static_cast<const std::byte*>(column->first(snapshot));
    const std::size_t stride = column->rows > 1 ? static_cast<std::size_t>(column->strides[0]) : 0;
    for (std::size_t row = 0; row < column->rows; ++row)
      bytes.insert(bytes.end(), from + row * stride, from + row * stride + column->row_bytes);
  }
  ++ticks_;
}

std::vector<std::string> Run::names() const {
  std::vector<std::string> names;
  for (const auto& [column, bytes] : data_) names.push_back(column->name);
  return names;
}

py::object Run::array(const std::shared_ptr<const Run>& run, const Column& column) {
  for (const auto& [chosen, bytes] : run->data_) {
    if (chosen != &column) continue;
    Shape shape = column.shape;
    Shape strides = column.strides;
    if (column.rows > 1) strides[0] = static_cast<py::ssize_t>(column.row_bytes);
    shape.insert(shape.begin(), static_cast<py::ssize_t>(run->ticks_));
    strides.insert(strides.begin(), static_cast<py::ssize_t>(column.bytes()));
    return view_of(column.type, std::move(shape), std::move(strides), bytes.data(), shared_owner(run));
  }
  return {};
}

void bind_run(py::module_& module) {
  py::class_<Run, std::shared_ptr<Run>> run(module, "Run", R"(The columns of a motion: a row for each step.

Each column is a read-only NumPy array on the memory that the motion was computed into; nothing is copied.
An array keeps this memory alive, also without its Run. (20,) is in the order of JOINTS, (16,) in that of
SEGMENTS, and the first dimension of every column is the step.)");
  close_class(run);
  for (const Column& column : columns())
    run.def_property_readonly(
        column.name.c_str(),
        [&column](const std::shared_ptr<Run>& self) {
          py::object array = Run::array(self, column);
          if (!array)
            throw py::attribute_error(
                fmt::format("{} is not in this run; choose it with columns=[...]", column.name));
          return array;
        },
        column.meaning.c_str());
  run.def_property_readonly("columns", &Run::names, "Names of the columns in this run.")
      .def("__len__", &Run::ticks)
      .def(
          "as_dict",
          [](const std::shared_ptr<Run>& self) {
            py::dict all;
            for (const Column& column : columns())
              if (py::object array = Run::array(self, column)) all[py::str(column.name)] = array;
            return all;
          },
          "Returns the columns by their names, as for a data frame.")
      .def_property_readonly(
          "_owners", [](const std::shared_ptr<Run>& self) { return self.use_count(); },
          "Number of owners of the memory, this call's among them.")
      .def("__repr__", [](const Run& self) { return fmt::format("<Run of {} steps>", self.ticks()); });
}

}  // namespace phalanx::python
