// SPDX-License-Identifier: Apache-2.0
// Uses phalanx::import as installed: reads a tetrahedron and makes an object of it. What it needs of
// phalanx::phalanx must come by itself.
#include <cstdio>
#include <exception>
#include <string>

#include "phalanx/contact/object_model.h"
#include "phalanx/mesh/import.h"

int main() try {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  const auto imported = phalanx::import_and_check_from_memory(obj.data(), obj.size(), "obj", {.size = 0.05});
  const phalanx::ObjectModel object(imported.mesh);
  std::printf("%d triangles, volume %.3g m^3\n", object.triangle_count(), imported.report.volume);
  return object.triangle_count() == 4 && imported.report.closed ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
