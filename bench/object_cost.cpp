// SPDX-License-Identifier: Apache-2.0
#include "object_cost.h"

#include <malloc.h>

#include <algorithm>
#include <limits>

#include "phalanx/contact/object_model.h"
#include "stopwatch.h"

namespace phalanx::bench {
namespace {

/// Bytes that the heap has handed out.
double heap_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

}  // namespace

ObjectCost object_cost(const TriangleMesh& mesh) {
  ObjectCost cost;
  const auto triangles = static_cast<double>(mesh.triangles.size());
  cost.triangles = static_cast<int>(mesh.triangles.size());
  cost.build_s = std::numeric_limits<double>::infinity();
  for (int repeat = 0; repeat < 3; ++repeat) {
    const double before = heap_in_use();
    TriangleMesh copy = mesh;
    cost.mesh_bytes_a_triangle = (heap_in_use() - before) / triangles;
    const Stopwatch watch;
    const ObjectModel model(std::move(copy));
    cost.build_s = std::min(cost.build_s, 1e-6 * watch.us());
    cost.bytes_a_triangle = (heap_in_use() - before) / triangles;
  }
  return cost;
}

}  // namespace phalanx::bench
