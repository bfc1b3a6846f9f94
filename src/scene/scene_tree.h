// SPDX-License-Identifier: Apache-2.0
// A scene file's tree with the command line's overrides applied. It knows the place of every value.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/scene/scene.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {

/// Tree of a scene's values.
class SceneTree {
 public:
  /// Parses `text` and applies the overrides in order. @throws SceneError.
  SceneTree(const std::string& text, std::string origin, const Overrides& overrides);

  [[nodiscard]] const toml::table& root() const noexcept { return root_; }
  /// @returns the values below the table `name`, except its `file`: the scene's overrides of that file.
  /// @throws SceneError for a key that a TOML file could not hold without quotes.
  [[nodiscard]] std::vector<OverlaidValue> values_over_file(const std::string& name) const;
  /// @returns the value at a path such as "objects.0.size_mm"; null if there is none.
  [[nodiscard]] const toml::node* find(std::string_view path) const;
  /// @returns "grasp.toml:12" or "--set objects.0.size_mm=80"; for a missing value, the place of the
  /// innermost table that exists.
  [[nodiscard]] std::string place(std::string_view path) const;
  /// @returns "PLACE: PATH = VALUE", for later messages; without the value if there is none.
  [[nodiscard]] std::string statement(std::string_view path) const;
  /// Throws SceneError "PLACE: PATH = VALUE: PROBLEM".
  [[noreturn]] void fail(std::string_view path, const std::string& problem) const;

 private:
  void apply(const std::string& key, const std::string& value);
  void add_values_below(const toml::table& table, const std::string& path, std::size_t skip,
                        std::vector<OverlaidValue>& values) const;

  std::string origin_;
  toml::table root_;
  Overrides overrides_;
};

}  // namespace phalanx
