// SPDX-License-Identifier: Apache-2.0
// "The GDP, exactly" where every number can be worked out on paper: each segment of the simple hand's index
// is one small diamond, whose lowest corner alone meets horizontal plates.
//
// In the plane of flexion, f forward and y up, in mm: a turn by q takes (f, y) to (f cos q + y sin q,
// y cos q - f sin q). The lowest corners are at (20, -1) in their segments' frames, the bones 40 and 25 long.
// So with p = MCP, q = MCP + PIP, the corners' heights are
//   y1(p)    = -20 sin p - cos p
//   y2(p, q) = -40 sin p - 20 sin q - cos q
// and their ways forward f1 = 20 cos p - sin p, f2 = 40 cos p + 20 cos q - sin q. A plate's n_c is +y, so
// that a depth is a difference of heights, and a torque -F f. (Turned by more than pi / 4 the foremost corner
// is lower.)
#include <gmock/gmock.h>

#include <cmath>

#include "phalanx/contact/gdp.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/core/index.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using test::index_angles;
using test::index_segment;
using test::index_torque;

constexpr double kPaperMargin = 50e-6;
/// A stop is within 10 nm of the margin; corners close at a third of the fastest at least.
constexpr double kPlace = 50e-9;

double y1(double p) { return -20e-3 * std::sin(p) - 1e-3 * std::cos(p); }
double y2(double p, double q) { return -40e-3 * std::sin(p) - 20e-3 * std::sin(q) - 1e-3 * std::cos(q); }
double f1(double p) { return 20e-3 * std::cos(p) - 1e-3 * std::sin(p); }
double f2(double p, double q) { return 40e-3 * std::cos(p) + 20e-3 * std::cos(q) - 1e-3 * std::sin(q); }

/// A double pyramid with its corners 1 mm around (0, 0, -20 mm).
TriangleMesh diamond() {
  TriangleMesh mesh;
  const Vec3 c(0.0, 0.0, -20e-3);
  mesh.vertices = {c + Vec3(0, 1e-3, 0),  c + Vec3(0, -1e-3, 0), c + Vec3(1e-3, 0, 0),
                   c + Vec3(-1e-3, 0, 0), c + Vec3(0, 0, 1e-3),  c + Vec3(0, 0, -1e-3)};
  mesh.triangles = {{0, 4, 2}, {0, 2, 5}, {0, 5, 3}, {0, 3, 4}, {1, 2, 4}, {1, 5, 2}, {1, 3, 5}, {1, 4, 3}};
  return mesh;
}

HandModel diamond_hand() {
  SegmentMeshes meshes = make_capsule_meshes(test::simple_parameters(), Handedness::kRight, 800);
  for (int k = 0; k < kSegmentsPerDigit; ++k) meshes[idx(segment_index(test::kIndex, k))] = diamond();
  return HandModel(test::simple_parameters(), Handedness::kRight, Pose{}, std::move(meshes));
}

/// A plate 6 mm long below a corner that it meets, at the margin, where the corner is at (f, y).
TriangleMesh plate(double f, double y) {
  return test::moved(make_box(Vec3(0.01, 0.002, 0.006), 12), test::at(0.0, y - kPaperMargin - 0.001, -f));
}

HapticModel paper_model(const TriangleMesh& object) {
  HapticModel model(diamond_hand(), ObjectModel(object));
  test::turn_limits_off(model);
  return model;
}

/// The stages of a step, with the records in sight.
class Paper {
 public:
  explicit Paper(const HapticModel& model)
      : model_(model), contact_{model.hand, model.trees, model.object, model.contact}, state_(contact_) {}

  const GdpState& tick(const JointArray& hcp) {
    HandPoses poses;
    model_.hand.poses(hcp, poses);
    std::array<bool, kDigits> measured{};
    measured.fill(true);
    advance_gdp(contact_, hcp, poses, measured, state_);
    return state_;
  }
  [[nodiscard]] const ContactRecord& record(int k) const {
    return state_.record[idx(segment_index(test::kIndex, k))];
  }
  [[nodiscard]] double gdp(int i) const { return state_.angle[idx(joint_index(test::kIndex, i))]; }

 private:
  const HapticModel& model_;
  ContactModel contact_;
  GdpState state_;
};

/// The proximal corner meets a plate at MCP 0.5; then, while the proximal phalanx stands there, the middle
/// one meets another at PIP 0.2.
TriangleMesh two_steps() {
  TriangleMesh mesh = plate(f1(0.5), y1(0.5));
  append(mesh, plate(f2(0.5, 0.7), y2(0.5, 0.7)));
  return mesh;
}

/// d0 of the second contact, by hand. The third tick takes the MCP's HCP from 0.55 to 0.60 and the PIP's from
/// 0 to 0.5. The GDP's MCP stands at 0.5, its PIP reaches 0.2 at s = 0.4. There the HCP is at MCP 0.57, PIP
/// 0.2.
double offset_by_hand() { return y2(0.5, 0.7) - y2(0.57, 0.77); }

TEST(GdpByHand, TheOffsetIsThatOfTheMomentOfContact) {
  const HapticModel model = paper_model(two_steps());
  Paper paper(model);
  paper.tick(index_angles(0.4));
  paper.tick(index_angles(0.55));
  ASSERT_TRUE(paper.record(0).active);
  EXPECT_NEAR(paper.gdp(0), 0.5, 1e-6);
  EXPECT_NEAR(paper.record(0).depth, y1(0.5) - y1(0.55), kPlace);
  EXPECT_EQ(paper.record(0).offset, 0.0) << "nothing pushed before it";
  paper.tick(index_angles(0.60, 0.5));
  ASSERT_TRUE(paper.record(1).active);
  EXPECT_NEAR(paper.gdp(2), 0.2, 1e-6);
  EXPECT_NEAR(paper.record(1).offset, offset_by_hand(), kPlace);
  EXPECT_GT(offset_by_hand(), 3e-3);
  EXPECT_NEAR(paper.record(1).depth, y2(0.5, 0.7) - y2(0.60, 1.10) - offset_by_hand(), kPlace);
  EXPECT_NEAR(paper.record(0).depth, y1(0.5) - y1(0.60), kPlace);
}

TEST(GdpByHand, WithoutTheOffsetForcesAndTorquesWouldBeOthers) {
  const auto run = [](DepthOrigin depth) {
    HapticModel model = paper_model(two_steps());
    model.contact.depth = depth;
    test::Runner hand(model);
    hand.tick(index_angles(0.4));
    hand.tick(index_angles(0.55));
    return hand.tick(index_angles(0.60, 0.5));
  };
  const Snapshot s = run(DepthOrigin::kContinuous);
  const double first = 500.0 * (y1(0.5) - y1(0.60));
  const double beyond = 500.0 * (y2(0.5, 0.7) - y2(0.60, 1.10));
  const double second = beyond - 500.0 * offset_by_hand();
  const double pip = 20e-3 * std::cos(0.7) - 1e-3 * std::sin(0.7);
  EXPECT_NEAR(index_segment(s, 1).force, second, 500.0 * kPlace);
  EXPECT_NEAR(index_torque(s, 2), -second * pip, 1e-6);
  EXPECT_NEAR(index_torque(s, 0), -first * f1(0.5) - second * f2(0.5, 0.7), 2e-6);
  EXPECT_EQ(index_torque(s, 3), 0.0);
  const Snapshot as_printed = run(DepthOrigin::kS1);
  EXPECT_NEAR(index_segment(as_printed, 1).force, beyond, 500.0 * kPlace);
  EXPECT_GT(beyond - second, 1.5) << "newtons that only d0 makes";
}

// The HCP backs off to where the second contact no longer pushes (d < 0), though it is still beyond the
// plate: the segment is blocked, and its record stands with its d0.
TEST(GdpByHand, ABlockedContactKeepsItsOffsetWhileTheHcpIsBeyondIt) {
  const HapticModel model = paper_model(two_steps());
  Paper paper(model);
  paper.tick(index_angles(0.4));
  paper.tick(index_angles(0.55));
  paper.tick(index_angles(0.60, 0.5));
  const double offset = paper.record(1).offset;
  const double beyond = y2(0.5, 0.7) - y2(0.54, 0.79);
  ASSERT_GT(beyond, 0.0);
  ASSERT_LT(beyond, offset_by_hand());
  paper.tick(index_angles(0.54, 0.25));
  ASSERT_TRUE(paper.record(1).active);
  EXPECT_EQ(paper.record(1).offset, offset);
  EXPECT_NEAR(paper.record(1).depth, beyond - offset_by_hand(), kPlace);
  paper.tick(index_angles(0.60, 0.5));
  EXPECT_EQ(paper.record(1).offset, offset);
  EXPECT_NEAR(paper.record(1).depth, y2(0.5, 0.7) - y2(0.60, 1.10) - offset_by_hand(), kPlace);
}

// Both corners reach their plates at s = 0.5 of one tick: MCP 0.4 to 0.6, PIP 0 to -0.1, that is at MCP 0.5
// and PIP -0.05. The middle phalanx decides, so that the PIP stops too, although its way from there leads off
// the plate. The middle one's plate is 0.2 nm higher: whatever rounding does, where the proximal one closes
// the middle one does.
TEST(GdpByHand, OfTwoAtTheSameMomentTheDistalOneDecides) {
  TriangleMesh object = plate(f1(0.5), y1(0.5));
  append(object, plate(f2(0.5, 0.45), y2(0.5, 0.45) + 0.2e-9));
  const HapticModel model = paper_model(object);
  Paper paper(model);
  test::Runner hand(model);
  for (const JointArray& q : {index_angles(0.4), index_angles(0.6, -0.1)}) {
    paper.tick(q);
    hand.tick(q);
  }
  ASSERT_TRUE(paper.record(0).active);
  ASSERT_TRUE(paper.record(1).active);
  EXPECT_NEAR(paper.gdp(0), 0.5, 1e-6);
  EXPECT_NEAR(paper.gdp(2), -0.05, 1e-6);
  // The proximal phalanx gets its record first, at d = 0: it does not push yet, and d0 of the middle one is 0
  // to the place's tolerance.
  EXPECT_NEAR(paper.record(1).offset, 0.0, kPlace);
  const double first = 500.0 * (y1(0.5) - y1(0.6));
  const double second = 500.0 * (y2(0.5, 0.45) - y2(0.6, 0.5));
  EXPECT_NEAR(index_torque(hand.now(), 0), -first * f1(0.5) - second * f2(0.5, 0.45), 3e-6);
  EXPECT_NEAR(index_torque(hand.now(), 2), -second * (20e-3 * std::cos(0.45) - 1e-3 * std::sin(0.45)), 1e-6);
}

// Steps shorter than the margin: what is known of the distance is spent to the last micrometre before it is
// asked for again, and it must be asked for before the margin is reached.
TEST(GdpByHand, ASlowApproachStopsAtTheMargin) {
  for (const double step : {1e-4, 3e-4, 7e-4, 2e-3}) {  // 2 to 40 um of the corner's way
    SCOPED_TRACE(step);
    const HapticModel model = paper_model(plate(f1(0.5), y1(0.5)));
    Paper paper(model);
    double p = 0.3;
    for (int n = 0; p < 0.51; ++n) {
      p = 0.3 + n * step;
      paper.tick(index_angles(p));
      ASSERT_GE(y1(paper.gdp(0)), y1(0.5) - 10e-9) << "at " << p;
      ASSERT_EQ(paper.record(0).active, p >= 0.5) << "at " << p;
      if (p < 0.5) {
        ASSERT_EQ(paper.gdp(0), p);
      }
    }
    EXPECT_NEAR(paper.gdp(0), 0.5, 1e-6);
  }
}

}  // namespace
}  // namespace phalanx
