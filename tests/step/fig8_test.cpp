// SPDX-License-Identifier: Apache-2.0
// S1 fig. 8: which joints carry torque in each situation of the index finger and a ball, and how much,
// against a planar closed form.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using test::at;
using test::index_angles;
using test::index_segment;
using test::index_torque;
using test::moved;
using test::Runner;

struct Vec2 {
  double y, z;
};
Vec2 operator-(Vec2 a, Vec2 b) { return {a.y - b.y, a.z - b.z}; }
double dot(Vec2 a, Vec2 b) { return a.y * b.y + a.z * b.z; }

/// The finger in the plane x = 0: joints and points by sines and cosines of summed angles alone.
struct Planar {
  double mcp, pip, dip;
  /// Direction of segment k and where it starts.
  [[nodiscard]] double angle(int k) const { return mcp + (k > 0 ? pip : 0.0) + (k > 1 ? dip : 0.0); }
  [[nodiscard]] Vec2 joint(int k) const {
    Vec2 p{0.0, 0.0};
    if (k > 0) p = {p.y - test::kLength1 * std::sin(angle(0)), p.z - test::kLength1 * std::cos(angle(0))};
    if (k > 1) p = {p.y - test::kLength2 * std::sin(angle(1)), p.z - test::kLength2 * std::cos(angle(1))};
    return p;
  }
  /// A point given along (towards the tip) and across (towards the back) of segment k.
  [[nodiscard]] Vec2 point(int k, double along, double across) const {
    const double c = std::cos(angle(k));
    const double s = std::sin(angle(k));
    const Vec2 o = joint(k);
    return {o.y - along * s + across * c, o.z - along * c - across * s};
  }
};

/// Hooke's force and the torques of one contact at world point `at` with normal n, from the angles of both
/// hands alone.
void add_contact(const Snapshot& s, int k, double stiffness, std::array<double, 3>& torque, double& force) {
  const SegmentSnapshot& contact = index_segment(s, k);
  const Planar gdp{s.gdp_angle[4], s.gdp_angle[6], s.gdp_angle[7]};
  const Planar hcp{s.hcp_angle[4], s.hcp_angle[6], s.hcp_angle[7]};
  const Vec2 p{contact.point.y(), contact.point.z()};
  const Vec2 n{contact.normal.y(), contact.normal.z()};
  const Vec2 r = p - gdp.joint(k);
  const double c = std::cos(gdp.angle(k));
  const double sn = std::sin(gdp.angle(k));
  const double along = -r.y * sn - r.z * c;
  const double across = r.y * c - r.z * sn;
  const double depth = dot(p - hcp.point(k, along, across), n);
  force = stiffness * depth;
  for (int i = 0; i <= k; ++i) {
    // Flexion turns -z to -y: axis -x, so that the torque is -(r x f)_x = -(r_y f_z - r_z f_y).
    const Vec2 arm = p - gdp.joint(i);
    torque[static_cast<std::size_t>(i)] -= force * (arm.y * n.z - arm.z * n.y);
  }
}

constexpr double kStiffness = 500.0;

test::Setup with_ball(double diameter, double y, double z) {
  test::Setup model(test::simple_hand(), ObjectModel(moved(make_sphere(diameter, 4000), at(0.0, y, z))));
  test::turn_limits_off(model);
  model.parameters.force.stiffness = kStiffness;
  model.parameters.contact.normal = ForceNormal::kContact;
  model.parameters.contact.depth = DepthOrigin::kS1;  // the paper's formula
  return model;
}

/// Torques of MCP flexion, PIP and DIP equal the closed form to 1e-9 relative to what they are made of; the
/// others are zero to 1e-12.
void expect_closed_form(const Snapshot& s) {
  std::array<double, 3> torque{};
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    if (!index_segment(s, k).contact) continue;
    double force = 0.0;
    add_contact(s, k, kStiffness, torque, force);
    EXPECT_NEAR(index_segment(s, k).force, force, 1e-9) << "segment " << k;
  }
  EXPECT_NEAR(index_torque(s, 0), torque[0], 1e-9);
  EXPECT_NEAR(index_torque(s, 2), torque[1], 1e-9);
  EXPECT_NEAR(index_torque(s, 3), torque[2], 1e-9);
  // Abduction: zero where the contact's normal lies in the plane of flexion, as a true ball's does; a facet's
  // may lean out of it by a little.
  const double mcp = s.gdp_angle[joint_index(test::kIndex, 0)];
  double abduction = 0.0;
  double leaning = 0.0;
  for (int k = 0; k < kSegmentsPerDigit; ++k) {
    const SegmentSnapshot& contact = index_segment(s, k);
    const Vec3 f = contact.force * contact.normal;
    const Vec3 r = contact.point;
    abduction +=
        std::cos(mcp) * (r.z() * f.x() - r.x() * f.z()) - std::sin(mcp) * (r.x() * f.y() - r.y() * f.x());
    leaning = std::max({leaning, std::abs(f.x()), std::abs(r.x())});
  }
  EXPECT_NEAR(index_torque(s, 1), abduction, 1e-12);
  if (leaning < 1e-12) {
    EXPECT_LT(std::abs(index_torque(s, 1)), 1e-12);
  }
  for (int j = 0; j < kJoints; ++j) {
    if (digit_of_joint(j) == test::kIndex) continue;
    EXPECT_EQ(s.torque[static_cast<std::size_t>(j)], 0.0);
  }
}

void expect_contacts(const Snapshot& s, bool proximal, bool middle, bool distal) {
  EXPECT_EQ(index_segment(s, 0).contact, proximal);
  EXPECT_EQ(index_segment(s, 1).contact, middle);
  EXPECT_EQ(index_segment(s, 2).contact, distal);
}

constexpr double kNone = 1e-12;

TEST(S1Fig8, AFreeFingerFeelsNoTorque) {
  const test::Setup model = with_ball(0.03, -0.028, -0.028);
  Runner hand(model);
  const Snapshot& s = hand.move(index_angles(-0.3, 0.2, 0.1), 20);
  expect_contacts(s, false, false, false);
  for (const double torque : s.torque) EXPECT_LT(std::abs(torque), kNone);
}

TEST(S1Fig8, BProximalPhalanxLoadsTheMcpAlone) {
  const test::Setup model = with_ball(0.03, -0.028, -0.028);
  Runner hand(model);
  const Snapshot& s = hand.move(index_angles(0.55), 60);
  expect_contacts(s, true, false, false);
  expect_closed_form(s);
  EXPECT_LT(index_torque(s, 0), -1e-3);
  EXPECT_LT(std::abs(index_torque(s, 2)), kNone);
  EXPECT_LT(std::abs(index_torque(s, 3)), kNone);
}

TEST(S1Fig8, CMiddlePhalanxAsWellLoadsThePipToo) {
  const test::Setup model = with_ball(0.03, -0.028, -0.028);
  Runner hand(model);
  hand.move(index_angles(0.55), 60);
  const Snapshot& s = hand.move(index_angles(0.55, 1.3), 60);
  expect_contacts(s, true, true, false);
  expect_closed_form(s);
  EXPECT_LT(index_torque(s, 0), -1e-3);
  EXPECT_LT(index_torque(s, 2), -1e-3);
  EXPECT_LT(std::abs(index_torque(s, 3)), kNone);
}

TEST(S1Fig8, DTheWholeFingerLoadsAllThreeJoints) {
  const test::Setup model = with_ball(0.03, -0.028, -0.028);
  Runner hand(model);
  hand.move(index_angles(0.55), 60);
  hand.move(index_angles(0.55, 1.3), 60);
  const Snapshot& s = hand.move(index_angles(0.55, 1.3, 1.7), 60);
  expect_contacts(s, true, true, true);
  expect_closed_form(s);
  for (const int i : {0, 2, 3}) EXPECT_LT(index_torque(s, i), -1e-3) << i;
}

TEST(S1Fig8, EAndFTheDistalPhalanxAloneLoadsAllThreeInTwoPostures) {
  {
    const test::Setup model = with_ball(0.03, -0.035, -0.080);
    Runner hand(model);
    const Snapshot& s = hand.move(index_angles(0.4), 60);
    expect_contacts(s, false, false, true);
    expect_closed_form(s);
    for (const int i : {0, 2, 3}) EXPECT_LT(index_torque(s, i), -1e-3) << i;
  }
  {
    const test::Setup model = with_ball(0.03, -0.060, -0.055);
    Runner hand(model);
    hand.move(index_angles(0.2, 0.7), 60);
    const Snapshot& s = hand.move(index_angles(0.6, 0.9, 0.3), 60);
    expect_contacts(s, false, false, true);
    expect_closed_form(s);
    for (const int i : {0, 2, 3}) EXPECT_NE(index_torque(s, i), 0.0) << i;
  }
}

TEST(S1Fig8, GTheMiddlePhalanxAloneLoadsMcpAndPip) {
  const test::Setup model = with_ball(0.02, -0.025, -0.052);
  Runner hand(model);
  const Snapshot& s = hand.move(index_angles(0.5), 60);
  expect_contacts(s, false, true, false);
  expect_closed_form(s);
  EXPECT_LT(index_torque(s, 0), -1e-3);
  EXPECT_LT(index_torque(s, 2), -1e-4);
  EXPECT_LT(std::abs(index_torque(s, 3)), kNone);
}

/// The same from nothing but paper: a finger of thin bars comes down on a horizontal floor. Where it stops,
/// how deep the HCP goes, the force and the torques follow from the lengths, without any number of the
/// program's. A stop is exact to 10 nm.
TEST(S1Fig8, ABarOnAFloorStopsAndPushesAsTrigonometrySays) {
  constexpr double kHalf = 0.004;    // half the bars' thickness
  constexpr double kFloor = -0.020;  // height of the floor
  constexpr double kFigureMargin = 50e-6;
  HandParameters parameters = test::simple_parameters();
  SegmentMeshes meshes = make_capsule_meshes(parameters, Handedness::kRight, 2250);
  const std::array<double, 3> length = {test::kLength1, test::kLength2, test::kLength3};
  for (std::size_t k = 0; k < 3; ++k) {
    meshes[3 * test::kIndex + k] =
        moved(make_box(Vec3(0.01, 2.0 * kHalf, length[k]), 12), at(0.0, 0.0, -0.5 * length[k]));
  }
  test::Setup model(HandModel(parameters, Handedness::kRight, Pose{}, meshes),
                    ObjectModel(moved(make_box(Vec3(0.06, 0.02, 0.3), 12), at(0.0, kFloor - 0.01, 0.0))));
  test::turn_limits_off(model);
  model.parameters.force.stiffness = kStiffness;
  Runner hand(model);
  const double hcp = 0.35;
  const Snapshot& s = hand.move(index_angles(hcp), 60);
  expect_contacts(s, false, false, true);

  // The lower far edge is at a = 85 mm along, 4 mm below the straight finger's axis: its height at angle q is
  // -(a sin q + c cos q).
  const double a = test::kLength1 + test::kLength2 + test::kLength3;
  const double c = kHalf;
  const double stop = std::asin((-kFloor - kFigureMargin) / std::hypot(a, c)) - std::atan2(c, a);
  const double depth = a * std::sin(hcp) + c * std::cos(hcp) + kFloor + kFigureMargin;
  const double force = kStiffness * depth;
  const auto back = [&](double along) {
    return along * std::cos(stop);
  };  // distance of a joint from the plane x-y
  const double edge = a * std::cos(stop) - c * std::sin(stop);
  constexpr double kForceTolerance = kStiffness * 10e-9;
  EXPECT_NEAR(test::index_gdp(s, 0), stop, 10e-9 / (0.9 * a));
  EXPECT_NEAR(index_segment(s, 2).depth, depth, 10e-9);
  EXPECT_NEAR(index_segment(s, 2).force, force, kForceTolerance);
  EXPECT_NEAR(index_torque(s, 0), -force * edge, kForceTolerance * a);
  EXPECT_NEAR(index_torque(s, 2), -force * (edge - back(test::kLength1)), kForceTolerance * a);
  EXPECT_NEAR(index_torque(s, 3), -force * (edge - back(test::kLength1 + test::kLength2)),
              kForceTolerance * a);
}

}  // namespace
}  // namespace phalanx
