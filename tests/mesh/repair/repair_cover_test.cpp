// SPDX-License-Identifier: Apache-2.0
// What is handed back covers the file's own triangles, and nothing else, to the stated tolerance: the promise
// on which the forces rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "mesh/import/assimp_reader.h"
#include "mesh/import/deviation.h"
#include "mesh/repair/repair.h"
#include "phalanx/mesh/isolation/isolated.h"
#include "phalanx/mesh/primitives.h"
#include "support/sanitized.h"

namespace phalanx::mesh {
namespace {

namespace fs = std::filesystem;

std::string format_of(const fs::path& file) {
  std::string text = file.extension().string();
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text.empty() ? text : text.substr(1);
}

/// The reader's triangles but for those with two equal corners, whose vertices then do not count.
TriangleMesh without_equal_corners(const TriangleMesh& soup) {
  TriangleMesh out;
  for (const Triangle& t : soup.triangles) {
    const auto at = [&](std::size_t k) -> const Vec3& {
      return soup.vertices[static_cast<std::size_t>(t[k])];
    };
    if (at(0) == at(1) || at(1) == at(2) || at(2) == at(0)) continue;
    const auto first = static_cast<std::int32_t>(out.vertices.size());
    for (std::size_t k = 0; k < 3; ++k) out.vertices.push_back(at(k));
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

void expect_covered(const TriangleMesh& soup) {
  MeshReport report;
  const TriangleMesh mesh = repair(soup, {}, "test", report);
  const SurfaceDeviation off = measure_deviation(without_equal_corners(soup), mesh);
  EXPECT_LE(off.outward, report.tolerance);
  EXPECT_LE(off.inward, report.tolerance);
  EXPECT_LE(report.moved, report.tolerance);
  EXPECT_LE(report.tolerance, 1e-6);
}

TEST(RepairCovers, WhateverTheCorpusHolds) {
  const fs::path corpus = "/usr/share/assimp/models";
  if (!fs::is_directory(corpus)) GTEST_SKIP() << corpus << " is not there; install assimp-testmodels";
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(corpus)) {
    const std::string format = format_of(entry.path());
    const std::vector<std::string> known = {"obj", "3ds", "stl", "ply", "glb"};
    if (!entry.is_regular_file() || std::find(known.begin(), known.end(), format) == known.end()) continue;
    SCOPED_TRACE(entry.path().string());
    std::ifstream in(entry.path(), std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
    TriangleMesh soup;
    try {
      soup = run_isolated([&] { return read_with_assimp(bytes.data(), bytes.size(), format, "test"); },
                          "test", {});
      soup = without_equal_corners(soup);
      check_mesh(soup, "test");
    } catch (const std::invalid_argument&) {
      continue;  // tests/step/mesh_corpus_test.cpp looks at what is refused
    }
    if (test::kSlowBuild && soup.triangles.size() > 5000) continue;
    const double largest = (bounds(soup).max - bounds(soup).min).maxCoeff();
    for (Vec3& v : soup.vertices) v *= 0.09 / largest;
    try {
      expect_covered(soup);
      ++files;
    } catch (const std::invalid_argument&) {  // no triangle with an area
    }
  }
  EXPECT_GT(files, 30);
}

// Triangles over each other on a coarse grid, some a little off it: everything that can be wrong at once.
TEST(RepairCovers, ASeededHeapOfTriangles) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937 random(seed);
    const unsigned grid = 2 + seed % 4;
    TriangleMesh soup;
    const auto count = static_cast<std::int32_t>(5 + random() % 60);
    for (std::int32_t i = 0; i < 3 * count; ++i) {
      const auto coordinate = [&] { return 0.01 * static_cast<double>(random() % grid); };
      const Vec3 at(coordinate(), coordinate(), coordinate());
      soup.vertices.push_back(
          at + Vec3(random() % 3 == 0 ? 0.1e-6 * static_cast<double>(random() % 3) : 0.0, 0, 0));
    }
    for (std::int32_t i = 0; i < count; ++i) soup.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    soup = without_equal_corners(soup);
    if (soup.triangles.empty()) continue;
    try {
      expect_covered(soup);
    } catch (const std::invalid_argument&) {  // nothing but flat ones
    }
  }
}

}  // namespace
}  // namespace phalanx::mesh
