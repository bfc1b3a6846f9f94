// SPDX-License-Identifier: Apache-2.0
// A file that may extend another one (its `base`), with a scene's overrides: one tree, in which the origin of
// every value is known.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "phalanx/scene/scene.h"
#include "scene/toml/toml_reader.h"

namespace phalanx {

/// Tree merged from several files and overrides.
class LayeredFile {
 public:
  /// @param what  "device" or "patient": names the file in messages, its folder in assets/ and its table
  /// in a scene
  explicit LayeredFile(std::string what) : what_(std::move(what)) {}

  /// Merges a file over the present tree, and below it the file that it names as `base`. A relative `base`
  /// path is relative to the file that names it.
  /// @param stated_at  "FILE:LINE: KEY = VALUE" that names the file; empty: none
  /// @throws SceneError.
  void add_file(const std::string& name_or_path, const std::filesystem::path& folder,
                const std::string& stated_at = "");
  /// Merges a file from text.
  void add_text(const std::string& text, const std::string& origin, const std::filesystem::path& folder);
  /// Merges a scene's overrides over the present tree. @throws SceneError.
  void add_overlay(const std::vector<OverlaidValue>& values);

  /// @returns the merged tree without `base` and `scale`; each value is the one that was merged last. The
  /// tables from root() and scales() live as long as this object.
  [[nodiscard]] TomlTable root() const;
  /// @returns the layers' [scale] tables. They multiply: a scene's scale applies to the file's device, not
  /// to its base's.
  [[nodiscard]] std::vector<TomlTable> scales() const;
  /// @returns the file that was merged last.
  [[nodiscard]] const std::string& origin() const noexcept { return origin_; }
  /// @returns the files that were merged, without text from add_text().
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const noexcept { return files_; }
  /// Names the file and every override of the scene, for messages about the whole.
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
  /// Makes the look-up of places. It is valid as long as `places` lives.
  [[nodiscard]] PlaceOf lookup(const Places& places) const;

  std::string what_;
  std::string origin_;
  std::string overlay_in_words_;
  std::vector<std::filesystem::path> files_;
  Layer merged_;
  std::vector<std::unique_ptr<Layer>> scale_layers_;  ///< only their tree's `scale`
};

}  // namespace phalanx
