// SPDX-License-Identifier: Apache-2.0
#include "contact/compact_normals.h"

#include <bit>
#include <stdexcept>

namespace phalanx {
namespace {

using Bits = std::array<std::uint64_t, 3>;

/// Returns the bits of a normal, its identity: 0 and -0 differ.
Bits bits_of(const Vec3& n) {
  return {std::bit_cast<std::uint64_t>(n.x()), std::bit_cast<std::uint64_t>(n.y()),
          std::bit_cast<std::uint64_t>(n.z())};
}

/// Numbering of distinct vectors 0, 1, 2, ... in order of arrival. It is an open-addressed hash table over
/// the vectors themselves, and needs 8 to 16 bytes for each.
class Numbering {
 public:
  explicit Numbering(std::vector<Vec3>& seen) : seen_(seen), slot_(kSmallest, kEmpty) {}

  std::uint32_t number(const Vec3& n) {
    const std::size_t found = place_of(n);
    if (slot_[found] != kEmpty) return slot_[found];
    const auto fresh = static_cast<std::uint32_t>(seen_.size());
    if (fresh == kEmpty >> 1) throw std::length_error("CompactNormals: too many different normals");
    slot_[found] = fresh;
    seen_.push_back(n);
    if (2 * seen_.size() > slot_.size()) grow();
    return fresh;
  }

 private:
  static constexpr std::uint32_t kEmpty = ~std::uint32_t{0};
  static constexpr std::size_t kSmallest = 16;

  /// Returns the slot that holds n, or the empty one where it belongs.
  [[nodiscard]] std::size_t place_of(const Vec3& n) const {
    const Bits wanted = bits_of(n);
    std::uint64_t hash = 0;
    for (const std::uint64_t word : wanted) {  // odd constant: 2^64 over the golden ratio
      hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32;
    }
    const std::size_t mask = slot_.size() - 1;
    std::size_t i = hash & mask;
    while (slot_[i] != kEmpty && bits_of(seen_[slot_[i]]) != wanted) i = (i + 1) & mask;
    return i;
  }

  void grow() {
    slot_.assign(2 * slot_.size(), kEmpty);
    for (std::size_t i = 0; i < seen_.size(); ++i) slot_[place_of(seen_[i])] = static_cast<std::uint32_t>(i);
  }

  std::vector<Vec3>& seen_;
  std::vector<std::uint32_t> slot_;  // a power of two in number, at most half full
};

}  // namespace

CompactNormals::CompactNormals(const SurfaceNormals& normals) : corner_(normals.corner.size()) {
  Numbering numbering(normal_);
  for (std::size_t t = 0; t < corner_.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const bool open = (normals.open_edges[t] >> k & 1) != 0;
      corner_[t][k] = numbering.number(normals.corner[t][k]) | (open ? kOpen : 0U);
    }
  }
  normal_.shrink_to_fit();
}

}  // namespace phalanx
