// SPDX-License-Identifier: Apache-2.0
// The quantities of a snapshot as columns of arrays: one table for a single step and for a whole motion.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "arrays.h"
#include "phalanx/step/snapshot.h"

namespace phalanx::python {

/// One quantity of a Snapshot.
struct Column {
  std::string name;  ///< with its unit: "force_n"
  std::string meaning;
  char type = 'd';       ///< as view_of()
  Shape shape;           ///< of one tick; empty: a single value
  Shape strides;         ///< of one tick in a Snapshot [bytes]
  std::size_t rows = 1;  ///< parts of a tick that are not contiguous in a Snapshot
  std::size_t row_bytes = 0;
  bool recorded = true;  ///< is in a Run unless the caller chooses other columns
  const void* (*first)(const Snapshot& snapshot) = nullptr;

  [[nodiscard]] std::size_t bytes() const noexcept { return rows * row_bytes; }
  /// @returns the value in a snapshot: a number, or an array on its memory
  [[nodiscard]] py::object of(const Snapshot& snapshot, const py::object& owner) const;
};

/// @returns the table, in the order of the documentation
[[nodiscard]] const std::vector<Column>& columns();

/// @returns the columns of an argument: None is those that are recorded by default
/// @throws py::type_error, py::value_error naming the known columns
[[nodiscard]] std::vector<const Column*> chosen_columns(const py::object& names);

/// The columns of a motion, each in one piece of memory.
class Run {
 public:
  /// Reserves the memory, so that add() allocates nothing for these ticks.
  /// @throws std::invalid_argument if it is more than kMostBytes
  Run(const std::vector<const Column*>& columns, std::size_t ticks);

  /// Adds one tick.
  void add(const Snapshot& snapshot);
  [[nodiscard]] std::size_t ticks() const noexcept { return ticks_; }
  [[nodiscard]] std::vector<std::string> names() const;
  /// @returns a column on the memory of `run`, which the array keeps alive; empty: it was not chosen
  [[nodiscard]] static py::object array(const std::shared_ptr<const Run>& run, const Column& column);

  static constexpr std::size_t kMostBytes = std::size_t{8} << 30;

 private:
  std::vector<std::pair<const Column*, std::vector<std::byte>>> data_;
  std::size_t ticks_ = 0;
};

}  // namespace phalanx::python
