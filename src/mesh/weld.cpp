// SPDX-License-Identifier: Apache-2.0
#include "mesh/weld.h"

#include <algorithm>
#include <numeric>

namespace phalanx::mesh {

TriangleMesh weld(const TriangleMesh& soup) {
  const std::size_t n = soup.vertices.size();
  const auto before = [&](std::size_t a, std::size_t b) {
    const Vec3& p = soup.vertices[a];
    const Vec3& q = soup.vertices[b];
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  };
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), before);
  std::vector<std::size_t> same(n);  // the first vertex at the same position
  for (std::size_t i = 0; i < n; ++i)
    same[order[i]] = i > 0 && !before(order[i - 1], order[i]) ? same[order[i - 1]] : order[i];

  TriangleMesh out;
  std::vector<std::int32_t> renumbered(n, -1);
  for (const Triangle& t : soup.triangles) {
    Triangle welded{};
    for (std::size_t k = 0; k < 3; ++k)
      welded[k] = static_cast<std::int32_t>(same[static_cast<std::size_t>(t[k])]);
    if (welded[0] == welded[1] || welded[1] == welded[2] || welded[2] == welded[0]) continue;
    for (std::int32_t& i : welded) {
      std::int32_t& number = renumbered[static_cast<std::size_t>(i)];
      if (number < 0) {
        number = static_cast<std::int32_t>(out.vertices.size());
        out.vertices.push_back(soup.vertices[static_cast<std::size_t>(i)]);
      }
      i = number;
    }
    out.triangles.push_back(welded);
  }
  return out;
}

}  // namespace phalanx::mesh
