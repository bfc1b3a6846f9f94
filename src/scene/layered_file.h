// SPDX-License-Identifier: Apache-2.0
// A file that may stand on another (its `base`), with values of a scene laid over it: one tree in which every
// value still knows where it was stated.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "phalanx/scene/scene.h"
#include "scene/toml_reader.h"

namespace phalanx {

class LayeredFile {
 public:
  /// @param what  "device", "patient": names the file in messages, its folder in assets/ and its table in a
  /// scene
  explicit LayeredFile(std::string what) : what_(std::move(what)) {}

  /// Lays a file, and below it the one that it names as `base`, over what is there. A relative `base` path is
  /// relative to the file that names it.
  /// @param stated_at  "FILE:LINE: KEY = VALUE" that names the file; empty: nobody does
  /// @throws SceneError.
  void add_file(const std::string& name_or_path, const std::filesystem::path& folder,
                const std::string& stated_at = "");
  /// The same from text.
  void add_text(const std::string& text, const std::string& origin, const std::filesystem::path& folder);
  /// Lays a scene's values over what is there. @throws SceneError.
  void add_overlay(const std::vector<OverlaidValue>& values);

  /// Everything but `base` and `scale`: of each value the one that was laid last.
  /// The tables that these two give live as long as this does.
  [[nodiscard]] TomlTable root() const;
  /// The layers' [scale] tables. They multiply: a scene's scale counts from the file's device, not from its
  /// base's.
  [[nodiscard]] std::vector<TomlTable> scales() const;
  /// The file that was laid last.
  [[nodiscard]] const std::string& origin() const noexcept { return origin_; }
  /// The file and every value that a scene laid over it, for messages about the whole.
  [[nodiscard]] std::string in_words() const;

 private:
  struct Stated {
    ValuePlace place;
    bool table = false;
  };
  using Places = std::map<std::string, Stated>;
  struct Layer {
    toml::table tree;
    Places places;
  };

  void add_text(const std::string& text, const std::string& origin, const std::filesystem::path& folder,
                int depth);
  void add(Layer layer);
  static void note_places(const toml::table& table, const std::string& path, const std::string& origin,
                          Places& places);
  /// For as long as `places` lives.
  [[nodiscard]] PlaceOf lookup(const Places& places) const;

  std::string what_;
  std::string origin_;
  std::string overlay_in_words_;
  Layer merged_;
  std::vector<std::unique_ptr<Layer>> scale_layers_;  ///< only their tree's `scale`
};

}  // namespace phalanx
