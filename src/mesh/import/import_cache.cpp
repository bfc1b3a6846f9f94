// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/import_cache.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace phalanx {
namespace {

/// @returns true if imports of the same content with these options have the same result.
bool same_result(const ImportOptions& a, const ImportOptions& b) {
  return a.size == b.size && (a.size > 0.0 || a.unit == b.unit) && a.triangles == b.triangles;
}

}  // namespace

std::size_t ImportCache::Entry::bytes() const {
  return content.size() + imported->mesh.vertices.size() * sizeof(Vec3) +
         imported->mesh.triangles.size() * sizeof(Triangle);
}

std::shared_ptr<const ImportedMesh> ImportCache::find(std::string_view content, std::string_view format,
                                                      const ImportOptions& options) {
  const std::lock_guard lock(mutex_);
  const auto entry = position(content, format, options);
  const bool found =
      entry != entries_.end() &&
      (options.most_triangles == 0 || entry->imported->report.triangles_in_file <= options.most_triangles);
  if (!found) {
    ++misses_;
    return nullptr;
  }
  ++hits_;
  entries_.splice(entries_.begin(), entries_, entry);
  return entry->imported;
}

void ImportCache::keep(std::string content, std::string format, const ImportOptions& options,
                       ImportedMesh imported) {
  Entry entry{.content = std::move(content),
              .format = std::move(format),
              .options = options,
              .imported = std::make_shared<const ImportedMesh>(std::move(imported))};
  const std::size_t bytes = entry.bytes();
  const std::lock_guard lock(mutex_);
  if (const auto old = position(entry.content, entry.format, options); old != entries_.end()) drop(old);
  if (bytes > most_bytes_) return;
  while (bytes_ + bytes > most_bytes_) drop(std::prev(entries_.end()));
  entries_.push_front(std::move(entry));
  bytes_ += bytes;
}

std::size_t ImportCache::hits() const {
  const std::lock_guard lock(mutex_);
  return hits_;
}

std::size_t ImportCache::misses() const {
  const std::lock_guard lock(mutex_);
  return misses_;
}

std::size_t ImportCache::bytes() const {
  const std::lock_guard lock(mutex_);
  return bytes_;
}

ImportCache::Entries::iterator ImportCache::position(std::string_view content, std::string_view format,
                                                     const ImportOptions& options) {
  return std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    return same_result(entry.options, options) && entry.format == format && entry.content == content;
  });
}

void ImportCache::drop(Entries::iterator entry) {
  bytes_ -= entry->bytes();
  entries_.erase(entry);
}

}  // namespace phalanx
