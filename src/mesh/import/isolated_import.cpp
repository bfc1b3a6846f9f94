// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/isolated_import.h"

#include <cstring>
#include <type_traits>

#include "mesh/import/decimate.h"
#include "mesh/import/import_bytes.h"
#include "phalanx/mesh/isolation/isolation_helper.h"

namespace phalanx::mesh {
namespace {

static_assert(std::is_trivially_copyable_v<ImportOptions>);

/// Calls import_and_check_from_memory() for "options format NUL content". @returns the result's bytes
std::string import_packed(const std::string& packed) {
  ImportOptions options;
  std::memcpy(&options, packed.data(), sizeof options);
  const std::size_t end = packed.find('\0', sizeof options);
  const std::string_view content = std::string_view(packed).substr(end + 1);
  return to_bytes(import_and_check_from_memory(content.data(), content.size(),
                                               packed.substr(sizeof options, end - sizeof options), options));
}

/// Calls picture_of() for "triangles mesh".
TriangleMesh picture_packed(const std::string& packed) {
  std::size_t triangles = 0;
  std::memcpy(&triangles, packed.data(), sizeof triangles);
  return picture_of(from_bytes(std::string_view(packed).substr(sizeof triangles), "mesh").mesh, triangles);
}

}  // namespace

ImportedMesh import_isolated(std::string_view content, const std::string& format,
                             const ImportOptions& options, const std::string& origin,
                             const IsolationLimits& limits) {
  std::string packed(reinterpret_cast<const char*>(&options), sizeof options);
  packed.append(format).push_back('\0');
  packed.append(content);
  return from_bytes(run_isolated_work(import_packed, packed, origin, limits), origin);
}

TriangleMesh picture_isolated(const TriangleMesh& mesh, std::size_t triangles, const std::string& origin,
                              const IsolationLimits& limits) {
  if (mesh.triangles.size() <= triangles) return mesh;
  std::string packed(reinterpret_cast<const char*>(&triangles), sizeof triangles);
  packed.append(to_bytes({mesh, {}}));
  return run_isolated_mesh(picture_packed, packed, origin, limits);
}

}  // namespace phalanx::mesh
