// SPDX-License-Identifier: Apache-2.0
// The rows of exercise_keys(): each reads, writes and describes one key of an exercise file.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/exercise/exercise.h"
#include "phalanx/scene/exercise_file.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {

/// One key. `path` is "target" or "dose.most_minutes"; the keys of objects[] have rows of their own.
struct ExerciseRow {
  ExerciseKey key;
  bool required = false;
  /// True if the exercise can have the key; its kind and measure are read before. Empty: always
  std::function<bool(const ExerciseDescription&)> applies;
  /// Reads the value of `name` in the key's table.
  std::function<void(TomlTable& table, std::string_view name, ExerciseDescription& exercise)> read;
  /// @returns the value as written in a file; none: the exercise does not state it
  std::function<std::optional<std::string>(const ExerciseDescription& exercise)> write;

  [[nodiscard]] std::string table() const;
  [[nodiscard]] std::string name() const;
  [[nodiscard]] bool applies_to(const ExerciseDescription& exercise) const {
    return !applies || applies(exercise);
  }
};

/// @returns all rows, in the order of the documentation and of exercise_text()
[[nodiscard]] const std::vector<ExerciseRow>& exercise_rows();
/// @returns the rows of one element of objects[]
struct ObjectRow {
  ExerciseKey key;
  std::function<void(TomlTable& table, ObjectChoice& object)> read;
  std::function<std::string(const ObjectChoice& object)> write;
};
[[nodiscard]] const std::vector<ObjectRow>& object_rows();

/// Writes a number in a key's unit, so that the product with `unit` reads back exactly if any double does.
[[nodiscard]] std::string number_in_unit(double value, double unit);
/// Reads "thumb index" as flags of digits.
[[nodiscard]] std::array<bool, kDigits> read_digits(TomlTable& table, std::string_view key);
/// Writes flags of digits as read_digits() reads them, in quotes.
[[nodiscard]] std::string digits_text(const std::array<bool, kDigits>& digits);

}  // namespace phalanx
