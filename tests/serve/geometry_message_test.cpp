// SPDX-License-Identifier: Apache-2.0
#include "record/recording/geometry_message.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <future>
#include <memory>
#include <utility>

#include "phalanx/core/index.h"
#include "phalanx/geometry.pb.h"
#include "serve/geometry_cache.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

/// One triangle, different for each number.
TriangleMesh triangle(int number) {
  return {.vertices = {Vec3(number, 0.25, 0.5), Vec3(1.0, number, 0.125), Vec3(-1.0, 0.0, number)},
          .triangles = {{0, 2, 1}}};
}

SessionGeometry simple_geometry() {
  SessionGeometry geometry;
  geometry.revision = 7;
  geometry.hand = test::simple_parameters();
  for (int s = 0; s < kSegments; ++s) geometry.segment[idx(s)] = triangle(s);
  geometry.display = geometry.segment;
  geometry.object = triangle(99);
  geometry.rate_hz = 800.0;
  return geometry;
}

HandSkin simple_skin() {
  HandSkin skin;
  skin.mesh = triangle(3);
  skin.segment = {{15, 0, 0, 0}, {1, 2, 0, 0}, {4, 5, 6, 7}};
  skin.weight = {{1.0F, 0.0F, 0.0F, 0.0F}, {0.75F, 0.25F, 0.0F, 0.0F}, {0.5F, 0.25F, 0.125F, 0.125F}};
  skin.X_BS = bind_poses(test::simple_parameters(), Handedness::kRight);
  skin.X_BS[4].R = rotation_about(Vec3(1, -2, 3).normalized(), 2.0);
  return skin;
}

wire::Geometry sent(const SessionGeometry& geometry) {
  wire::Geometry message;
  write_geometry(geometry, message);
  return message;
}

void expect_same(const wire::Mesh& message, const TriangleMesh& mesh) {
  ASSERT_EQ(idx(message.position_size()), 3 * mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(message.position(static_cast<int>(3 * i) + k), static_cast<float>(mesh.vertices[i][k]));
  }
  ASSERT_EQ(idx(message.index_size()), 3 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_EQ(message.index(static_cast<int>(3 * t + k)), static_cast<std::uint32_t>(mesh.triangles[t][k]));
  }
}

TEST(GeometryMessage, HoldsTheMeshesOfSegmentsAndObject) {
  const SessionGeometry geometry = simple_geometry();
  const wire::Geometry message = sent(geometry);
  EXPECT_EQ(message.revision(), 7U);
  EXPECT_FALSE(message.left());
  EXPECT_EQ(message.rate_hz(), 800.0F);
  ASSERT_EQ(message.segment_size(), kSegments);
  for (int s = 0; s < kSegments; ++s) expect_same(message.segment(s), geometry.segment[idx(s)]);
  expect_same(message.object(), geometry.object);
  EXPECT_EQ(message.display_size(), 0);
  EXPECT_FALSE(message.has_skin());
}

TEST(GeometryMessage, HoldsTheDisplayMeshesOnlyWhereTheyDiffer) {
  SessionGeometry geometry = simple_geometry();
  geometry.display[5].vertices[1].x() += 1e-3;
  const wire::Geometry message = sent(geometry);
  ASSERT_EQ(message.display_size(), kSegments);
  for (int s = 0; s < kSegments; ++s) expect_same(message.display(s), geometry.display[idx(s)]);
  geometry = simple_geometry();
  geometry.display[15].triangles[0] = {0, 1, 2};
  EXPECT_EQ(sent(geometry).display_size(), kSegments);
}

TEST(GeometryMessage, OfAnEmptySceneHasAnObjectWithoutVertices) {
  SessionGeometry geometry = simple_geometry();
  geometry.object = {};
  geometry.handedness = Handedness::kLeft;
  const wire::Geometry message = sent(geometry);
  EXPECT_EQ(message.object().position_size(), 0);
  EXPECT_EQ(message.object().index_size(), 0);
  EXPECT_TRUE(message.left());
}

TEST(GeometryMessage, HoldsTheSkin) {
  SessionGeometry geometry = simple_geometry();
  geometry.skin = simple_skin();
  const wire::Geometry message = sent(geometry);
  ASSERT_TRUE(message.has_skin());
  const wire::Skin& skin = message.skin();
  expect_same(skin.mesh(), geometry.skin->mesh);
  ASSERT_EQ(skin.segment_size(), 12);
  ASSERT_EQ(skin.weight_size(), 12);
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_EQ(skin.segment(static_cast<int>(4 * i + k)), geometry.skin->segment[i][k]);
      EXPECT_EQ(skin.weight(static_cast<int>(4 * i + k)), geometry.skin->weight[i][k]);
    }
  }
}

// A page computes the same rotation from the message.
TEST(GeometryMessage, HoldsTheBindPosesAsPositionAndQuaternion) {
  SessionGeometry geometry = simple_geometry();
  geometry.skin = simple_skin();
  const wire::Skin skin = sent(geometry).skin();
  ASSERT_EQ(skin.bind_pose_size(), 7 * kSegments);
  for (int s = 0; s < kSegments; ++s) {
    const auto number = [&](int i) { return static_cast<double>(skin.bind_pose(7 * s + i)); };
    const Pose& X = geometry.skin->X_BS[idx(s)];
    EXPECT_LT((Vec3(number(0), number(1), number(2)) - X.p).norm(), 1e-7);
    const Eigen::Quaterniond q(number(6), number(3), number(4), number(5));  // w x y z
    EXPECT_NEAR(q.norm(), 1.0, 1e-6);
    EXPECT_LT((q.toRotationMatrix() - X.R).norm(), 1e-6);
  }
  // A turn of 2 rad about (1, -2, 3), by hand: w = cos 1, the vector's length is sin 1.
  EXPECT_NEAR(std::abs(skin.bind_pose(4 * 7 + 6)), 0.540302, 1e-6);
  EXPECT_NEAR(std::abs(skin.bind_pose(4 * 7 + 5)), 3.0 / std::sqrt(14.0) * 0.841471, 1e-6);
}

TEST(GeometryMessage, NamesSegmentsAndJointsWithTheirRanges) {
  SessionGeometry geometry = simple_geometry();
  geometry.hand.open_angle[6] = 0.375;
  const wire::Geometry message = sent(geometry);
  ASSERT_EQ(message.segment_name_size(), kSegments);
  EXPECT_EQ(message.segment_name(0), "thumb-metacarpal");
  EXPECT_EQ(message.segment_name(kPalm), "wrist");
  ASSERT_EQ(message.joint_name_size(), kJoints);
  EXPECT_EQ(message.joint_name(4), "index_mcp_flexion");
  ASSERT_EQ(message.joint_min_size(), kJoints);
  ASSERT_EQ(message.joint_max_size(), kJoints);
  ASSERT_EQ(message.joint_open_size(), kJoints);
  EXPECT_EQ(message.joint_min(4), -0.5F);
  EXPECT_EQ(message.joint_max(5), 0.6F);
  EXPECT_EQ(message.joint_open(6), 0.375F);
}

// ---- GeometryCache ----

std::shared_ptr<const SessionGeometry> geometry_of(std::uint32_t revision) {
  auto geometry = std::make_shared<SessionGeometry>();
  geometry->revision = revision;
  return geometry;
}

/// Requests a revision and waits for the response, which may come from another thread.
WebResponse response_of(GeometryCache& cache, std::uint32_t revision) {
  const auto responded = std::make_shared<std::promise<WebResponse>>();
  cache.request(geometry_of(revision),
                [responded](WebResponse response) { responded->set_value(std::move(response)); });
  return responded->get_future().get();
}

/// Prevents the start of threads during its lifetime: their stacks would exceed the address space.
class NoThreads {
 public:
  NoThreads() {
    EXPECT_EQ(::pthread_getattr_default_np(&before_), 0);
    pthread_attr_t huge;
    EXPECT_EQ(::pthread_attr_init(&huge), 0);
    EXPECT_EQ(::pthread_attr_setstacksize(&huge, std::size_t{1} << 60U), 0);
    EXPECT_EQ(::pthread_setattr_default_np(&huge), 0);
    ::pthread_attr_destroy(&huge);
  }
  NoThreads(const NoThreads&) = delete;
  NoThreads& operator=(const NoThreads&) = delete;
  ~NoThreads() {
    EXPECT_EQ(::pthread_setattr_default_np(&before_), 0);
    ::pthread_attr_destroy(&before_);
  }

 private:
  pthread_attr_t before_{};
};

TEST(GeometryCache, ARevisionIsEncodedOnce) {
  const auto cache = std::make_shared<GeometryCache>();
  const WebResponse first = response_of(*cache, 3);
  ASSERT_EQ(first.status, 200);
  ASSERT_NE(first.body, nullptr);
  EXPECT_EQ(first.type, "application/x-protobuf");
  EXPECT_EQ(response_of(*cache, 3).body, first.body) << "the same object";
  const WebResponse next = response_of(*cache, 4);
  ASSERT_NE(next.body, nullptr);
  wire::Geometry message;
  ASSERT_TRUE(message.ParseFromString(*next.body));
  EXPECT_EQ(message.revision(), 4U);
}

TEST(GeometryCache, WithoutAThreadTheRequestIsRefusedAtOnceAndMayBeRepeated) {
  const auto cache = std::make_shared<GeometryCache>();
  int refused = 0;
  {
    const NoThreads none;
    cache->request(geometry_of(3), [&refused](const WebResponse& response) {
      ++refused;
      EXPECT_EQ(response.status, 500);
      EXPECT_EQ(response.body, nullptr);
    });
    EXPECT_EQ(refused, 1);
  }
  EXPECT_EQ(response_of(*cache, 3).status, 200);
  EXPECT_EQ(refused, 1) << "there is one response only";
}

}  // namespace
}  // namespace phalanx
