// SPDX-License-Identifier: Apache-2.0
// Cache of imported meshes: a mesh that was imported before is not read, repaired and checked again.
#pragma once

#include <cstddef>
#include <filesystem>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "phalanx/mesh/import.h"

namespace phalanx {

/// Imported meshes with the content of their files. A mesh is found by the content, the format and the
/// options that its import depends on: size, unit and triangles. The unit counts only if the size is 0.
/// Contents are compared byte by byte, so that no file can pass for another one. Refusals are not kept.
///
/// All functions are for any thread. Set-up only: they lock, allocate and compare whole files.
class ImportCache {
 public:
  static constexpr std::size_t kMostBytes = std::size_t{256} << 20;

  /// @param most_bytes  bound on the meshes and contents together. Beyond it, the mesh whose last use is
  /// the longest ago is dropped.
  explicit ImportCache(std::size_t most_bytes = kMostBytes) : most_bytes_(most_bytes) {}

  /// @param format  extension without the dot, in lower case
  /// @returns the mesh; null if there is none, or if its file has more than ImportOptions::most_triangles
  [[nodiscard]] std::shared_ptr<const ImportedMesh> find(std::string_view content, std::string_view format,
                                                         const ImportOptions& options);
  /// Keeps a mesh, unless it exceeds the bound by itself. It replaces one that find() would have found.
  /// @param format  as for find()
  void keep(std::string content, std::string format, const ImportOptions& options, ImportedMesh imported);

  // For tests.
  [[nodiscard]] std::size_t hits() const;    ///< calls of find() that found a mesh
  [[nodiscard]] std::size_t misses() const;  ///< calls of find() that found none
  [[nodiscard]] std::size_t bytes() const;   ///< of all meshes and contents that are kept

 private:
  struct Entry {
    std::string content;
    std::string format;
    ImportOptions options;
    std::shared_ptr<const ImportedMesh> imported;

    [[nodiscard]] std::size_t bytes() const;
  };
  using Entries = std::list<Entry>;

  /// The lock must be held.
  [[nodiscard]] Entries::iterator position(std::string_view content, std::string_view format,
                                           const ImportOptions& options);
  void drop(Entries::iterator entry);

  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  Entries entries_;  ///< the last used first
  std::size_t bytes_ = 0;
  std::size_t hits_ = 0;
  std::size_t misses_ = 0;
};

/// Reads a mesh file, and returns the mesh that the cache has for its content. If there is none, imports it
/// as import_and_check() and keeps it in the cache. Set-up only.
/// @param cache  null: none
/// @throws as import_and_check()
[[nodiscard]] ImportedMesh import_and_check(const std::filesystem::path& file, const ImportOptions& options,
                                            ImportCache* cache);

}  // namespace phalanx
