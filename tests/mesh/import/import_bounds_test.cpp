// SPDX-License-Identifier: Apache-2.0
// What is just inside a limit of the import, and what is just outside.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "mesh/import/assimp_reader.h"
#include "mesh/import/mesh_files.h"
#include "mesh/import/obj_reduce.h"
#include "mesh/repair/near_vertices.h"
#include "mesh/repair/repair.h"
#include "mesh/repair/t_junctions.h"
#include "mesh/repair/weld.h"
#include "phalanx/core/math.h"
#include "phalanx/mesh/import.h"
#include "phalanx/mesh/isolation/isolation_helper.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string refusal_in_bounds(const std::string& content, const std::string& format,
                              const ImportOptions& options = {}) {
  try {
    (void)import_and_check_from_memory(content.data(), content.size(), format, options);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

/// A .glb with the first `from` in its JSON replaced.
std::string with_json(const std::string& glb, const std::string& from, const std::string& to) {
  std::uint32_t length = 0;
  std::memcpy(&length, glb.data() + 12, sizeof length);
  std::string json = glb.substr(20, length);
  const std::size_t at = json.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  if (at != std::string::npos) json.replace(at, from.size(), to);
  while (json.size() % 4 != 0) json += ' ';
  const std::string bin = glb.substr(20 + length);
  std::string out = "glTF";
  test::put(out, std::uint32_t{2});
  test::put(out, static_cast<std::uint32_t>(20 + json.size() + bin.size()));
  test::put(out, static_cast<std::uint32_t>(json.size()));
  return out + "JSON" + json + bin;
}

// Counted from 0: of n vertices the last is n - 1.
TEST(ImportBounds, TheFirstVertexThatDoesNotExistIsRefusedInEveryFormat) {
  const TriangleMesh good = make_sphere(0.1, 40);
  TriangleMesh bad = good;
  const std::size_t n = good.vertices.size();
  bad.triangles[5][2] = static_cast<std::int32_t>(n);
  const std::string names = "face 5 names vertex " + std::to_string(n);
  for (const auto& [format, write] :
       {std::pair{"ply", &test::to_ply_text}, {"ply", &test::to_ply_binary}, {"3ds", &test::to_3ds}}) {
    EXPECT_EQ(refusal_in_bounds(write(good), format), "accepted") << format;
    EXPECT_THAT(refusal_in_bounds(write(bad), format),
                AllOf(HasSubstr("face 5"), HasSubstr("vertex " + std::to_string(n))))
        << format;
  }
  EXPECT_EQ(refusal_in_bounds(test::to_glb(good), "glb"), "accepted");
  EXPECT_THAT(refusal_in_bounds(test::to_glb(bad), "glb"), HasSubstr(names));
}

// A glTF accessor has an offset of its own beside its view's; here the indices' view begins with the
// positions.
TEST(ImportBounds, AGlbsIndicesAreReadWhereItsAccessorSays) {
  const auto shifted = [](const TriangleMesh& mesh) {
    const std::string positions = std::to_string(12 * mesh.vertices.size());
    const std::string indices = std::to_string(12 * mesh.triangles.size());
    const std::string both = std::to_string(12 * (mesh.vertices.size() + mesh.triangles.size()));
    const std::string view = with_json(
        test::to_glb(mesh), R"({"buffer":0,"byteOffset":)" + positions + R"(,"byteLength":)" + indices + "}",
        R"({"buffer":0,"byteLength":)" + both + "}");
    return with_json(view, R"({"bufferView":1,)", R"({"bufferView":1,"byteOffset":)" + positions + ",");
  };
  TriangleMesh mesh = make_sphere(0.1, 40);
  EXPECT_EQ(refusal_in_bounds(shifted(mesh), "glb"), "accepted");
  mesh.triangles[7][1] = static_cast<std::int32_t>(mesh.vertices.size());
  EXPECT_THAT(refusal_in_bounds(shifted(mesh), "glb"), HasSubstr("face 7"));
}

TEST(ImportBounds, AGlbsTrianglesHaveThreeCornersEach) {
  const TriangleMesh mesh = make_sphere(0.1, 40);
  const std::size_t corners = 3 * mesh.triangles.size();
  const auto count = [](std::size_t n) { return R"("SCALAR","count":)" + std::to_string(n); };
  for (const std::size_t fewer : {1U, 2U}) {
    EXPECT_THAT(
        refusal_in_bounds(with_json(test::to_glb(mesh), count(corners), count(corners - fewer)), "glb"),
        AllOf(HasSubstr(std::to_string(corners - fewer) + " corners"), HasSubstr("3 does not divide")));
  }
}

/// A .glb of a tetrahedron's four corners, with indices of this type in its BIN chunk behind 48 bytes of
/// positions.
template <typename Index>
std::string glb_of_four_corners(const std::vector<int>& indices, int component_type, int mode) {
  std::string buffer;
  for (const Vec3& v : {Vec3(0, 0, 0), Vec3(0.1, 0, 0), Vec3(0, 0.1, 0), Vec3(0, 0, 0.1)})
    test::put(buffer, v);
  for (const int i : indices) test::put(buffer, static_cast<Index>(i));
  const auto number = [](auto n) { return std::to_string(n); };
  std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"mode":)" +
      number(mode) + R"(}]}],"buffers":[{"byteLength":)" + number(buffer.size()) +
      R"(}],"bufferViews":[{"buffer":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":)" +
      number(buffer.size() - 48) +
      R"(}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","count":4,)"
      R"("min":[0,0,0],"max":[0.1,0.1,0.1]},{"bufferView":1,"componentType":)" +
      number(component_type) + R"(,"type":"SCALAR","count":)" + number(indices.size()) + "}]}";
  while (json.size() % 4 != 0) json += ' ';
  std::string out = "glTF";
  test::put(out, std::uint32_t{2});
  test::put(out, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  test::put(out, static_cast<std::uint32_t>(json.size()));
  out += "JSON" + json;
  test::put(out, static_cast<std::uint32_t>(buffer.size()));
  return out + std::string("BIN\0", 4) + buffer;
}

// 12 indices are 12 or 24 bytes. Counted from 0, the sixth index is the last corner of face 1.
TEST(ImportBounds, AGlbsIndicesMayBeOneOrTwoBytesWide) {
  std::vector<int> indices = {0, 2, 1, 0, 1, 3, 1, 2, 3, 2, 0, 3};
  for (const int bad : {0, 4}) {
    if (bad != 0) indices[5] = bad;
    for (const std::string& glb : {glb_of_four_corners<std::uint8_t>(indices, 5121, 4),
                                   glb_of_four_corners<std::uint16_t>(indices, 5123, 4)}) {
      if (bad != 0) {
        EXPECT_THAT(refusal_in_bounds(glb, "glb"), HasSubstr("face 1 names vertex 4, but its mesh has 4"));
      } else {
        EXPECT_EQ(import_and_check_from_memory(glb.data(), glb.size(), "glb").mesh.triangles.size(), 4U);
      }
    }
  }
}

// Mode 5 is a strip: n corners are n - 2 triangles, whether 3 divides n or not.
TEST(ImportBounds, AGlbsStripMayHaveFourCorners) {
  const std::string glb = glb_of_four_corners<std::uint8_t>({0, 1, 2, 3}, 5121, 5);
  EXPECT_EQ(refusal_in_bounds(glb, "glb"), "accepted");
  EXPECT_EQ(import_and_check_from_memory(glb.data(), glb.size(), "glb").mesh.triangles.size(), 2U);
}

// Looks and lights change no surface; what packs the numbers otherwise does.
TEST(ImportBounds, AGlbMayRequireExtensionsForItsLooksOnly) {
  const auto requiring = [](const std::string& extension) {
    return with_json(test::to_glb(make_sphere(0.1, 40)), R"({"asset")",
                     R"({"extensionsRequired":[")" + extension + R"("],"asset")");
  };
  for (const char* looks :
       {"KHR_materials_unlit", "KHR_texture_transform", "EXT_texture_webp", "KHR_lights_punctual"})
    EXPECT_EQ(refusal_in_bounds(requiring(looks), "glb"), "accepted") << looks;
  EXPECT_THAT(refusal_in_bounds(requiring("EXT_meshopt_compression"), "glb"),
              HasSubstr("requires the glTF extension 'EXT_meshopt_compression'"));
  // Assimp itself reads this one, if it was built to.
  EXPECT_THAT(refusal_in_bounds(requiring("KHR_draco_mesh_compression"), "glb"),
              ::testing::Not(HasSubstr("requires the glTF extension")));
}

TEST(ImportBounds, AsManyTrianglesAsMayBeAreTaken) {
  const std::string cube = test::to_obj(make_box({0.1, 0.1, 0.1}, 12));
  EXPECT_EQ(refusal_in_bounds(cube, "obj", {.most_triangles = 12}), "accepted");
  EXPECT_THAT(refusal_in_bounds(cube, "obj", {.most_triangles = 11}),
              AllOf(HasSubstr("12 triangles"), HasSubstr("the limit is 11")));
}

// Vertices 0 and 3 stand at one place: whichever two corners they are, the triangle has no area.
TEST(WeldBounds, DropsATriangleWhicheverTwoOfItsCornersAreOne) {
  TriangleMesh soup;
  soup.vertices = {{0, 0, 0}, {0.01, 0, 0}, {0, 0.01, 0}, {0, 0, 0}};
  for (const Triangle& flat : {Triangle{0, 3, 1}, Triangle{1, 0, 3}, Triangle{0, 1, 3}}) {
    soup.triangles = {{0, 1, 2}, flat};
    mesh::WeldCounts counts;
    const TriangleMesh welded = mesh::weld(soup, &counts);
    EXPECT_EQ(counts.degenerate, 1U);
    EXPECT_EQ(counts.duplicates, 1U);
    EXPECT_EQ(welded.triangles, (std::vector<Triangle>{{0, 1, 2}}));
  }
}

// An edge of 40 sqrt(2) mm, aslant, so that the box around it holds the vertex beside it in any case. Its
// largest extent is 40 mm, the tolerance 1e-5 of that, and a step may move a point by a sixth of it: 0.0667
// um.
TEST(RepairBounds, AVertexBesideAnEdgeIsPutOnItWithinASixthOfTheTolerance) {
  for (const double off : {0.06e-6, 0.075e-6, 0.12e-6}) {
    const Vec3 along = Vec3(1, 1, 0).normalized();
    const Vec3 across = Vec3(-1, 1, 0).normalized();
    const auto at = [&](double x, double y) { return Vec3(x * along + y * across); };
    TriangleMesh strip;
    strip.vertices = {at(0, 0),        at(0.0282842712, off), at(0.0565685425, 0),
                      at(0.028, 0.02), at(0.014, -0.02),      at(0.042, -0.02)};
    strip.triangles = {{0, 2, 3}, {0, 4, 1}, {1, 5, 2}};
    MeshReport report;
    (void)mesh::repair(strip, {}, "test", report);
    const MeshFinding beside = report.finding(FindingKind::kTJunctions);
    EXPECT_EQ(beside.found, off < report.tolerance / 6.0 ? 1U : 0U) << off;
    if (beside.found > 0) {
      EXPECT_NEAR(beside.size, off, 1e-12);
      ASSERT_TRUE(beside.at);
      EXPECT_LT((*beside.at - strip.vertices[1]).norm(), 1e-12);
    }
    EXPECT_LT(report.tolerance / 6.0, 0.0755e-6);
    EXPECT_GT(report.tolerance / 6.0, 0.0605e-6);
  }
}

// Two triangles side by side, 0.05 um apart at two corners. Those of the right one move onto the left one's;
// what they had moved before, 0.02 um, counts on.
TEST(RepairBounds, WhatAVertexHadMovedBeforeCountsWhereItGoes) {
  constexpr double kGap = 0.05e-6;
  constexpr double kBefore = 0.02e-6;
  TriangleMesh mesh;
  mesh.vertices = {{-0.04, 0, 0}, {0, 0, 0}, {0, 0.04, 0}, {kGap, 0, 0}, {0.04, 0.04, 0}, {kGap, 0.04, 0}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  mesh::Allowance allowance{0.06e-6, 0.4e-6, {0.0, 0.0, 0.0, kBefore, 0.0, kBefore}};
  const mesh::Mended mended = mesh::merge_near_vertices(mesh, allowance);
  EXPECT_EQ(mended.count, 2U);
  ASSERT_EQ(mesh.vertices.size(), 4U);
  ASSERT_EQ(allowance.spent.size(), 4U);
  for (std::size_t v = 0; v < 4; ++v) {
    const bool taken = mesh.vertices[v].x() == 0.0;
    EXPECT_NEAR(allowance.spent[v], taken ? kBefore + kGap : 0.0, 1e-15) << v;
  }
}

// Three corners in a row, 0.05 um apart, where a step may move a point by 0.06: the second moves to the
// first, and having moved takes in no other.
TEST(RepairBounds, AVertexThatHasMovedTakesNoOtherIn) {
  TriangleMesh mesh;
  for (std::int32_t i = 0; i < 3; ++i) {
    mesh.vertices.emplace_back(0.05e-6 * i, 0, 0);
    mesh.vertices.emplace_back(0.04, 0.01 * (2 * i), 0);
    mesh.vertices.emplace_back(0.04, 0.01 * (2 * i + 1), 0);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  mesh::Allowance allowance{0.06e-6, 0.4e-6, std::vector<double>(9, 0.0)};
  EXPECT_EQ(mesh::merge_near_vertices(mesh, allowance).count, 1U);
  EXPECT_EQ(mesh.vertices.size(), 8U);
}

// Vertex 3 lies 0.9 um beside the first triangle's first edge and is taken in. Vertex 6 lies 0.9 um beside
// the edge from 3 to 4, a quarter of the way: with three quarters of what 3 has moved that is 1.575 um, more
// than the 1.2 um that all steps may move a point. So the second triangle stays as it is, once.
TEST(RepairBounds, AnEdgeWhoseEndHasMovedMeanwhileIsNotSplit) {
  constexpr double kUm = 1e-6;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0},   {100, 0, 0},     {50, -80, 0}, {50, 0.9, 0}, {50, 100.9, 0},
                   {90, 60, 0}, {49.1, 25.9, 0}, {10, 60, 0},  {10, 20, 0}};
  for (Vec3& vertex : mesh.vertices) vertex *= kUm;
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  mesh::Allowance allowance{1.0 * kUm, 1.2 * kUm, std::vector<double>(mesh.vertices.size(), 0.0)};
  const mesh::Mended mended = mesh::split_t_junctions(mesh, allowance);
  EXPECT_EQ(mended.count, 1U);
  EXPECT_NEAR(allowance.spent[3], 0.9 * kUm, 1e-15);
  const std::vector<Triangle> expected = {{0, 3, 2}, {3, 4, 5}, {6, 7, 8}, {3, 1, 2}};
  EXPECT_EQ(mesh.triangles, expected);
}

// The second triangle hangs on the first one's corner and goes through it: its far edge, from (2, 1, 1) to
// (1, 2, -1) cm, meets z = 0 in (1.5, 1.5, 0) cm, where x + y < 4 cm. They cross from the corner to there.
TEST(RepairBounds, TrianglesThatShareACornerMayCross) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {0.04, 0, 0}, {0, 0.04, 0}, {0.02, 0.01, 0.01}, {0.01, 0.02, -0.01}};
  mesh.triangles = {{0, 1, 2}, {0, 3, 4}};
  MeshReport report;
  (void)mesh::repair(mesh, {}, "test", report);
  const MeshFinding crossing = report.finding(FindingKind::kSelfIntersections);
  EXPECT_EQ(crossing.found, 1U);
  EXPECT_NEAR(crossing.size, 0.015 * std::sqrt(2.0), 1e-12);
  // Folded along a common edge they touch, however sharp the fold.
  mesh.triangles = {{0, 1, 2}, {0, 1, 3}};
  (void)mesh::repair(mesh, {}, "test", report);
  EXPECT_EQ(report.finding(FindingKind::kSelfIntersections).found, 0U);
}

TEST(UnitAdvice, TakesThreeMillimetresToThreeMetres) {
  EXPECT_EQ(unit_advice(3e-3, 1.0), "");
  EXPECT_EQ(unit_advice(3.0, 1.0), "");
  EXPECT_NE(unit_advice(2.999e-3, 1.0), "");
  EXPECT_NE(unit_advice(3.001, 1.0), "");
}

// The first unit that makes it 20 mm to 1 m wide: 20 of 1 mm do, 19.9 do not, but 19.9 of 1 cm.
TEST(UnitAdvice, NamesTheFirstUnitThatMakesItTwentyMillimetresToAMetreWide) {
  const auto advises = [](double largest, const std::string& words) {
    return unit_advice(largest, 1.0).find(words) != std::string::npos;
  };
  EXPECT_TRUE(advises(20.0, "are mm (20 mm)"));
  EXPECT_TRUE(advises(19.9, "are cm (199 mm)"));
  EXPECT_TRUE(advises(1000.0, "are mm (1 m)"));
  EXPECT_TRUE(advises(1001.0, "no object for a hand"));
}

std::string own_niceness(const std::string&) { return std::to_string(::getpriority(PRIO_PROCESS, 0)); }

// The loop may run at nice 0, where the system grants nothing better.
TEST(IsolationHelperBounds, GivesWayToTheLoop) {
  const mesh::IsolationHelper helper;
  EXPECT_GE(std::stoi(mesh::run_isolated_work(own_niceness, "", "cup.obj", {})), 5);
}

// The second buffer is another file's. It is not opened, and this file's own bytes are not taken for it.
TEST(ImportBounds, AGlbsOtherFilesAreNotOpened) {
  const TriangleMesh mesh = make_sphere(0.1, 40);
  const std::string other =
      with_json(test::to_glb(mesh), R"(}],"bufferViews":[{"buffer":0)",
                R"(},{"uri":"other.bin","byteLength":)" + std::to_string(12 * mesh.vertices.size()) +
                    R"(}],"bufferViews":[{"buffer":1)");
  EXPECT_THAT(refusal_in_bounds(other, "glb"),
              AllOf(HasSubstr("cannot be read as .glb ("), HasSubstr("other.bin")));
}

// The last triangle names a vertex that does not exist, and the accessor ends before it: the index that
// follows is none of the mesh's.
TEST(ImportBounds, AGlbsIndicesEndWhereItsAccessorSays) {
  TriangleMesh mesh = make_sphere(0.1, 40);
  mesh.triangles.back()[0] = static_cast<std::int32_t>(mesh.vertices.size());
  const std::size_t corners = 3 * mesh.triangles.size();
  const auto count = [](std::size_t n) { return R"("SCALAR","count":)" + std::to_string(n); };
  EXPECT_EQ(refusal_in_bounds(with_json(test::to_glb(mesh), count(corners), count(corners - 3)), "glb"),
            "accepted");
}

// 12 bytes of header, 8 of the first chunk's length and name.
TEST(ImportBounds, AGlbThatEndsInItsFirstChunksHeaderIsRefusedByItsReader) {
  const std::string glb = test::to_glb(make_sphere(0.1, 40));
  for (const std::size_t bytes : {15U, 16U, 19U, 20U})
    EXPECT_THAT(refusal_in_bounds(glb.substr(0, bytes), "glb"), HasSubstr("cannot be read as .glb")) << bytes;
}

// Behind the mesh its object has another chunk of 8 bytes that is named as the mesh's vertices are, and says
// that there is one. The lengths of the main, editor and object chunks stand at 2, 8 and 14.
TEST(ImportBounds, A3dsMeshEndsWhereItsChunkEnds) {
  std::string more;
  test::put(more, std::uint16_t{1});
  std::string file = test::to_3ds(make_sphere(0.1, 40)) + test::chunk_3ds(0x4110, more);
  for (const std::size_t at : {2U, 8U, 14U}) {
    std::uint32_t length = 0;
    std::memcpy(&length, file.data() + at, sizeof length);
    length += 8;
    std::memcpy(file.data() + at, &length, sizeof length);
  }
  EXPECT_EQ(refusal_in_bounds(file, "3ds"), "accepted");
}

// The largest float is 3.4028234663852886e38; 3.402823466385289e38 is the next double.
TEST(ImportBounds, AnObjsCoordinateMayBeAsLargeAsAFloat) {
  const auto reduced = [](const std::string& x) {
    (void)mesh::reduce_obj("v " + x + " 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n", "cup.obj");
  };
  EXPECT_NO_THROW(reduced("3.4028234663852886e38"));
  EXPECT_NO_THROW(reduced("-3.4028234663852886e38"));
  EXPECT_THROW(reduced("3.402823466385289e38"), std::invalid_argument);
  EXPECT_THROW(reduced("-3.402823466385289e38"), std::invalid_argument);
}

// In um. Vertex 3 lies 0.9 beside the first triangle's first edge, both of whose ends have moved by 0.9: that
// is 1.8, more than the 1.2 that all steps may move a point. Vertex 6 lies in the middle of its second edge,
// of whose ends one has moved: that is 0.45. So the second edge is split, whatever is beside the first.
TEST(RepairBounds, AnEdgeIsSplitThoughAnotherOfItsTriangleMayNotBe) {
  constexpr double kUm = 1e-6;
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0},   {100, 0, 0},  {50, -80, 0},  {50, 0.9, 0}, {50, 100.9, 0},
                   {90, 60, 0}, {75, -40, 0}, {150, -40, 0}, {150, -80, 0}};
  for (Vec3& vertex : mesh.vertices) vertex *= kUm;
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}};
  mesh::Allowance allowance{1.0 * kUm, 1.2 * kUm, std::vector<double>(mesh.vertices.size(), 0.0)};
  allowance.spent[0] = allowance.spent[1] = 0.9 * kUm;
  const mesh::Mended mended = mesh::split_t_junctions(mesh, allowance);
  EXPECT_EQ(mended.count, 1U);
  EXPECT_NEAR(allowance.spent[6], 0.45 * kUm, 1e-15);
  EXPECT_EQ(allowance.spent[3], 0.0);
  const std::vector<Triangle> expected = {{1, 6, 0}, {3, 4, 5}, {6, 7, 8}, {6, 2, 0}};
  EXPECT_EQ(mesh.triangles, expected);
}

// 4 million bytes: 2 s + 4 s of processor time, 256 MiB + 64 million bytes, 60 s + 40 s.
TEST(ImportBounds, TheReadersLimitsGrowWithTheFile) {
  const mesh::IsolationLimits none = mesh::reading_limits(0);
  EXPECT_EQ(none.cpu_seconds, 2U);
  EXPECT_EQ(none.memory_bytes, 268'435'456U);
  EXPECT_EQ(none.wall_seconds, 60.0);
  const mesh::IsolationLimits large = mesh::reading_limits(4'000'000);
  EXPECT_EQ(large.cpu_seconds, 6U);
  EXPECT_EQ(large.memory_bytes, 332'435'456U);
  EXPECT_NEAR(large.wall_seconds, 100.0, 1e-9);
}

}  // namespace
}  // namespace phalanx
