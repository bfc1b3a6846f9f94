// SPDX-License-Identifier: Apache-2.0
// Whatever bytes a mesh file holds, importing it gives a mesh or std::invalid_argument. The first byte
// selects the format; or the bytes are a heap of triangles on a coarse grid, which is repaired without a
// file.
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "mesh/repair/repair.h"
#include "phalanx/mesh/import.h"

namespace {

void demand(bool holds) {
  if (!holds) __builtin_trap();
}

void check(const phalanx::ImportedMesh& imported) {
  phalanx::check_mesh(imported.mesh, "fuzzed mesh");  // what is let through is valid
  demand(!imported.mesh.triangles.empty());
  demand(imported.report.triangles == imported.mesh.triangles.size());
  demand(imported.report.closed == phalanx::is_closed(imported.mesh));
  for (const phalanx::MeshFinding& f : imported.report.findings) demand(f.found >= f.repaired && f.found > 0);
}

/// Vertices are one of 8 x 8 x 8 grid points, some a little beside it: whatever can go wrong between
/// triangles does.
void repair_heap(const std::uint8_t* data, std::size_t size) {
  using namespace phalanx;
  TriangleMesh soup;
  for (; size >= 6; data += 6, size -= 6) {
    Triangle t{};
    for (std::size_t k = 0; k < 3; ++k) {
      const int code = data[2 * k] | (data[2 * k + 1] << 8);
      const double nudge = ((code >> 9) & 7) * 0.2e-6;
      t[k] = static_cast<std::int32_t>(soup.vertices.size());
      soup.vertices.emplace_back((code & 7) * 0.01 + nudge, ((code >> 3) & 7) * 0.01,
                                 ((code >> 6) & 7) * 0.01);
    }
    soup.triangles.push_back(t);
  }
  if (soup.triangles.empty()) return;
  ImportedMesh once;
  once.mesh = mesh::repair(soup, {}, "heap", once.report);
  check(once);
  demand(once.report.moved <= once.report.tolerance);
  MeshReport second;
  (void)mesh::repair(once.mesh, {}, "repaired heap", second);
  // What was held back within the tolerance of the first repair, the second may do.
  for (const MeshFinding& f : second.findings) demand(once.report.held_back || f.repaired == 0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::array<const char*, 5> kFormats = {"obj", "3ds", "stl", "ply", "glb"};
  if (size == 0) return 0;
  try {
    const std::size_t what = data[0] % (kFormats.size() + 1);
    if (what == kFormats.size()) {
      repair_heap(data + 1, size - 1);
    } else {
      const phalanx::ImportOptions options{.size = data[0] < 128 ? 0.1 : 0.0, .unit = 1e-3};
      check(phalanx::import_and_check_from_memory(data + 1, size - 1, kFormats[what], options));
    }
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
