// SPDX-License-Identifier: Apache-2.0
// Reading TOML; every error names file, line, key, value and remedy. toml_bounds.h limits the depth of a text
// before it is parsed, and layered_file.h merges a file with those that it extends.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "phalanx/core/math.h"
#include "phalanx/core/number_range.h"

namespace phalanx {

/// Parses TOML of bounded depth. All TOML that is not in the source code is parsed here.
/// @throws toml::parse_error if it is not TOML; SceneError beyond check_toml_bounds()
[[nodiscard]] toml::table parse_bounded_toml(const std::string& text, const std::string& origin);

/// Parses TOML of bounded depth. @throws SceneError with file, line and problem.
[[nodiscard]] toml::table parse_toml(const std::string& text, const std::string& origin);

/// @returns a value as TOML text that reads back the same. Numbers are in the shortest form (0.9, not
/// 0.90000000000000002), strings in double quotes.
[[nodiscard]] std::string toml_text(const toml::node& node);
/// @returns a value as written in a file, shortened.
[[nodiscard]] std::string show(const toml::node& node);
/// @returns the value of a number; infinity for an integer beyond +-2^53, which no range of the program allows
/// @pre node.is_number()
[[nodiscard]] double number_of(const toml::node& node);
/// @returns "a string", "an integer", ...
[[nodiscard]] std::string_view type_name(const toml::node& node);

/// Origin of a value in a tree that was merged from several files. It is the place, "FILE:LINE" or "--set
/// KEY=VALUE", and the prefix of the value's path there ("device.").
struct ValuePlace {
  std::string place;
  std::string prefix;
};
/// Function that finds the origin of a value, or of the innermost existing table, for a path in the tree.
using PlaceOf = std::function<ValuePlace(const std::string& path)>;

/// One table of a TOML file. Every read marks the key as known; finish() refuses the others.
class TomlTable {
 public:
  /// @param place_of  empty: the values' places are those of the parser, in `origin`
  TomlTable(const toml::table& table, std::string origin, std::string path, PlaceOf place_of = {})
      : table_(&table), origin_(std::move(origin)), path_(std::move(path)), place_of_(std::move(place_of)) {}

  /// @returns all keys of the table, sorted; it marks none as known.
  [[nodiscard]] std::vector<std::string> keys() const;
  [[nodiscard]] bool has(std::string_view key);
  [[nodiscard]] double number(std::string_view key, const NumberRange& range);
  [[nodiscard]] double number_or(std::string_view key, const NumberRange& range, double fallback);
  [[nodiscard]] bool flag(std::string_view key);
  [[nodiscard]] std::string text(std::string_view key);
  [[nodiscard]] Vec3 vector(std::string_view key, const NumberRange& range);
  /// Reads an array of two numbers.
  [[nodiscard]] std::pair<double, double> pair(std::string_view key, const NumberRange& range);
  /// Reads an array of at least one number.
  [[nodiscard]] std::vector<double> list(std::string_view key, const NumberRange& range);
  /// Reads an array of at least one pair of numbers, [[a, b], ...].
  [[nodiscard]] std::vector<std::pair<double, double>> pairs(std::string_view key, const NumberRange& first,
                                                             const NumberRange& second);
  [[nodiscard]] TomlTable table(std::string_view key);
  /// Reads an array of tables with exactly `size` elements (any number if `size` is negative).
  [[nodiscard]] std::vector<TomlTable> tables(std::string_view key, int size);
  /// Throws SceneError for the first key that was not read, naming the nearest known one.
  void finish() const;

  /// @returns "FILE:LINE: PATH" of this table, for later messages.
  [[nodiscard]] std::string place() const;

  /// Throws SceneError about `key`'s value at its place.
  [[noreturn]] void fail(std::string_view key, const std::string& problem) const;

 private:
  [[nodiscard]] const toml::node& node(std::string_view key);
  [[nodiscard]] std::vector<double> numbers(std::string_view key, const NumberRange& range, std::size_t size);
  [[nodiscard]] double element(std::string_view key, const std::string& name, const toml::node& node,
                               const NumberRange& range) const;
  [[nodiscard]] std::string full(std::string_view key) const;
  /// @returns "FILE:LINE: PATH" of a value; if it is null, of the innermost existing table.
  [[nodiscard]] std::string place_of(const toml::node* found, const std::string& path) const;

  const toml::table* table_;
  std::string origin_;
  std::string path_;
  PlaceOf place_of_;
  std::vector<std::string> known_;
};

}  // namespace phalanx
