// SPDX-License-Identifier: Apache-2.0
// Each kind of bad file is refused with words that name it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>
#include <system_error>

#include "mesh/import/mesh_files.h"
#include "phalanx/mesh/import.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string refusal(const std::string& content, const std::string& format, double size = 0.0) {
  try {
    (void)import_and_check_from_memory(content.data(), content.size(), format, {.size = size});
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

std::string file_refusal(const std::string& path) {
  try {
    (void)import_and_check(path);
  } catch (const std::invalid_argument& e) {
    return e.what();
  }
  return "accepted";
}

constexpr const char* kCorner = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST(ImportRefuses, AMissingFile) {
  EXPECT_THAT(file_refusal("/no/such/cup.obj"),
              AllOf(StartsWith("/no/such/cup.obj: "), HasSubstr("no such file")));
}

TEST(ImportRefuses, AFolder) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("phalanx_" + std::to_string(::getpid()) + ".obj");
  std::filesystem::create_directory(folder);
  EXPECT_THAT(file_refusal(folder.string()), HasSubstr("not a regular file"));
  std::filesystem::remove(folder);
}

/// A file of holes alone, removed by the destructor.
class SparseFile {
 public:
  explicit SparseFile(std::uintmax_t bytes) {
    std::ofstream(path_) << "v";
    const auto before = std::signal(SIGXFSZ, SIG_IGN);
    std::filesystem::resize_file(path_, bytes, error_);
    std::signal(SIGXFSZ, before);
  }
  ~SparseFile() { std::filesystem::remove(path_); }
  SparseFile(const SparseFile&) = delete;
  SparseFile& operator=(const SparseFile&) = delete;

  [[nodiscard]] std::string path() const { return path_.string(); }
  /// The system's message; empty on success.
  [[nodiscard]] std::string error() const { return error_ ? error_.message() : ""; }

 private:
  std::filesystem::path path_ =
      std::filesystem::temp_directory_path() / ("phalanx_large_" + std::to_string(::getpid()) + ".obj");
  std::error_code error_;
};

TEST(ImportRefuses, AFileOfMoreThanTwoGibibytes) {
  const SparseFile file((std::uintmax_t{2} << 30) + 1);
  if (!file.error().empty()) GTEST_SKIP() << "no file may be so large here: " << file.error();
  EXPECT_THAT(file_refusal(file.path()),
              HasSubstr("2147483649 bytes are more than the 2147483648 that are read"));
}

TEST(ImportRefuses, AFileWithoutExtension) {
  EXPECT_THAT(file_refusal("cup"), HasSubstr("unknown mesh format ''"));
}

TEST(ImportRefuses, AnUnknownFormatAndNamesTheKnownOnes) {
  EXPECT_THAT(file_refusal("cup.step"),
              AllOf(HasSubstr("cup.step"), HasSubstr("'step'"), HasSubstr(".obj .3ds .stl .ply .glb")));
  EXPECT_THAT(refusal("x", "fbx"), HasSubstr("'fbx'"));
}

TEST(ImportRefuses, AnEmptyFile) {
  for (const char* format : {"obj", "3ds", "stl", "ply", "glb"})
    EXPECT_THAT(refusal("", format), HasSubstr("empty")) << format;
}

TEST(ImportRefuses, WhatIsNotOfItsFormat) {
  for (const char* format : {"obj", "3ds", "stl", "ply", "glb"})
    EXPECT_THAT(refusal("This is a letter to my aunt, who has a teapot.\n", format),
                HasSubstr("mesh in memory: "))
        << format;
}

TEST(ImportRefuses, AMeshWithoutTriangles) {
  EXPECT_THAT(refusal(std::string(kCorner) + "p 1\nl 1 2\n", "obj"), HasSubstr("no triangle in 5 lines"));
  // All corners on one line through one point: welding leaves nothing.
  EXPECT_THAT(refusal("v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", "obj"), HasSubstr("no triangle"));
}

TEST(ImportRefuses, AnObjFaceThatNamesAVertexThatDoesNotExist) {
  EXPECT_THAT(refusal(std::string(kCorner) + "f 1 2 4\n", "obj"),
              AllOf(HasSubstr("line 4"), HasSubstr("vertex 4"), HasSubstr("has 3")));
  EXPECT_THAT(refusal("v 0 0 0\nf 1 2 3\nv 1 0 0\nv 0 1 0\n", "obj"),
              AllOf(HasSubstr("line 2"), HasSubstr("vertex 2")));
  EXPECT_THAT(refusal(std::string(kCorner) + "f 0 1 2\n", "obj"),
              AllOf(HasSubstr("line 4"), HasSubstr("vertex 0")));
  EXPECT_THAT(refusal(std::string(kCorner) + "f -1 -2 -4\n", "obj"),
              AllOf(HasSubstr("line 4"), HasSubstr("vertex -4")));
  EXPECT_THAT(refusal(std::string(kCorner) + "f 1 2 99999999999999999999\n", "obj"),
              AllOf(HasSubstr("line 4"), HasSubstr("'99999999999999999999'")));
  EXPECT_THAT(refusal(std::string(kCorner) + "f 1 2x 3\n", "obj"),
              AllOf(HasSubstr("line 4"), HasSubstr("'2x'")));
  EXPECT_THAT(refusal(std::string(kCorner) + "f 1 2 x\n", "obj"),
              AllOf(HasSubstr("line 4"), HasSubstr("'x'")));
}

// What a message repeats of a file is at most 40 characters long and printable.
TEST(ImportRefuses, AnObjWordInPrintableCharactersAndShortened) {
  const auto with_word = [](const std::string& word) {
    return refusal("v 0 0 0\nv 1 " + word + " 0\n", "obj");
  };
  EXPECT_THAT(with_word(std::string(40, 'x')),
              AllOf(HasSubstr("line 2"), HasSubstr("'" + std::string(40, 'x') + "'")));
  EXPECT_THAT(with_word(std::string(41, 'x')), HasSubstr("'" + std::string(40, 'x') + "...'"));
  EXPECT_THAT(with_word("!\x1F~\x7F\xE9"), HasSubstr("'!?~?"
                                                     "?'"));
}

TEST(ImportRefuses, AFaceOfAnyFormatThatNamesAVertexThatDoesNotExist) {
  TriangleMesh mesh = make_sphere(0.1, 40);
  mesh.triangles[5][2] = 1000;
  for (const auto& [content, format] : {std::pair{test::to_ply_text(mesh), "ply"},
                                        {test::to_ply_binary(mesh), "ply"},
                                        {test::to_3ds(mesh), "3ds"},
                                        {test::to_glb(mesh), "glb"}})
    EXPECT_THAT(refusal(content, format), AllOf(HasSubstr("face 5"), HasSubstr("vertex 1000"))) << format;
}

TEST(ImportRefuses, ANanOrInfiniteVertexInText) {
  EXPECT_THAT(refusal("v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n", "obj"),
              AllOf(HasSubstr("line 2"), HasSubstr("'nan'"), HasSubstr("not finite")));
  EXPECT_THAT(refusal("v 0 0 0\nv 1 0 0\nv 0 -inf 0\nf 1 2 3\n", "obj"),
              AllOf(HasSubstr("line 3"), HasSubstr("'-inf'")));
  EXPECT_THAT(refusal("v 0 0 0\nv 1 0 0\nv 0 1e39 0\nf 1 2 3\n", "obj"), HasSubstr("'1e39'"));
  EXPECT_THAT(refusal("v 0 0 0\nv 1 0\nv 0 1 0\nf 1 2 3\n", "obj"),
              AllOf(HasSubstr("line 2"), HasSubstr("2 coordinates")));
  EXPECT_THAT(refusal("v 0 0 0\nv 1 0 zero\nv 0 1 0\nf 1 2 3\n", "obj"),
              AllOf(HasSubstr("line 2"), HasSubstr("'zero'")));
  EXPECT_THAT(
      refusal(test::ply_header("ascii", 3, 1) + "0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n", "ply"),
      AllOf(HasSubstr("vertex 1 (counted from 0) of mesh '"), HasSubstr("is (1, nan, 0), not finite")));
}

TEST(ImportRefuses, ANanOrInfiniteVertexInBinary) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    TriangleMesh mesh = make_sphere(0.1, 40);
    mesh.vertices[3].y() = bad;
    EXPECT_THAT(refusal(test::to_stl_binary(mesh), "stl"), HasSubstr("not finite"));
    EXPECT_THAT(refusal(test::to_ply_binary(mesh), "ply"), HasSubstr("not finite"));
    EXPECT_THAT(refusal(test::to_3ds(mesh), "3ds"), HasSubstr("not finite"));
  }
}

/// `content` with the first `from` replaced by as many characters, so that no length in it changes.
std::string with(std::string content, const std::string& from, const std::string& to) {
  const std::size_t at = content.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  EXPECT_EQ(from.size(), to.size());
  return at == std::string::npos ? content : content.replace(at, from.size(), to);
}

// Assimp reads the whole numbers as floats: garbage of 1e-33 mm.
TEST(ImportRefuses, AGlbWithQuantisedPositions) {
  const std::string good = test::to_glb(make_sphere(0.1, 40));
  EXPECT_EQ(refusal(good, "glb"), "accepted");
  EXPECT_THAT(refusal(with(good, "5126", "5123"), "glb"),
              AllOf(HasSubstr("component type 5123"), HasSubstr("without quantisation")));
}

TEST(ImportRefuses, ANegativeOrNonFiniteSize) {
  const std::string good = test::to_obj(make_sphere(0.1, 40));
  EXPECT_THAT(refusal(good, "obj", -0.1), HasSubstr("size is -0.1 m"));
  EXPECT_THAT(refusal(good, "obj", std::nan("")), HasSubstr("size is nan m"));
  EXPECT_EQ(refusal(good, "obj", 0.1), "accepted");
}

// Assimp 5.2 loops on this header, whose last line never comes.
TEST(ImportRefuses, APlyThatIsCutOffInItsHeader) {
  EXPECT_THAT(refusal("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nelement face", "ply"),
              HasSubstr("end_header"));
}

// Whatever is cut off or flipped, the answer is a mesh or a sentence. Assimp alone crashes on some of these.
TEST(ImportRefuses, DamagedFilesInWordsIfAtAll) {
  constexpr unsigned kSeed = 20250;
  std::mt19937 random(kSeed);
  const TriangleMesh mesh = make_sphere(0.1, 24);
  const std::vector<std::pair<std::string, std::string>> files = {
      {test::to_obj(mesh), "obj"},      {test::to_3ds(mesh), "3ds"},
      {test::to_stl_text(mesh), "stl"}, {test::to_stl_binary(mesh), "stl"},
      {test::to_ply_text(mesh), "ply"}, {test::to_ply_binary(mesh), "ply"},
      {test::to_glb(mesh), "glb"}};
  for (const auto& [content, format] : files) {
    for (int i = 0; i < 12; ++i) {
      std::string damaged = content;
      if (i % 3 == 0) damaged.resize(random() % damaged.size());
      for (int k = 0; k < i && !damaged.empty(); ++k)
        damaged[random() % damaged.size()] = static_cast<char>(random() & 0xff);
      const std::string answer = refusal(damaged, format);
      EXPECT_TRUE(answer == "accepted" || answer.starts_with("mesh in memory: "))
          << format << " " << i << " seed " << kSeed << ": " << answer;
    }
  }
}

// Before the file is looked at.
TEST(ImportRefuses, ASizeOfAFileThatMakesNoSense) {
  try {
    (void)import_and_check("/no/such/cup.obj", {.size = -0.1});
    FAIL() << "accepted";
  } catch (const std::invalid_argument& e) {
    EXPECT_THAT(e.what(), AllOf(StartsWith("/no/such/cup.obj: "), HasSubstr("size is -0.1 m")));
  }
}

}  // namespace
}  // namespace phalanx
