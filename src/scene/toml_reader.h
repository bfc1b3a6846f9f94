// SPDX-License-Identifier: Apache-2.0
// Reading TOML so that every complaint names file, line, key, value and remedy.
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <toml++/toml.h>

#include "phalanx/core/math.h"

namespace phalanx {

/// The allowed values of a number.
struct NumberRange {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;  ///< min itself is refused
  bool max_open = false;  ///< max itself is refused
  bool allows_minus_infinity = false;

  [[nodiscard]] bool contains(double value) const noexcept;
  /// "> 0, <= 15", "any finite number"
  [[nodiscard]] std::string text() const;
};
/// 0 <= value <= max.
[[nodiscard]] constexpr NumberRange at_most(double max) { return {.min = 0.0, .max = max}; }
/// 0 < value <= max.
[[nodiscard]] constexpr NumberRange above_0(double max) { return {.min = 0.0, .max = max, .min_open = true}; }

/// The text of a file. @throws SceneError if it cannot be read or is larger than 16 MB (no TOML file of ours
/// is).
[[nodiscard]] std::string read_text_file(const std::string& path, const std::string& what);

/// Parses TOML of bounded depth: all TOML that does not stand in the source goes through here.
/// @throws toml::parse_error  not TOML; SceneError  beyond check_toml_bounds()
[[nodiscard]] toml::table parse_bounded_toml(const std::string& text, const std::string& origin);

/// The same. @throws SceneError with file, line and what is wrong.
[[nodiscard]] toml::table parse_toml(const std::string& text, const std::string& origin);

/// A value as it would stand in a file, shortened.
[[nodiscard]] std::string show(const toml::node& node);
/// "a string", "an integer", ...
[[nodiscard]] std::string_view type_name(const toml::node& node);

/// Where a value was stated, when a tree is put together from several files: the place, "FILE:LINE" or "--set
/// KEY=VALUE", and what stands there before the value's path in the tree ("device.").
struct ValuePlace {
  std::string place;
  std::string prefix;
};
/// The place of the value, or of the innermost table that is there, for a path in the tree.
using PlaceOf = std::function<ValuePlace(const std::string& path)>;

/// One table of a TOML file. Every read marks the key as known; finish() complains about the others.
class TomlTable {
 public:
  /// @param place_of  empty: values stand in `origin` where the parser met them
  TomlTable(const toml::table& table, std::string origin, std::string path, PlaceOf place_of = {})
      : table_(&table), origin_(std::move(origin)), path_(std::move(path)), place_of_(std::move(place_of)) {}

  /// All keys that are there, sorted; marks none as known.
  [[nodiscard]] std::vector<std::string> keys() const;
  [[nodiscard]] bool has(std::string_view key);
  [[nodiscard]] double number(std::string_view key, const NumberRange& range);
  [[nodiscard]] double number_or(std::string_view key, const NumberRange& range, double fallback);
  [[nodiscard]] bool flag(std::string_view key);
  [[nodiscard]] std::string text(std::string_view key);
  [[nodiscard]] Vec3 vector(std::string_view key, const NumberRange& range);
  /// An array of two numbers.
  [[nodiscard]] std::pair<double, double> pair(std::string_view key, const NumberRange& range);
  [[nodiscard]] TomlTable table(std::string_view key);
  /// An array of tables of exactly `size` elements (any number if it is negative).
  [[nodiscard]] std::vector<TomlTable> tables(std::string_view key, int size);
  /// @throws SceneError for the first key that nobody asked for, naming the nearest known one.
  void finish() const;

  /// "FILE:LINE: PATH" of this table, for messages about it later.
  [[nodiscard]] std::string place() const;

  /// @throws SceneError about `key`'s value at its place.
  [[noreturn]] void fail(std::string_view key, const std::string& problem) const;

 private:
  [[nodiscard]] const toml::node& node(std::string_view key);
  [[nodiscard]] std::vector<double> numbers(std::string_view key, const NumberRange& range, std::size_t size);
  [[nodiscard]] std::string full(std::string_view key) const;
  /// "FILE:LINE: PATH" of a value; of the innermost table that is there if it is null.
  [[nodiscard]] std::string place_of(const toml::node* found, const std::string& path) const;

  const toml::table* table_;
  std::string origin_;
  std::string path_;
  PlaceOf place_of_;
  std::vector<std::string> known_;
};

}  // namespace phalanx
