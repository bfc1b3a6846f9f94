// SPDX-License-Identifier: Apache-2.0
// A scene file's tree with the command line's overrides applied: where each value stands, and where it came
// from.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/scene/scene.h"
#include "scene/toml_reader.h"

namespace phalanx {

class SceneTree {
 public:
  /// Parses `text` and applies the overrides in order. @throws SceneError.
  SceneTree(const std::string& text, std::string origin, const Overrides& overrides);

  [[nodiscard]] const toml::table& root() const noexcept { return root_; }
  /// The values below the table `name`, but not its `file`: what the scene lays over that file.
  /// @throws SceneError for a key that no TOML file could hold without quotes.
  [[nodiscard]] std::vector<OverlaidValue> values_over_file(const std::string& name) const;
  /// The value at a path such as "objects.0.size_mm"; null if there is none.
  [[nodiscard]] const toml::node* find(std::string_view path) const;
  /// "grasp.toml:12" or "--set objects.0.size_mm=80"; for a missing value, of the innermost table that is
  /// there.
  [[nodiscard]] std::string place(std::string_view path) const;
  /// "PLACE: PATH = VALUE", for messages about it later; without the value if there is none.
  [[nodiscard]] std::string statement(std::string_view path) const;
  /// @throws SceneError "PLACE: PATH = VALUE: PROBLEM".
  [[noreturn]] void fail(std::string_view path, const std::string& problem) const;

 private:
  void apply(const std::string& key, const std::string& value);
  void add_values_below(const toml::table& table, const std::string& path, std::size_t skip,
                        std::vector<OverlaidValue>& values) const;

  std::string origin_;
  toml::table root_;
  Overrides overrides_;
};

/// "objects.0.size_mm" -> "objects[].size_mm".
[[nodiscard]] std::string pattern_of(std::string_view path);

}  // namespace phalanx
