// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/hand_meshes.h"

#include <gtest/gtest.h>

#include "support/simple_hand.h"

namespace phalanx {
namespace {

TEST(HandMeshes, MirroredOnceAreTheOtherHandsAndTwiceAreThemselves) {
  const SegmentMeshes right = make_capsule_meshes(test::simple_parameters(), Handedness::kRight, 800);
  const SegmentMeshes left = make_capsule_meshes(test::simple_parameters(), Handedness::kLeft, 800);
  SegmentMeshes meshes = right;
  mirror(meshes);
  for (std::size_t s = 0; s < kSegments; ++s) {
    EXPECT_EQ(meshes[s].vertices, left[s].vertices);
    EXPECT_EQ(meshes[s].triangles, left[s].triangles);
    EXPECT_GT(signed_volume(meshes[s]), 0.0);
  }
  mirror(meshes);
  for (std::size_t s = 0; s < kSegments; ++s) {
    EXPECT_EQ(meshes[s].vertices, right[s].vertices);
    EXPECT_EQ(meshes[s].triangles, right[s].triangles);
  }
}

}  // namespace
}  // namespace phalanx
