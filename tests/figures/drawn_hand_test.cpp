// SPDX-License-Identifier: Apache-2.0
// A picture's hand is the cockpit's: the same skin at the same places.
#include "figures/picture/drawn_hand.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "phalanx/core/index.h"
#include "phalanx/core/random.h"
#include "phalanx/scene/hand_meshes.h"

namespace phalanx {
namespace {

using picture::SegmentColours;
using picture::SegmentPoses;
using picture::Vec3f;

/// Of a triangle that is drawn as 4 x 4: how many vertices, and which of them are the triangle's corners.
constexpr std::size_t kVertices = 15;
constexpr std::array<std::size_t, 3> kCorner = {0, 10, 14};

struct ShippedHand {
  ShippedHand()
      : numbers(load_hand_numbers({})),
        model(make_hand_model(numbers.parameters, numbers.handedness, {}, 800)),
        drawn(drawn_hand(load_hand({}, HandDetail::kDrawn))) {}

  [[nodiscard]] const HandSkin& skin() const { return std::get<HandSkin>(drawn); }
  [[nodiscard]] SegmentPoses poses(const JointArray& angle) const {
    HandPoses digits;
    model.poses(angle, digits);
    SegmentPoses X_WS;
    for (int s = 0; s < kPalm; ++s)
      X_WS[idx(s)] = digits.digit[idx(s / kSegmentsPerDigit)].segment[idx(s % kSegmentsPerDigit)];
    X_WS[kPalm] = model.palm_pose();
    return X_WS;
  }
  [[nodiscard]] JointArray random_angles(Random& random) const {
    JointArray angle{};
    for (std::size_t j = 0; j < kJoints; ++j)
      angle[j] = random.between(numbers.parameters.min_angle[j], numbers.parameters.max_angle[j]);
    return angle;
  }

  HandNumbers numbers;
  HandModel model;
  DrawnHand drawn;
};

SegmentColours grey(float value) {
  SegmentColours colours;
  colours.fill(Vec3f::Constant(value));
  return colours;
}

/// v turned by the unit quaternion (x, y, z, w).
Vec3f turned(const Eigen::Vector4f& q, const Vec3f& v) {
  const Vec3f u = q.head<3>();
  return v + 2.0F * u.cross(u.cross(v) + q[3] * v);
}

/// A segment's motion X_WS X_BS^-1 as the page gives it to the graphics card.
struct RigidMotion {
  Eigen::Vector4f rotation;
  Vec3f translation;
};

std::array<RigidMotion, kSegments> motions_on_the_page(const HandSkin& skin, const SegmentPoses& X_WS) {
  std::array<Eigen::Vector4d, kSegments> q;
  std::array<RigidMotion, kSegments> motions;
  for (int n = 0; n < kSegments; ++n) {
    const int s = n == 0 ? kPalm : n - 1;  // the palm first
    const Pose bone = X_WS[idx(s)] * skin.X_BS[idx(s)].inverse();
    q[idx(s)] = Eigen::Quaterniond(bone.R).coeffs();
    const int before = s % kSegmentsPerDigit == 0 ? kPalm : s - 1;
    if (s != kPalm && q[idx(s)].dot(q[idx(before)]) < 0.0) q[idx(s)] = -q[idx(s)];
    motions[idx(s)] = {q[idx(s)].cast<float>(), bone.p.cast<float>()};
  }
  return motions;
}

/// The foot of the perpendicular from p to the axis of a segment in the bind pose.
Vec3 foot(const Pose& X_BS, const Vec3& p) { return X_BS * Vec3(0.0, 0.0, (X_BS.inverse() * p).z()); }

/// Where the page draws a vertex, in single precision.
Vec3f on_the_page(const HandSkin& skin, const SegmentPoses& X_WS, std::size_t vertex) {
  const auto motions = motions_on_the_page(skin, X_WS);
  const Vec3& p = skin.mesh.vertices[vertex];
  Vec3 feet = Vec3::Zero();
  double weights = 0.0;
  for (std::size_t k = 0; k < HandSkin::kInfluences; ++k) {
    const std::size_t s = skin.segment[vertex][k];
    if (s == kPalm) continue;
    feet += static_cast<double>(skin.weight[vertex][k]) * foot(skin.X_BS[s], p);
    weights += static_cast<double>(skin.weight[vertex][k]);
  }
  const Vec3f centre = (weights > 0.0 ? Vec3(feet / weights) : p).cast<float>();
  Eigen::Vector4f rotation = Eigen::Vector4f::Zero();
  Vec3f moved = Vec3f::Zero();
  for (std::size_t k = 0; k < HandSkin::kInfluences; ++k) {
    const RigidMotion& motion = motions[skin.segment[vertex][k]];
    rotation += skin.weight[vertex][k] * motion.rotation;
    moved += skin.weight[vertex][k] * (turned(motion.rotation, centre) + motion.translation);
  }
  return turned(rotation.normalized(), p.cast<float>() - centre) + moved;
}

TEST(DrawnHand, IsTheSkinWhereTheHandHasOneAndElseItsSegments) {
  const ShippedHand hand;
  EXPECT_TRUE(std::holds_alternative<HandSkin>(hand.drawn));
  HandDescription capsules;
  capsules.mesh_source = HandMeshSource::kCapsules;
  const LoadedHand loaded = load_hand(capsules, HandDetail::kDrawn);
  const DrawnHand drawn = drawn_hand(loaded);
  ASSERT_TRUE(std::holds_alternative<SegmentMeshes>(drawn));
  EXPECT_EQ(std::get<SegmentMeshes>(drawn)[3].vertices, loaded.meshes.collision[3].vertices);
}

TEST(AppendHand, DrawsTheSkinWhereThePageDrawsIt) {
  const ShippedHand hand;
  const HandSkin& skin = hand.skin();
  constexpr std::uint64_t kSeed = 61;
  Random random(kSeed);
  for (int n = 0; n < 5; ++n) {
    const SegmentPoses X_WS = hand.poses(hand.random_angles(random));
    picture::RenderMesh mesh;
    append_hand(mesh, hand.drawn, X_WS, grey(0.5F));
    ASSERT_EQ(mesh.vertices.size(), kVertices * skin.mesh.triangles.size());
    float worst = 0.0F;
    for (std::size_t t = 0; t < skin.mesh.triangles.size(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3f expected = on_the_page(skin, X_WS, idx(skin.mesh.triangles[t][c]));
        worst = std::max(worst, (mesh.vertices[kVertices * t + kCorner[c]] - expected).norm());
      }
    }
    EXPECT_LT(worst, 2e-7F) << "seed " << kSeed << ", pose " << n;  // 300 mm in single precision, some sums
  }
}

// The index finger's tip is red, all else black: a vertex is as red as its weight of the tip says, and half
// way between two vertices the mean of both is drawn.
TEST(AppendHand, BlendsTheSegmentsColoursByTheSkinsWeights) {
  const ShippedHand hand;
  const HandSkin& skin = hand.skin();
  constexpr std::size_t kFingertip = 5;
  SegmentColours colours = grey(0.0F);
  colours[kFingertip] = Vec3f::UnitX();
  picture::RenderMesh mesh;
  append_hand(mesh, hand.drawn, hand.poses({}), colours);
  const auto red = [&](std::size_t vertex) {
    float weight = 0.0F;
    for (std::size_t k = 0; k < HandSkin::kInfluences; ++k)
      if (skin.segment[vertex][k] == kFingertip) weight += skin.weight[vertex][k];
    return weight;
  };
  int whole = 0, part = 0;
  for (std::size_t t = 0; t < skin.mesh.triangles.size(); ++t) {
    std::array<float, 3> corner{};
    for (std::size_t c = 0; c < 3; ++c) {
      corner[c] = red(idx(skin.mesh.triangles[t][c]));
      ASSERT_NEAR(mesh.albedo[kVertices * t + kCorner[c]].x(), corner[c], 1e-6F);
      whole += corner[c] == 1.0F ? 1 : 0;
      part += corner[c] > 0.0F && corner[c] < 1.0F ? 1 : 0;
    }
    constexpr std::size_t kHalfWay = 3;  // row 2 of 4, between corners 0 and 1
    ASSERT_NEAR(mesh.albedo[kVertices * t + kHalfWay].x(), 0.5F * (corner[0] + corner[1]), 1e-6F);
  }
  EXPECT_GT(whole, 50);
  EXPECT_GT(part, 20);
}

TEST(AppendHand, GivesEachTriangleToTheSegmentThatHasMostOfIt) {
  const ShippedHand hand;
  picture::RenderMesh mesh;
  append_hand(mesh, hand.drawn, hand.poses({}), grey(0.5F));
  const HandSkin& skin = hand.skin();
  std::array<int, kSegments> triangles{};
  for (std::size_t t = 0; t < skin.mesh.triangles.size(); ++t) {
    const int part = mesh.part[16 * t];
    ++triangles[idx(part)];
    float own = 0.0F;
    std::array<float, kSegments> all{};
    for (const std::int32_t v : skin.mesh.triangles[t])
      for (std::size_t k = 0; k < HandSkin::kInfluences; ++k)
        all[skin.segment[idx(v)][k]] += skin.weight[idx(v)][k];
    own = all[idx(part)];
    for (const float other : all) ASSERT_LE(other, own) << t;
  }
  for (int s = 0; s < kSegments; ++s) EXPECT_GT(triangles[idx(s)], 10) << s;
}

// Only the index finger is measured elsewhere than it is shown: only its skin is a ghost, and all of it that
// is farther away than the bound.
TEST(AppendGhost, IsTheSkinThatIsMeasuredElsewhere) {
  const ShippedHand hand;
  const HandSkin& skin = hand.skin();
  const SegmentPoses shown = hand.poses({});
  picture::RenderMesh none;
  append_ghost(none, hand.drawn, shown, shown);
  EXPECT_TRUE(none.triangles.empty());
  JointArray bent{};
  bent[idx(kJointsPerDigit)] = 0.2;  // the index finger's flexion
  const SegmentPoses measured = hand.poses(bent);
  picture::RenderMesh ghost;
  append_ghost(ghost, hand.drawn, shown, measured);
  std::size_t expected = 0;
  for (const Triangle& triangle : skin.mesh.triangles) {
    const bool far = std::any_of(triangle.begin(), triangle.end(), [&](std::int32_t v) {
      return (on_the_page(skin, measured, idx(v)) - on_the_page(skin, shown, idx(v))).norm() > 0.8e-3F;
    });
    expected += far ? 1 : 0;
  }
  EXPECT_GT(expected, 100U);
  EXPECT_LT(expected, skin.mesh.triangles.size() / 3);
  // A vertex at the bound may be on either side of it in single precision.
  EXPECT_NEAR(static_cast<double>(ghost.triangles.size()) / 16.0, static_cast<double>(expected), 2.0);
}

/// The straight hand with a contact inside the index finger's tip.
Image touching_picture(const ShippedHand& hand, double force, const Vec3& from_tip) {
  Snapshot snapshot;
  snapshot.gdp_pose = snapshot.hcp_pose = hand.poses({});
  constexpr std::size_t kFingertip = 5;
  snapshot.segment[kFingertip] = {.contact = true,
                                  .depth = 1e-3,
                                  .force_raw = force,
                                  .force = force,
                                  .point = snapshot.gdp_pose[kFingertip].p + from_tip,
                                  .normal = Vec3::UnitY()};
  return render_picture(hand.drawn, {}, snapshot,
                        {.width = 320, .height = 240, .samples = 2, .full_force = 2.0, .force_scale = false});
}

// A picture has about 1.4 pixels a millimetre. The contact's ball, of 4 mm, is wholly inside the finger.
// Where it moves by its own size, and nothing else changes, some 15 pixels become lighter and as many darker.
TEST(Picture, ShowsTheContactThroughTheSkin) {
  const ShippedHand hand;
  const Image one = touching_picture(hand, 1e-6, Vec3::Zero());
  const Image other = touching_picture(hand, 1e-6, 0.005 * Vec3::UnitZ());
  int differ = 0;
  for (std::size_t i = 0; i < one.rgb.size(); i += 3)
    differ += std::abs(one.rgb[i] - other.rgb[i]) > 20 ? 1 : 0;
  EXPECT_GT(differ, 10);
  EXPECT_LT(differ, 100) << "the camera is another";
}

// Nothing in a picture is as dark as an arrow. Most of this one, of 38 mm, is outside the finger.
TEST(Picture, ShowsTheForceBesideTheSkin) {
  const ShippedHand hand;
  const auto dark = [](const Image& image) {
    int count = 0;
    for (std::size_t i = 0; i < image.rgb.size(); i += 3)
      count += std::max({image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]}) < 100 ? 1 : 0;
    return count;
  };
  EXPECT_LT(dark(touching_picture(hand, 1e-6, Vec3::Zero())), 5);
  EXPECT_GT(dark(touching_picture(hand, 2.0, Vec3::Zero())), 20);
}

}  // namespace
}  // namespace phalanx
