// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/import.h"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "mesh/import/mesh_files.h"
#include "mesh/mesh_checks.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

TriangleMesh import_text(const std::string& text, const std::string& format, double size = 0.0) {
  return import_and_check_from_memory(text.data(), text.size(), format, {.size = size}).mesh;
}

class Folder {
 public:
  Folder() : path_(fs::temp_directory_path() / ("phalanx_import_test_" + std::to_string(::getpid()))) {
    fs::create_directories(path_);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }
  [[nodiscard]] fs::path write(const std::string& name, const std::string& content) const {
    std::ofstream(path_ / name, std::ios::binary) << content;
    return path_ / name;
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Two bodies without any symmetry, off the origin, so that a lost or exchanged axis shows.
TriangleMesh sample() {
  TriangleMesh mesh = make_box({0.1, 0.2, 0.4}, 60);
  append(mesh, make_torus(0.05, 0.02, 200), Pose{Mat3::Identity(), Vec3{0.31, 0.07, -0.02}});
  return mesh;
}

struct Format {
  std::string name;
  std::string extension;
  std::function<std::string(const TriangleMesh&)> write;
};

class ImportedFormat : public ::testing::TestWithParam<Format> {};

TEST_P(ImportedFormat, ComesBackWholeInPlaceAndWelded) {
  const TriangleMesh made = sample();
  const Folder folder;
  const TriangleMesh got =
      import_and_check(folder.write("mesh." + GetParam().extension, GetParam().write(made))).mesh;
  EXPECT_EQ(got.vertices.size(), made.vertices.size());
  EXPECT_EQ(got.triangles.size(), made.triangles.size());
  EXPECT_EQ(test::manifold_flaw(got), "");
  EXPECT_NEAR(signed_volume(got), signed_volume(made), 1e-7 * signed_volume(made) + 1e-9);
  EXPECT_LT((bounds(got).min - bounds(made).min).norm(), 1e-7);
  EXPECT_LT((bounds(got).max - bounds(made).max).norm(), 1e-7);
}

TEST_P(ImportedFormat, IsScaledAndCentredBySize) {
  const TriangleMesh got = import_text(GetParam().write(sample()), GetParam().extension, 0.25);
  EXPECT_NEAR(test::extents(got).maxCoeff(), 0.25, 1e-15);
  EXPECT_LT((bounds(got).min + bounds(got).max).norm(), 1e-15);
  EXPECT_NEAR(test::extents(got).x() / test::extents(got).z(),
              test::extents(sample()).x() / test::extents(sample()).z(), 1e-6);
}

TEST_P(ImportedFormat, IsKnownInUpperCaseToo) {
  const Folder folder;
  std::string extension = GetParam().extension;
  for (char& c : extension) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  EXPECT_EQ(
      import_and_check(folder.write("MESH." + extension, GetParam().write(sample()))).mesh.triangles.size(),
      sample().triangles.size());
}

INSTANTIATE_TEST_SUITE_P(
    All, ImportedFormat,
    ::testing::Values(Format{"Obj", "obj", test::to_obj}, Format{"StlText", "stl", test::to_stl_text},
                      Format{"StlBinary", "stl", test::to_stl_binary},
                      Format{"PlyText", "ply", test::to_ply_text},
                      Format{"PlyBinary", "ply", test::to_ply_binary},
                      Format{"Studio3ds", "3ds", test::to_3ds},
                      Format{"Glb", "glb", [](const TriangleMesh& m) { return test::to_glb(m); }}),
    [](const auto& each) { return each.param.name; });

TEST(Import, AppliesTheTransformsOfNestedNodes) {
  const TriangleMesh made = sample();
  // Root moves by (1, 0, 0) and holds a child scaled by 2 and another turned half a turn about z, 3 beyond
  // it: one inside the other would be taken for its hollow.
  const std::string nodes =
      R"({"translation":[1,0,0],"children":[1,2]},{"mesh":0,"scale":[2,2,2]},{"mesh":0,"rotation":[0,0,1,0],"translation":[3,0,0]})";
  const TriangleMesh got = import_text(test::to_glb(made, nodes), "glb");
  TriangleMesh expected;
  TriangleMesh doubled = made;
  for (Vec3& v : doubled.vertices) v *= 2.0;
  append(expected, doubled, Pose{Mat3::Identity(), Vec3::UnitX()});
  append(expected, made, Pose{Vec3(-1, -1, 1).asDiagonal(), Vec3(4, 0, 0)});
  EXPECT_EQ(got.triangles.size(), expected.triangles.size());
  EXPECT_LT((bounds(got).min - bounds(expected).min).norm(), 1e-6);
  EXPECT_LT((bounds(got).max - bounds(expected).max).norm(), 1e-6);
  EXPECT_NEAR(signed_volume(got), signed_volume(expected), 1e-7);
}

TEST(Import, KeepsTheOutsideOutWhenANodeMirrors) {
  const TriangleMesh got = import_text(test::to_glb(sample(), R"({"mesh":0,"scale":[-1,1,1]})"), "glb");
  EXPECT_NEAR(signed_volume(got), signed_volume(sample()), 1e-8);
  EXPECT_NEAR(bounds(got).max.x(), -bounds(sample()).min.x(), 1e-7);
}

// A triangle that faces +z does so when a node has shrunk it, when it has mirrored it, and when it has
// pressed flat along z what is flat already.
TEST(Import, KeepsTheSideOfAnOpenSurfaceWhateverANodeDoes) {
  const TriangleMesh made{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  for (const char* scale : {"[0.5,0.5,0.5]", "[-0.5,0.5,0.5]", "[0.5,0.5,0]"}) {
    const TriangleMesh got =
        import_text(test::to_glb(made, std::string(R"({"mesh":0,"scale":)") + scale + "}"), "glb");
    ASSERT_EQ(got.triangles.size(), 1U) << scale;
    const Triangle& t = got.triangles[0];
    const Vec3 a = test::corner(got, t[0]);
    EXPECT_GT((test::corner(got, t[1]) - a).cross(test::corner(got, t[2]) - a).z(), 0.0) << scale;
  }
}

TEST(Import, CutsPolygonsAndLeavesPointsAndLinesOut) {
  const std::string cube =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\nv 9 9 9\nv 8 8 8\n"
      "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\nl 9 10\np 9\n";
  const TriangleMesh got = import_text(cube, "obj");
  EXPECT_EQ(got.triangles.size(), 12U);
  EXPECT_EQ(got.vertices.size(), 8U) << "a vertex that only a line uses must not count for the size";
  EXPECT_EQ(test::manifold_flaw(got), "");
  EXPECT_DOUBLE_EQ(signed_volume(got), 1.0);
}

TEST(Import, CutsAConcavePolygonInside) {
  // An arrowhead: the reflex corner at (0.5, 0.2); its area by the shoelace formula is 0.4.
  const TriangleMesh got = import_text("v 0 0 0\nv 0.5 0.2 0\nv 1 0 0\nv 0.5 1 0\nf 1 2 3 4\n", "obj");
  double area = 0.0;
  for (const Triangle& t : got.triangles) {
    const Vec3 n = (test::corner(got, t[1]) - test::corner(got, t[0]))
                       .cross(test::corner(got, t[2]) - test::corner(got, t[0]));
    EXPECT_GT(n.z(), 0.0);
    area += 0.5 * n.z();
  }
  EXPECT_NEAR(area, 0.4, 1e-7);
}

TEST(Import, TakesNegativeIndicesContinuedLinesCommentsAndMissingTextures) {
  EXPECT_EQ(import_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\n", "obj").triangles.size(), 1U);
  EXPECT_EQ(
      import_text("v 0 0 0\nv 1 0 0\nv 0 \\\n1 0\nf 1/1 2//2 \\\n3 # the last\n", "obj").triangles.size(),
      1U);
}

// Assimp alone counts ".5" for no number and then misses the vertex.
TEST(Import, TakesNumbersThatStartWithAPoint) {
  const TriangleMesh got = import_text("v .5 -.25 0\nv 1 +.5 0\nv 0 1 .125\nf 1 2 3\n", "obj");
  ASSERT_EQ(got.vertices.size(), 3U);
  EXPECT_EQ(got.vertices[0], Vec3(0.5, -0.25, 0));
  EXPECT_EQ(got.vertices[1], Vec3(1, 0.5, 0));
  EXPECT_EQ(got.vertices[2], Vec3(0, 1, 0.125));
}

// A fourth number is a weight that divides the three; six numbers are a place and a colour.
TEST(Import, DividesByAWeightAndLeavesAColourOut) {
  for (const char* first : {"v 2 0 0 2\n", "v 1 0 0 0.5 0.5 0.5\n", "v 1 0 0 .5 .5 .5\n"}) {
    const TriangleMesh got = import_text(std::string(first) + "v 0 1 0\nv 0 0 1\nf 1 2 3\n", "obj");
    EXPECT_EQ(got.vertices, (std::vector<Vec3>{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}})) << first;
  }
}

TEST(Import, TakesAnOpenMesh) {
  TriangleMesh open = make_sphere(0.1, 200);
  open.triangles.resize(100);
  EXPECT_EQ(import_text(test::to_obj(open), "obj").triangles.size(), 100U);
}

TEST(Import, IsTheSameBitByBitEveryTime) {
  const std::string text = test::to_stl_binary(sample());
  const TriangleMesh a = import_text(text, "stl", 0.3);
  const TriangleMesh b = import_text(text, "stl", 0.3);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

TEST(WriteObj, ComesBackThroughTheImporterInSinglePrecision) {
  const Folder folder;
  const TriangleMesh made = make_teapot(0.2, 1000);
  write_obj(made, folder.path() / "teapot.obj", "teapot");
  const TriangleMesh got = import_and_check(folder.path() / "teapot.obj").mesh;
  EXPECT_EQ(test::manifold_flaw(got), "");
  EXPECT_EQ(got.triangles.size(), made.triangles.size());
  EXPECT_NEAR(signed_volume(got) / signed_volume(made), 1.0, 1e-6);
}

TEST(WriteObj, WritesEveryDoubleExactly) {
  const Folder folder;
  const TriangleMesh made = make_sphere(0.1, 100);
  write_obj(made, folder.path() / "sphere.obj", "a\nball");
  std::ifstream in(folder.path() / "sphere.obj");
  std::string first;
  std::string second;
  std::getline(in, first);
  std::getline(in, second);
  EXPECT_EQ(second, "o a_ball");
  for (const Vec3& v : made.vertices) {
    std::string key;
    double x = 0.0;
    double y = 0.0;
    double z = 0.0;
    ASSERT_TRUE(in >> key >> x >> y >> z);
    EXPECT_EQ(Vec3(x, y, z), v);
  }
}

TEST(WriteObj, NamesTheFileThatCannotBeWritten) {
  try {
    write_obj(make_sphere(0.1, 10), "/no/such/folder/a.obj", "a");
    FAIL() << "written";
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("/no/such/folder/a.obj"), std::string::npos);
  }
}

// Blanks at a line's end, and the carriage returns of other systems, are no part of it.
TEST(Import, TakesBlanksAtTheEndsOfLines) {
  const TriangleMesh got = import_text("v 0 0 0 \r\nv 1 0 0\t\r\nv 0 1 0\r\nf 1 2 3 \r\n", "obj");
  EXPECT_EQ(got.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
  EXPECT_EQ(got.triangles, (std::vector<Triangle>{{0, 1, 2}}));
}

}  // namespace
}  // namespace phalanx
