// SPDX-License-Identifier: Apache-2.0
#include "phalanx/mesh/isolated_import.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <stdexcept>
#include <string>

#include "mesh/import/decimate.h"
#include "mesh/import/import_bytes.h"
#include "mesh/import/mesh_files.h"
#include "phalanx/mesh/primitives.h"
#include "support/sanitized.h"

namespace phalanx::mesh {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string isolated_refusal(const std::string& content, const ImportOptions& options,
                             const IsolationLimits& limits = {}) {
  try {
    static_cast<void>(import_isolated(content, "obj", options, "cup.obj", limits));
  } catch (const std::invalid_argument& refused) {
    return refused.what();
  }
  return "accepted";
}

std::string direct_refusal(const std::string& content, const ImportOptions& options) {
  try {
    static_cast<void>(import_and_check_from_memory(content.data(), content.size(), "obj", options));
  } catch (const std::invalid_argument& refused) {
    return refused.what();
  }
  return "accepted";
}

TEST(IsolatedImport, GivesTheMeshAndTheReportOfAnImportInThisProcess) {
  const std::string text = test::to_obj(make_sphere(0.09, 600));
  for (const ImportOptions& options :
       {ImportOptions{}, ImportOptions{.unit = 1e-2}, ImportOptions{.size = 0.123, .triangles = 200}})
    EXPECT_EQ(to_bytes(import_isolated(text, "obj", options, "cup.obj", {})),
              to_bytes(import_and_check_from_memory(text.data(), text.size(), "obj", options)));
}

TEST(IsolatedImport, RefusesWithTheMessageOfTheImport) {
  const std::string text = test::to_obj(make_sphere(0.09, 600));
  for (const ImportOptions& wrong :
       {ImportOptions{.size = -1.0}, ImportOptions{.unit = 0.0}, ImportOptions{.most_triangles = 10}}) {
    EXPECT_EQ(isolated_refusal(text, wrong), direct_refusal(text, wrong));
    EXPECT_THAT(isolated_refusal(text, wrong), StartsWith("mesh in memory: "));
  }
  EXPECT_EQ(isolated_refusal("", {}), direct_refusal("", {}));
}

TEST(IsolatedImport, TheLimitsHoldForTheWholeImport) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer's allocator ends the process in its own words";
  const std::string text = test::to_obj(make_sphere(0.09, 20'000));
  const std::string refused = isolated_refusal(text, {}, {.memory_bytes = std::uint64_t{1} << 20});
  EXPECT_THAT(refused, StartsWith("cup.obj: "));
  EXPECT_THAT(refused, HasSubstr("1 MiB of memory"));
}

TEST(IsolatedPicture, IsThatOfThisProcess) {
  const TriangleMesh fine = make_sphere(0.09, 5000);
  const TriangleMesh here = picture_of(fine, 1000);
  const TriangleMesh isolated = picture_isolated(fine, 1000, "cup.obj", {});
  EXPECT_EQ(isolated.vertices, here.vertices);
  EXPECT_EQ(isolated.triangles, here.triangles);
  EXPECT_EQ(picture_isolated(fine, fine.triangles.size(), "cup.obj", {}).triangles, fine.triangles);
}

TEST(IsolatedPicture, TheLimitsHold) {
  if (test::kSanitized) GTEST_SKIP() << "the sanitizer's allocator ends the process in its own words";
  try {
    static_cast<void>(picture_isolated(make_sphere(0.09, 200'000), 1000, "cup.obj",
                                       {.memory_bytes = std::uint64_t{1} << 20}));
    FAIL() << "accepted";
  } catch (const std::invalid_argument& refused) {
    EXPECT_THAT(refused.what(), StartsWith("cup.obj: "));
  }
}

}  // namespace
}  // namespace phalanx::mesh
