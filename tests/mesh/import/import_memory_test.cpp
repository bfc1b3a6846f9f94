// SPDX-License-Identifier: Apache-2.0
// What importing costs, as multiples of the file's size. PHALANX_MESH_TRIANGLES sets how large the made files
// are (docs/meshes.md has the table for a million).
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

#include "mesh/import/measured_heap.h"
#include "mesh/import/mesh_files.h"
#include "phalanx/mesh/import.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

/// Assimp's .obj reader has a buffer of 16 MiB, however small the file.
constexpr std::size_t kFloor = std::size_t{20} << 20;

int triangles_wanted() {
  const char* text = std::getenv("PHALANX_MESH_TRIANGLES");
  return text != nullptr ? std::atoi(text) : 100'000;
}

double times(std::size_t bytes, std::size_t file) {
  return static_cast<double>(bytes) / static_cast<double>(file);
}

void expect_modest(const std::string& content, const std::string& format, const std::string& name) {
  const auto start = std::chrono::steady_clock::now();
  test::reset_heap();
  const ImportedMesh imported = import_and_check_from_memory(content.data(), content.size(), format);
  const test::Heap parent = test::heap_of_this_process();
  const test::Heap child = test::heap_of_children();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  std::printf(
      "%-10s %9zu triangles %11zu bytes; peak: program %.2fx, reader %.2fx; largest block: %.2fx, %.2fx; "
      "%.2f s\n",
      name.c_str(), imported.report.triangles, content.size(), times(parent.peak, content.size()),
      times(child.peak, content.size()), times(parent.largest, content.size()),
      times(child.largest, content.size()), took.count());
  EXPECT_TRUE(imported.report.closed);
  for (const auto& [what, bytes] : {std::pair{"program's peak", parent.peak},
                                    {"reader's peak", child.peak},
                                    {"program's largest block", parent.largest},
                                    {"reader's largest block", child.largest}})
    EXPECT_LE(bytes, 8 * content.size() + kFloor) << what << ", " << name;
}

TEST(ImportMemory, OfEveryFileOfTheCorpusIsAFewTimesItsSize) {
  namespace fs = std::filesystem;
  const fs::path corpus = "/usr/share/assimp/models";
  if (!fs::is_directory(corpus)) GTEST_SKIP() << corpus << " is not there; install assimp-testmodels";
  double worst = 0.0;
  int files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(corpus)) {
    if (!entry.is_regular_file()) continue;
    test::reset_heap();
    try {
      (void)import_and_check(entry.path(), {.size = 0.09});
      ++files;
    } catch (const std::invalid_argument&) {  // refused: must have cost no more
    }
    const std::size_t most = std::max(test::heap_of_this_process().peak, test::heap_of_children().peak);
    EXPECT_LE(most, 8 * entry.file_size() + kFloor) << entry.path();
    if (entry.file_size() > 512 * 1024) worst = std::max(worst, times(most, entry.file_size()));
  }
  EXPECT_GT(files, 0);
  std::printf("worst of the corpus' files above 512 KiB: %.2fx\n", worst);
}

TEST(ImportMemory, IsAFewTimesTheFilesSize) {
  const TriangleMesh mesh = make_torus(0.06, 0.03, triangles_wanted());
  expect_modest(test::to_stl_binary(mesh), "stl", "stl");
  expect_modest(test::to_stl_text(mesh), "stl", "stl text");
  expect_modest(test::to_ply_binary(mesh), "ply", "ply");
  expect_modest(test::to_ply_text(mesh), "ply", "ply text");
  expect_modest(test::to_obj(mesh), "obj", "obj");
  expect_modest(test::to_glb(mesh), "glb", "glb");
  expect_modest(test::to_3ds(make_torus(0.06, 0.03, 60'000)), "3ds", "3ds");  // its counts have 16 bits
}

}  // namespace
}  // namespace phalanx
