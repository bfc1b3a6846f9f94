// SPDX-License-Identifier: Apache-2.0
// Files as they are found: a clean mesh, spoilt in known ways and written as OBJ.
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"

namespace phalanx::test {

/// A folder of this process, gone at the end.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(std::filesystem::temp_directory_path() / ("phalanx_dirty_" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// Kinds of dirt, to be added up.
namespace dirt {
enum Dirt : unsigned {
  kSoup = 1,            ///< every triangle has its own vertices
  kFlipped = 2,         ///< a fifth of the faces, turned over
  kInsideOut = 4,       ///< all of them
  kDuplicated = 8,      ///< faces that stand twice, some the other way round
  kDegenerate = 16,     ///< faces of two corners, or of three in line
  kTJunctions = 32,     ///< an edge split on one side only
  kHoles = 64,          ///< faces left out
  kUnreferenced = 128,  ///< vertices far away that no face uses
};
}  // namespace dirt

/// Writes an OBJ of `clean` with this dirt.
inline void write_dirty(const TriangleMesh& clean, unsigned kinds, std::uint64_t seed,
                        const std::filesystem::path& file) {
  using namespace dirt;
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> u(0.0, 1.0);
  std::vector<Vec3> vertices = clean.vertices;
  std::vector<std::vector<std::int32_t>> faces;
  const auto add = [&](const Vec3& v) {
    vertices.push_back(v);
    return static_cast<std::int32_t>(vertices.size() - 1);
  };
  for (const Triangle& t : clean.triangles) {
    if ((kinds & kHoles) != 0 && u(random) < 0.02) continue;
    std::vector<std::int32_t> face(t.begin(), t.end());
    if ((kinds & kTJunctions) != 0 && u(random) < 0.1) {
      const Vec3 middle =
          0.5 * (vertices[static_cast<std::size_t>(t[0])] + vertices[static_cast<std::size_t>(t[1])]);
      const std::int32_t m = add(middle);
      faces.push_back({t[0], m, t[2]});
      face = {m, t[1], t[2]};
    }
    faces.push_back(face);
    if ((kinds & kDuplicated) != 0 && u(random) < 0.1) {
      std::vector<std::int32_t> again = face;
      if (u(random) < 0.5) std::swap(again[0], again[1]);
      faces.push_back(again);
    }
    if ((kinds & kDegenerate) != 0 && u(random) < 0.1) {
      faces.push_back({t[0], t[1], t[0]});
      faces.push_back(
          {t[0], t[1],
           add(0.5 * (vertices[static_cast<std::size_t>(t[0])] + vertices[static_cast<std::size_t>(t[1])]))});
    }
  }
  for (std::vector<std::int32_t>& face : faces) {
    const bool flip = (kinds & kInsideOut) != 0 || ((kinds & kFlipped) != 0 && u(random) < 0.2);
    if (flip) std::reverse(face.begin(), face.end());
  }
  if ((kinds & kSoup) != 0) {
    for (std::vector<std::int32_t>& face : faces)
      for (std::int32_t& v : face) v = add(vertices[static_cast<std::size_t>(v)]);
  }
  if ((kinds & kUnreferenced) != 0) {
    for (int n = 0; n < 50; ++n) add(Vec3(5.0 * u(random), -7.0 * u(random), u(random)));
  }
  std::ofstream out(file);
  out.precision(9);
  for (const Vec3& v : vertices) out << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const std::vector<std::int32_t>& face : faces) {
    out << 'f';
    for (const std::int32_t v : face) out << ' ' << v + 1;
    out << '\n';
  }
}

}  // namespace phalanx::test
