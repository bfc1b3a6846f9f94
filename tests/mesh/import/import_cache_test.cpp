// SPDX-License-Identifier: Apache-2.0
// What the cache of imported meshes finds, what it does not, and what it drops.
#include "phalanx/mesh/import_cache.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "mesh/import/import_bytes.h"
#include "mesh/import/mesh_files.h"
#include "phalanx/mesh/primitives.h"
#include "record/temporary_folder.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using testing::TemporaryFolder;

fs::path written(const fs::path& file, const std::string& content) {
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

std::string ball() { return test::to_obj(make_sphere(0.06, 200)); }

/// @returns a mesh without a triangle: in the cache it counts as the content of its file
ImportedMesh weightless() { return {}; }

std::string cached_refusal(const fs::path& file, ImportCache* cache) {
  try {
    static_cast<void>(import_and_check(file, {}, cache));
  } catch (const std::invalid_argument& refused) {
    return refused.what();
  }
  return "accepted";
}

TEST(ImportCache, AFileIsImportedOnceAndItsMeshAndReportAreTheSame) {
  const TemporaryFolder folder;
  const fs::path file = written(folder / "ball.obj", ball());
  const ImportOptions options{.size = 0.09, .triangles = 100};
  const std::string expected = mesh::to_bytes(import_and_check(file, options));
  ImportCache cache;
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(mesh::to_bytes(import_and_check(file, options, &cache)), expected);
    EXPECT_EQ(cache.misses(), 1U);
    EXPECT_EQ(cache.hits(), n);
  }
}

TEST(ImportCache, AFileIsFoundByItsContentNotByItsName) {
  const TemporaryFolder folder;
  ImportCache cache;
  const auto import_it = [&](const fs::path& file) { return import_and_check(file, {}, &cache); };
  static_cast<void>(import_it(written(folder / "ball.obj", ball())));
  static_cast<void>(import_it(written(folder / "COPY.OBJ", ball())));
  EXPECT_EQ(cache.misses(), 1U);
  // Of the same length, under the name that is known.
  std::string other = ball();
  const std::size_t digit = other.find_first_of("123456789");
  other[digit] = other[digit] == '1' ? '2' : '1';
  const std::string expected = mesh::to_bytes(import_and_check(written(folder / "other.obj", other)));
  EXPECT_EQ(mesh::to_bytes(import_it(written(folder / "ball.obj", other))), expected);
  EXPECT_EQ(cache.misses(), 2U);
}

TEST(ImportCache, AnotherFormatOrOptionIsAnotherImport) {
  ImportCache cache;
  cache.keep("content", "obj", {.size = 0.0, .unit = 1e-3, .triangles = 100}, weightless());
  const auto finds = [&](const std::string& content, const std::string& format,
                         const ImportOptions& options) {
    return cache.find(content, format, options) != nullptr;
  };
  EXPECT_TRUE(finds("content", "obj", {.size = 0.0, .unit = 1e-3, .triangles = 100}));
  EXPECT_FALSE(finds("Content", "obj", {.size = 0.0, .unit = 1e-3, .triangles = 100}));
  EXPECT_FALSE(finds("content ", "obj", {.size = 0.0, .unit = 1e-3, .triangles = 100}));
  EXPECT_FALSE(finds("content", "ply", {.size = 0.0, .unit = 1e-3, .triangles = 100}));
  EXPECT_FALSE(finds("content", "obj", {.size = 0.1, .unit = 1e-3, .triangles = 100}));
  EXPECT_FALSE(finds("content", "obj", {.size = 0.0, .unit = 1e-2, .triangles = 100}));
  EXPECT_FALSE(finds("content", "obj", {.size = 0.0, .unit = 1e-3, .triangles = 101}));
  EXPECT_EQ(cache.hits(), 1U);
  EXPECT_EQ(cache.misses(), 6U);
}

TEST(ImportCache, TheUnitCountsOnlyWithoutASize) {
  const TemporaryFolder folder;
  const fs::path file = written(folder / "ball.obj", ball());
  ImportCache cache;
  const std::string in_m = mesh::to_bytes(import_and_check(file, {.size = 0.09, .unit = 1.0}, &cache));
  const ImportOptions in_mm{.size = 0.09, .unit = 1e-3};
  EXPECT_EQ(mesh::to_bytes(import_and_check(file, in_mm, &cache)), in_m);
  EXPECT_EQ(cache.hits(), 1U);
  EXPECT_EQ(mesh::to_bytes(import_and_check(file, in_mm)), in_m);
}

TEST(ImportCache, TheLimitOfTrianglesHoldsForMeshesThatAreFound) {
  const TemporaryFolder folder;
  const fs::path file = written(folder / "ball.obj", ball());
  ImportCache cache;
  const std::size_t triangles = import_and_check(file, {}, &cache).report.triangles_in_file;
  EXPECT_NO_THROW(static_cast<void>(import_and_check(file, {.most_triangles = triangles}, &cache)));
  EXPECT_EQ(cache.misses(), 1U);
  EXPECT_THROW(static_cast<void>(import_and_check(file, {.most_triangles = triangles - 1}, &cache)),
               std::invalid_argument);
}

TEST(ImportCache, ARefusalIsNotKept) {
  const TemporaryFolder folder;
  const fs::path file = written(folder / "ball.obj", "v 0 0 0\nv 1 0 0\nf 1 2 3\n");
  ImportCache cache;
  const std::string expected = cached_refusal(file, nullptr);
  EXPECT_NE(expected, "accepted");
  EXPECT_EQ(cached_refusal(file, &cache), expected);
  EXPECT_EQ(cached_refusal(file, &cache), expected);
  EXPECT_EQ(cache.misses(), 2U);
  EXPECT_EQ(cache.bytes(), 0U);
  EXPECT_EQ(cached_refusal(written(file, ball()), &cache), "accepted");
  EXPECT_GT(cache.bytes(), 0U);
  EXPECT_EQ(cached_refusal(folder / "none.obj", &cache), cached_refusal(folder / "none.obj", nullptr));
}

TEST(ImportCache, DropsTheMeshWhoseLastUseIsTheLongestAgo) {
  ImportCache cache(300);
  const auto content = [](char c) { return std::string(100, c); };
  const auto has = [&](char c) { return cache.find(content(c), "obj", {}) != nullptr; };
  for (const char c : {'a', 'b', 'c'}) cache.keep(content(c), "obj", {}, weightless());
  EXPECT_EQ(cache.bytes(), 300U);
  EXPECT_TRUE(has('a'));  // used after b
  cache.keep(content('d'), "obj", {}, weightless());
  EXPECT_EQ(cache.bytes(), 300U);
  EXPECT_FALSE(has('b'));
  for (const char c : {'a', 'c', 'd'}) EXPECT_TRUE(has(c)) << c;
}

TEST(ImportCache, AMeshBeyondTheBoundIsNotKeptAndDropsNothing) {
  ImportCache cache(300);
  cache.keep("small", "obj", {}, weightless());
  cache.keep(std::string(301, 'x'), "obj", {}, weightless());
  EXPECT_EQ(cache.bytes(), 5U);
  ImportedMesh heavy;
  heavy.mesh = make_sphere(0.06, 200);
  cache.keep("heavy", "obj", {}, heavy);
  EXPECT_EQ(cache.bytes(), 5U);
  EXPECT_NE(cache.find("small", "obj", {}), nullptr);
}

TEST(ImportCache, AMeshThatIsKeptTwiceCountsOnce) {
  ImportCache cache;
  ImportedMesh imported;
  imported.mesh = make_sphere(0.06, 200);
  for (int n = 0; n < 2; ++n) cache.keep("content", "obj", {}, imported);
  EXPECT_EQ(cache.bytes(), 7U + imported.mesh.vertices.size() * sizeof(Vec3) +
                               imported.mesh.triangles.size() * sizeof(Triangle));
}

// Another thread may drop the mesh meanwhile.
TEST(ImportCache, AMeshThatWasFoundOutlivesItsPlace) {
  ImportCache cache(300);
  ImportedMesh imported;
  imported.mesh.vertices.assign(10, Vec3::Ones());
  cache.keep("first", "obj", {}, imported);
  const auto found = cache.find("first", "obj", {});
  ASSERT_NE(found, nullptr);
  cache.keep(std::string(290, 'x'), "obj", {}, weightless());
  EXPECT_EQ(cache.find("first", "obj", {}), nullptr);
  EXPECT_EQ(found->mesh.vertices, imported.mesh.vertices);
}

}  // namespace
}  // namespace phalanx
