// SPDX-License-Identifier: Apache-2.0
// An imported mesh as bytes: what comes back, and which bytes are refused.
#include "mesh/import/import_bytes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>

#include "mesh/import/mesh_files.h"
#include "phalanx/mesh/primitives.h"

namespace phalanx::mesh {
namespace {

using ::testing::StartsWith;

ImportedMesh import_obj(const std::string& text, const ImportOptions& options = {}) {
  return import_and_check_from_memory(text.data(), text.size(), "obj", options);
}

/// A triangle twice, beside a vertex that is not used: findings with and without a place.
ImportedMesh small_import() {
  return import_obj("v 0 0 0\nv .06 0 0\nv 0 .06 0\nv 1 1 1\nf 1 2 3\nf 1 2 3\n");
}

std::string bytes_refusal(const std::string& bytes) {
  try {
    static_cast<void>(from_bytes(bytes, "cup.obj"));
  } catch (const std::invalid_argument& refused) {
    return refused.what();
  }
  return "accepted";
}

TEST(ImportBytes, AMeshComesBackBitByBit) {
  const ImportedMesh sent =
      import_obj(test::to_obj(make_sphere(0.09, 5000)), {.size = 0.06, .triangles = 500});
  const ImportedMesh got = from_bytes(to_bytes(sent), "cup.obj");
  EXPECT_EQ(got.mesh.vertices, sent.mesh.vertices);
  EXPECT_EQ(got.mesh.triangles, sent.mesh.triangles);
  EXPECT_EQ(to_bytes(got), to_bytes(sent));
}

TEST(ImportBytes, AReportComesBackWhole) {
  const ImportedMesh mesh =
      import_obj(test::to_obj(make_sphere(0.09, 5000)), {.size = 0.06, .triangles = 500});
  const MeshReport& sent = mesh.report;
  const MeshReport got = from_bytes(to_bytes(mesh), "cup.obj").report;
  EXPECT_EQ(got.vertices_in_file, sent.vertices_in_file);
  EXPECT_EQ(got.triangles_in_file, sent.triangles_in_file);
  EXPECT_EQ(got.vertices, sent.vertices);
  EXPECT_EQ(got.triangles, sent.triangles);
  EXPECT_EQ(got.extent, sent.extent);
  EXPECT_EQ(got.scale, sent.scale);
  EXPECT_EQ(got.origin, sent.origin);
  EXPECT_EQ(got.tolerance, sent.tolerance);
  EXPECT_EQ(got.moved, sent.moved);
  EXPECT_EQ(got.closed, sent.closed);
  EXPECT_EQ(got.volume, sent.volume);
  EXPECT_EQ(got.solids, sent.solids);
  EXPECT_EQ(got.cavities, sent.cavities);
  EXPECT_EQ(got.sheets, sent.sheets);
  EXPECT_EQ(got.held_back, sent.held_back);
  EXPECT_EQ(got.complete, sent.complete);
  ASSERT_TRUE(got.decimation.has_value() && sent.decimation.has_value());
  EXPECT_EQ(got.decimation->asked, sent.decimation->asked);
  EXPECT_EQ(got.decimation->before, sent.decimation->before);
  EXPECT_EQ(got.decimation->after, sent.decimation->after);
  EXPECT_EQ(got.decimation->was_closed, sent.decimation->was_closed);
  EXPECT_EQ(got.decimation->deviation.outward, sent.decimation->deviation.outward);
  EXPECT_EQ(got.decimation->deviation.inward, sent.decimation->deviation.inward);
  EXPECT_EQ(got.decimation->deviation.probes, sent.decimation->deviation.probes);
}

TEST(ImportBytes, FindingsComeBackWithTheirPlaces) {
  ImportedMesh sent = small_import();
  ASSERT_FALSE(sent.report.findings.empty());
  sent.report.findings.front().at = std::nullopt;
  sent.report.findings.back().at = Vec3(1.0, 2.0, 3.0);
  const ImportedMesh got = from_bytes(to_bytes(sent), "cup.obj");
  EXPECT_FALSE(got.report.decimation.has_value());
  ASSERT_EQ(got.report.findings.size(), sent.report.findings.size());
  for (std::size_t i = 0; i < sent.report.findings.size(); ++i) {
    const MeshFinding& a = got.report.findings[i];
    const MeshFinding& b = sent.report.findings[i];
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.found, b.found);
    EXPECT_EQ(a.repaired, b.repaired);
    EXPECT_EQ(a.size, b.size);
    EXPECT_EQ(a.width, b.width);
    EXPECT_EQ(a.area, b.area);
    EXPECT_EQ(a.at, b.at);
  }
}

TEST(ImportBytes, BytesThatAreCutOffOrTooLongAreRefused) {
  const std::string bytes = to_bytes(small_import());
  EXPECT_EQ(bytes_refusal(bytes), "accepted");
  EXPECT_THAT(bytes_refusal(bytes + '\0'), StartsWith("cup.obj: "));
  for (std::size_t length = 0; length < bytes.size(); ++length)
    EXPECT_THAT(bytes_refusal(bytes.substr(0, length)), StartsWith("cup.obj: ")) << length;
}

TEST(ImportBytes, ABrokenByteIsRefusedOrANumber) {
  const std::string bytes = to_bytes(small_import());
  int refused = 0;
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    std::string broken = bytes;
    broken[at] = '\xFF';
    try {
      const ImportedMesh got = from_bytes(broken, "cup.obj");
      for (const MeshFinding& finding : got.report.findings)
        EXPECT_LT(static_cast<std::size_t>(finding.kind), kFindingKinds) << at;
    } catch (const std::invalid_argument&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 3 * 8) << "each byte of a count";
}

TEST(ImportBytes, AMeshThatCannotBeRightIsRefused) {
  ImportedMesh without_number = small_import();
  without_number.mesh.vertices.front().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(bytes_refusal(to_bytes(without_number)), StartsWith("cup.obj"));
  ImportedMesh beyond = small_import();
  beyond.mesh.triangles.front()[1] = 1000;
  EXPECT_THAT(bytes_refusal(to_bytes(beyond)), StartsWith("cup.obj"));
  EXPECT_THAT(bytes_refusal(to_bytes({})), StartsWith("cup.obj"));
}

}  // namespace
}  // namespace phalanx::mesh
