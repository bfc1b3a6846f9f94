// SPDX-License-Identifier: Apache-2.0
// Whatever bytes a mesh file holds, importing it gives a mesh or std::invalid_argument. The first byte
// selects the format.
#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>

#include "phalanx/mesh/import.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static constexpr std::array<const char*, 5> kFormats = {"obj", "3ds", "stl", "ply", "glb"};
  if (size == 0) return 0;
  try {
    const phalanx::TriangleMesh mesh =
        phalanx::import_mesh_from_memory(data + 1, size - 1, kFormats[data[0] % kFormats.size()], 0.1);
    phalanx::check_mesh(mesh, "fuzzed mesh");  // what is let through is valid
    if (mesh.triangles.empty()) __builtin_trap();
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
