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
#include <limits>
#include <numbers>
#include <optional>

#include "contact/gdp_digit.h"
#include "contact/normal_fan.h"
#include "phalanx/contact/gdp.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/contact/triangle_distance.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/step/haptic_step.h"
#include "support/search_cases.h"
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

test::Setup paper_model(const TriangleMesh& object) {
  test::Setup model(diamond_hand(), ObjectModel(object));
  test::turn_limits_off(model);
  return model;
}

/// The stages of a step, with the records in sight.
class Paper {
 public:
  explicit Paper(const test::Setup& model)
      : model_(model),
        contact_{model.hand, model.trees(), model.object, model.parameters.contact},
        state_(contact_) {}

  const GdpState& tick(const JointArray& hcp) {
    HandPoses poses;
    model_.hand.poses(hcp, poses);
    std::array<bool, kDigits> measured{};
    measured.fill(true);
    status = advance_gdp(contact_, hcp, poses, measured, state_);
    return state_;
  }
  [[nodiscard]] const ContactRecord& record(int k) const {
    return state_.record[idx(segment_index(test::kIndex, k))];
  }
  [[nodiscard]] double gdp(int i) const { return state_.angle[idx(joint_index(test::kIndex, i))]; }

  Status status = Status::kOk;  ///< of the last tick

 private:
  const test::Setup& model_;
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
  const test::Setup model = paper_model(two_steps());
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
    test::Setup model = paper_model(two_steps());
    model.parameters.contact.depth = depth;
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
  const test::Setup model = paper_model(two_steps());
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

double y3(double p, double q, double r) {
  return -40e-3 * std::sin(p) - 25e-3 * std::sin(q) - 20e-3 * std::sin(r) - 1e-3 * std::cos(r);
}
double f3(double p, double q, double r) {
  return 40e-3 * std::cos(p) + 25e-3 * std::cos(q) + 20e-3 * std::cos(r) - 1e-3 * std::sin(r);
}

// Any segment nearer the palm that pushes makes a d0: here the proximal phalanx pushes, while the middle one
// has a record that does not. The last tick takes the DIP's HCP from 0 to 0.1, all else stands at MCP 0.54,
// PIP 0.25; the distal corner meets its plate at DIP 0.05.
TEST(GdpByHand, TheOffsetNeedsOneNearerSegmentThatPushesNotAll) {
  TriangleMesh object = two_steps();
  append(object, plate(f3(0.5, 0.7, 0.75), y3(0.5, 0.7, 0.75)));
  const test::Setup model = paper_model(object);
  Paper paper(model);
  for (const JointArray& q :
       {index_angles(0.4), index_angles(0.55), index_angles(0.60, 0.5), index_angles(0.54, 0.25)})
    paper.tick(q);
  ASSERT_TRUE(paper.record(1).active);
  ASSERT_LT(paper.record(1).depth, 0.0);
  ASSERT_GT(paper.record(0).depth, 0.0);
  ASSERT_FALSE(paper.record(2).active);
  paper.tick(index_angles(0.54, 0.25, 0.1));
  ASSERT_TRUE(paper.record(2).active);
  EXPECT_NEAR(paper.gdp(3), 0.05, 1e-6);
  EXPECT_NEAR(paper.record(2).offset, y3(0.5, 0.7, 0.75) - y3(0.54, 0.79, 0.84), 2.0 * kPlace);
  EXPECT_GT(paper.record(2).offset, 1e-3);
}

// The first tick of all knows no HCP before it: d0 is taken with the HCP where it is now. MCP 0.4 and PIP 0.3
// against plates at MCP 0.3 and, from there, PIP 0.27.
TEST(GdpByHand, TheOffsetInTheFirstTickIsTakenWithTheHcpAsItIs) {
  TriangleMesh object = plate(f1(0.3), y1(0.3));
  append(object, plate(f2(0.3, 0.57), y2(0.3, 0.57)));
  const test::Setup model = paper_model(object);
  Paper paper(model);
  paper.tick(index_angles(0.4, 0.3));
  ASSERT_TRUE(paper.record(0).active);
  ASSERT_TRUE(paper.record(1).active);
  EXPECT_NEAR(paper.gdp(0), 0.3, 1e-6);
  EXPECT_NEAR(paper.gdp(2), 0.27, 1e-6);
  EXPECT_NEAR(paper.record(1).offset, y2(0.3, 0.57) - y2(0.4, 0.7), kPlace);
  EXPECT_NEAR(paper.record(1).depth, 0.0, kPlace);
}

// ---- S1's recorded trajectory ----

// The proximal corner is in the plate at MCP 0.4, and was above it at 0.2, a tick before: there the finger
// stays. Then the middle one is in its plate at PIP 0.3, and was not at 0.15: its d0 is taken with the HCP of
// this tick, MCP 0.4 and PIP 0.3, so that its depth begins at 0.
TEST(TrajectoryByHand, AContactIsAtTheLastFreePoseAndItsOffsetAtTheTicksEnd) {
  TriangleMesh object = plate(f1(0.3), y1(0.3));
  append(object, plate(f2(0.2, 0.45), y2(0.2, 0.45)));
  test::Setup model = paper_model(object);
  model.parameters.contact.method = GdpMethod::kTrajectory;
  Paper paper(model);
  paper.tick(index_angles(0.2));
  ASSERT_FALSE(paper.record(0).active);
  paper.tick(index_angles(0.4));
  ASSERT_TRUE(paper.record(0).active);
  EXPECT_EQ(paper.gdp(0), 0.2);
  EXPECT_EQ(paper.record(0).offset, 0.0);
  EXPECT_NEAR(paper.record(0).depth, y1(0.2) - y1(0.4), kPlace);
  paper.tick(index_angles(0.4, 0.15));
  ASSERT_FALSE(paper.record(1).active);
  paper.tick(index_angles(0.4, 0.3));
  ASSERT_TRUE(paper.record(1).active);
  EXPECT_EQ(paper.gdp(0), 0.2);
  EXPECT_EQ(paper.gdp(2), 0.15);
  EXPECT_NEAR(paper.record(1).offset, y2(0.2, 0.35) - y2(0.4, 0.7), kPlace);
  EXPECT_NEAR(paper.record(1).depth, 0.0, 1e-12);
}

// ---- where the search gives up ----

/// Nothing is within reach.
test::Setup far_model() {
  return paper_model(test::moved(make_box(Vec3(0.02, 0.02, 0.02), 12), test::at(0.0, -0.3, 0.0)));
}
/// The tip's farthest point from the MCP: two bones and the distal diamond's 21 mm.
constexpr double kTipReach = 86e-3;

// The joint moves by a hundred radians in one tick, and no object is near. One tick computes at most 1,000
// poses, 2.5 mm of the tip's way apart. The record says that the limit was reached, no force acts, and the
// following ticks go on until the finger arrives.
TEST(GdpByHand, AfterASearchThatGaveUpTheFingerGoesOn) {
  const test::Setup model = far_model();
  Paper paper(model);
  paper.tick(index_angles(0.0));
  int gave_up = 0;
  double before = 0.0;
  while (paper.gdp(0) != 100.0) {
    ASSERT_LT(gave_up, 20);
    paper.tick(index_angles(100.0));
    EXPECT_GT(paper.gdp(0), before);
    before = paper.gdp(0);
    if (before == 100.0) break;
    if (++gave_up == 1) {
      EXPECT_NEAR(before, 1000 * 2.5e-3 / kTipReach, 1e-6);
    }
    EXPECT_TRUE(has(paper.status, Status::kSearchExhausted));
    ASSERT_TRUE(paper.record(2).active);
    EXPECT_EQ(paper.record(2).offset, std::numeric_limits<double>::infinity());
    EXPECT_LT(paper.record(2).depth, 0.0);
  }
  EXPECT_GE(gave_up, 1);
  EXPECT_FALSE(has(paper.status, Status::kSearchExhausted));
  for (int k = 0; k < kSegmentsPerDigit; ++k) EXPECT_FALSE(paper.record(k).active) << k;
}

// The record of a search that gave up 10 um beyond the margin of a plate says so; 10 um within it, it is a
// contact like any other, and so it is where the search came to its end. (1 rad of the corner's way is 17 mm
// of height there.)
TEST(GdpByHand, ARecordOfASearchThatGaveUpIsAContactWithinTheMargin) {
  const test::Setup model = paper_model(plate(f1(0.5), y1(0.5)));
  const ContactModel contact{model.hand, model.trees(), model.object, model.parameters.contact};
  for (const double beyond : {10e-6, -10e-6}) {
    for (const bool gave_up : {true, false}) {
      SCOPED_TRACE(::testing::Message() << beyond << (gave_up ? " given up" : ""));
      GdpState state(contact);
      const DigitAngles angle = digit_angles(index_angles(0.5 - beyond / f1(0.5)), test::kIndex);
      DigitPose pose;
      model.hand.digit_pose(test::kIndex, angle, pose);
      DigitTick tick{.digit = test::kIndex,
                     .hcp_from = angle,
                     .hcp = angle,
                     .hcp_pose = pose,
                     .angle = angle,
                     .pose = pose};
      if (gave_up) tick.status = Status::kSearchExhausted;
      make_record(contact, tick, 0, 0.0, 1.0, nullptr, state);
      const ContactRecord& record = record_of(state, tick, 0);
      ASSERT_TRUE(record.active);
      EXPECT_EQ(record.offset, gave_up && beyond > 0.0 ? std::numeric_limits<double>::infinity() : 0.0);
    }
  }
}

// The foremost corner, 21 mm from the MCP, meets a plate at 1.3; the HCP turns on to 2.0, past the lowest
// place, and its corner is above the plate again. In a second plate there the finger is felt: the corner
// begins to go down at 21 mm cos(1.3) for each radian of 0.7, and ends higher than it began. The parabola of
// that beginning and end is v^2 / (4 (v - end)) deep. Without the second plate the hand has left, and nothing
// pushes.
TEST(GdpByHand, AFingerThatHasTurnedPastTheContactsPlaneIsFeltWhileItIsInTheObject) {
  constexpr double kStop = 1.3;
  constexpr double kTo = 2.0;
  const TriangleMesh first = plate(21e-3 * std::cos(kStop), -21e-3 * std::sin(kStop));
  TriangleMesh both = first;
  append(both, plate(20e-3 * std::cos(kTo), -20e-3 * std::sin(kTo)));
  const double closing = 21e-3 * std::cos(kStop) * (kTo - kStop);
  const double end = 21e-3 * (std::sin(kTo) - std::sin(kStop));
  ASSERT_LT(end, -1e-3);
  for (const bool inside : {true, false}) {
    const test::Setup model = paper_model(inside ? both : first);
    Paper paper(model);
    paper.tick(index_angles(1.0));
    paper.tick(index_angles(kTo));
    ASSERT_TRUE(paper.record(0).active);
    EXPECT_NEAR(paper.gdp(0), kStop, 5e-6);
    EXPECT_EQ(paper.record(0).along, inside);
    EXPECT_NEAR(paper.record(0).depth, inside ? closing * closing / (4.0 * (closing - end)) : end, kPlace);
  }
}

// The side corner of the proximal diamond rests against a wall, 0.4 mm behind it, while the HCP flexes to
// 0.6: the wall's direction is the axis of flexion, so that nothing changes. Then the HCP leaves the wall,
// and the finger falls onto a plate that it meets at 0.3: over 5 mm behind it.
struct Hop {
  Hop() {
    TriangleMesh object;
    for (const double side : {-1.0, 1.0}) {
      const double wall = 20e-3 * std::sin(kTouch) + 1e-3 * std::cos(kTouch) + kPaperMargin;
      append(object, test::moved(make_box(Vec3(0.002, 0.04, 0.006), 12),
                                 test::at(side * (wall + 1e-3), -5e-3, -20e-3)));
    }
    const double f = 20e-3 * std::cos(0.09) * std::cos(0.3) - 1e-3 * std::sin(0.3);
    append(object, plate(f, height(0.3, 0.09)));
    model.emplace(paper_model(object));
    paper.emplace(*model);
    for (const JointArray& q :
         {index_angles(0, 0, 0, 0.05), index_angles(0, 0, 0, kPast), index_angles(0.6, 0, 0, kPast)})
      paper->tick(q);
    pushed = paper->record(0).depth;
    paper->tick(index_angles(0.6, 0, 0, 0.09));
  }
  static constexpr double kTouch = 0.1;
  static constexpr double kPast = 0.12;
  /// Of the lowest corner.
  static double height(double p, double a) { return -20e-3 * std::cos(a) * std::sin(p) - 1e-3 * std::cos(p); }
  [[nodiscard]] const ContactRecord& record() const { return paper->record(0); }

  std::optional<test::Setup> model;
  std::optional<Paper> paper;
  double pushed = 0.0;  ///< by the wall, before the hop [m]
};

TEST(GdpByHand, TheForceGoesOnWhereAContactHops) {
  const Hop hop;
  EXPECT_NEAR(hop.pushed, 20e-3 * (std::sin(0.12) - std::sin(0.1)) + 1e-3 * (std::cos(0.12) - std::cos(0.1)),
              kPlace);
  ASSERT_TRUE(hop.record().active);
  EXPECT_NEAR(hop.paper->gdp(0), 0.3, 1e-3);
  EXPECT_GT(hop.record().penetration, 5e-3);
  EXPECT_TRUE(hop.record().fades);
  // In that tick the HCP goes 0.6 mm aside at most, and by y (cos 0.09 - cos 0.12) deeper.
  const double aside = 20e-3 * 0.03;
  EXPECT_GE(hop.record().depth, hop.pushed - kPlace);
  EXPECT_LE(hop.record().depth, hop.pushed + kFade * aside + Hop::height(0.6, 0.12) - Hop::height(0.6, 0.09));
}

TEST(GdpByHand, AfterAHopAFingerThatPressesDeeperHasTheWholeStiffness) {
  Hop hop;
  const ContactRecord before = hop.record();
  hop.paper->tick(index_angles(0.7, 0, 0, 0.09));
  const double deeper = Hop::height(0.6, 0.09) - Hop::height(0.7, 0.09);
  EXPECT_NEAR(hop.record().penetration - before.penetration, deeper, 1e-9);
  const double way = 2.0 * std::sqrt(400.0 + 1.0) * 1e-3 * std::sin(0.05);  // of the corner, at most
  EXPECT_GE(hop.record().depth - before.depth, deeper);
  EXPECT_LE(hop.record().depth - before.depth, deeper + kFade * (way - deeper) + 1e-9);
}

TEST(GdpByHand, AfterAHopAFingerThatComesOutHasAForceUntilItIsOut) {
  Hop hop;
  double share = hop.record().depth / hop.record().penetration;
  for (const double p : {0.55, 0.5, 0.4, 0.35, 0.31}) {
    hop.paper->tick(index_angles(p, 0, 0, 0.09));
    ASSERT_TRUE(hop.record().active);
    const double now = hop.record().depth / hop.record().penetration;
    EXPECT_GT(now, share) << p;
    share = now;
  }
  EXPECT_LT(share, 1.0);
  EXPECT_LT(hop.record().depth, 0.2e-3);
  hop.paper->tick(index_angles(0.2, 0, 0, 0.09));
  EXPECT_EQ(hop.paper->gdp(0), 0.2);
  EXPECT_FALSE(hop.record().active);
}

// The HCP goes along the plate by abduction: 0.2 mm of d0 for each millimetre.
TEST(GdpByHand, AfterAHopTheOffsetShrinksWithTheWayOfTheHcp) {
  Hop hop;
  const ContactRecord before = hop.record();
  hop.paper->tick(index_angles(0.6, 0, 0, 0.0));
  hop.paper->tick(index_angles(0.6, 0, 0, -0.1));
  EXPECT_LT(hop.record().offset, before.offset - 0.9 * kFade * 20e-3 * 0.19);
  EXPECT_GT(hop.record().offset, before.offset - 1.1 * kFade * 20e-3 * 0.19);
  for (int n = 0; n < 40; ++n) hop.paper->tick(index_angles(0.6, 0, 0, n % 2 == 0 ? 0.1 : -0.1));
  EXPECT_EQ(hop.record().offset, 0.0);
  const double held = hop.record().depth;
  EXPECT_NEAR(held, hop.record().penetration, 1e-12);
}

TEST(GdpByHand, TheDeepestPlaceOfAParabolaIsItsVertexOrItsEnd) {
  EXPECT_EQ(deepest(4.0, -1.0), 0.8);
  EXPECT_EQ(deepest(4.0, 2.0), 2.0) << "the vertex is the end";
  EXPECT_EQ(deepest(4.0, 3.0), 3.0);
  EXPECT_EQ(deepest(-1.0, -2.0), -2.0) << "it only rises";
  EXPECT_EQ(deepest(0.0, 0.0), 0.0);
}

// The HCP comes back to where the proximal phalanx has stopped, and from there only the PIP moves: the
// proximal record stands until its own phalanx moves away.
TEST(GdpByHand, ARecordStandsWhileOnlyFartherJointsMove) {
  const test::Setup model = paper_model(plate(f1(0.5), y1(0.5)));
  Paper paper(model);
  paper.tick(index_angles(0.4));
  paper.tick(index_angles(0.55));
  ASSERT_TRUE(paper.record(0).active);
  const double stop = paper.gdp(0);
  paper.tick(index_angles(stop));
  ASSERT_TRUE(paper.record(0).active);
  paper.tick(index_angles(stop, 0.1));
  EXPECT_EQ(paper.gdp(2), 0.1);
  EXPECT_TRUE(paper.record(0).active);
  paper.tick(index_angles(stop - 0.01, 0.1));
  EXPECT_EQ(paper.gdp(0), stop - 0.01);
  EXPECT_FALSE(paper.record(0).active);
}

// Of the way from the GDP's point to the HCP's only what lies along the plate counts: from MCP 0.5 to 0.87
// the corner goes 4.94 mm forward (and 5.47 mm down, 7.4 mm in all), to 0.88 it goes 5.10 mm. `slid` begins
// at 5.
TEST(GdpByHand, SlidIsTheWayAlongTheSurface) {
  const test::Setup model = paper_model(plate(f1(0.5), y1(0.5)));
  ASSERT_LT(f1(0.5) - f1(0.87), 5e-3);
  ASSERT_GT(f1(0.5) - f1(0.88), 5e-3);
  Paper paper(model);
  paper.tick(index_angles(0.4));
  for (const double p : {0.87, 0.88, 0.87}) {
    paper.tick(index_angles(p));
    ASSERT_TRUE(paper.record(0).active) << p;
    EXPECT_EQ(has(paper.status, Status::kSlid), p > 0.875) << p;
  }
}

// The corner comes within the margin by 0.1 nm just at the tick's end, while the PIP still moves: that is a
// stop like any other, and no search that gave up. 5.86e-9 rad are 0.1 nm of its way of 17 mm.
TEST(GdpByHand, AStopAtTheVeryEndOfATickIsAStop) {
  const test::Setup model = paper_model(plate(f1(0.5), y1(0.5)));
  Paper paper(model);
  paper.tick(index_angles(0.4));
  paper.tick(index_angles(0.5 + 5.86e-9, 0.05));
  EXPECT_EQ(paper.status, Status::kOk);
  EXPECT_TRUE(paper.record(0).active);
  EXPECT_FALSE(paper.record(1).active);
  EXPECT_FALSE(paper.record(2).active);
  EXPECT_EQ(paper.gdp(2), 0.05);
}

// ---- the open hand ----

// The lowest corner is 30 um above a plate, within the margin.
TEST(GdpByHand, AnOpenFingerWithinTheMarginIsASetUpErrorThatSaysHowNear) {
  const test::Setup model = paper_model(plate(f1(0.0), y1(0.0) + 20e-6));
  EXPECT_THAT([&] { Paper paper(model); },
              ::testing::ThrowsMessage<std::invalid_argument>(
                  ::testing::AllOf(::testing::HasSubstr("the open hand (index-finger-phalanx-proximal)"),
                                   ::testing::HasSubstr(" is 0.030000 mm from the object"),
                                   ::testing::HasSubstr("the margin of 0.050000 mm"))));
}

// A cone of 36 sides, which fold by less than 30 degrees, so that all its normals at the apex are its axis.
// The proximal corner meets the apex 60 degrees beside the axis: the force may turn from there towards the
// axis by 30.
TEST(GdpByHand, TheForceTurnsFromTheContactsDirectionTowardsTheNormalByThirtyDegrees) {
  const double lean = 60.0 * kDeg;
  TriangleMesh cone;  // apex up at the origin, half angle 20 degrees
  cone.vertices = {Vec3::Zero(), Vec3(0.0, -5e-3, 0.0)};
  const double radius = 5e-3 * std::tan(20.0 * kDeg);
  for (int i = 0; i < 36; ++i)
    cone.vertices.emplace_back(radius * std::cos(10.0 * i * kDeg), -5e-3,
                               -radius * std::sin(10.0 * i * kDeg));
  for (int i = 0; i < 36; ++i) {
    const int a = 2 + i;
    const int b = 2 + (i + 1) % 36;
    cone.triangles.push_back({0, a, b});
    cone.triangles.push_back({1, b, a});
  }
  const double f = f1(0.5) - kPaperMargin * std::sin(lean);
  const double y = y1(0.5) - kPaperMargin * std::cos(lean);
  const test::Setup model = paper_model(test::moved(cone, test::at(0.0, y, -f)));
  Paper paper(model);
  paper.tick(index_angles(0.4));
  paper.tick(index_angles(0.6));
  ASSERT_TRUE(paper.record(0).active);
  EXPECT_NEAR(paper.gdp(0), 0.5, 1e-6);
  // 10 nm of the margin's 50 um are 2e-4 rad.
  EXPECT_LT((paper.record(0).n_c - Vec3(0.0, std::cos(lean), -std::sin(lean))).norm(), 2e-4);
  const double turned = 30.0 * kDeg;
  EXPECT_LT((paper.record(0).force_normal - Vec3(0.0, std::cos(turned), -std::sin(turned))).norm(), 2e-4);
}

// Both corners reach their plates at s = 0.5 of one tick: MCP 0.4 to 0.6, PIP 0 to -0.1, that is at MCP 0.5
// and PIP -0.05. The middle phalanx decides, so that the PIP stops too, although its way from there leads off
// the plate. The middle one's plate is 0.2 nm higher: whatever rounding does, where the proximal one closes
// the middle one does.
TEST(GdpByHand, OfTwoAtTheSameMomentTheDistalOneDecides) {
  TriangleMesh object = plate(f1(0.5), y1(0.5));
  append(object, plate(f2(0.5, 0.45), y2(0.5, 0.45) + 0.2e-9));
  const test::Setup model = paper_model(object);
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

// The same where the distal one is slow and near the tick's end: at s = 0.9999 both are at the margin, MCP
// 0.5 and PIP -0.27. The proximal corner closes at 1.7 mm a tick, the middle one at 0.24: when the proximal
// one must stop, nothing urges to look at the middle one, and yet it decides.
TEST(GdpByHand, ADistalSegmentThatIsWithinTheMarginDecidesHoweverSlowlyItCloses) {
  TriangleMesh object = plate(f1(0.5), y1(0.5));
  append(object, plate(f2(0.5, 0.23), y2(0.5, 0.23)));
  const test::Setup model = paper_model(object);
  Paper paper(model);
  paper.tick(index_angles(0.4));
  paper.tick(index_angles(0.4 + 0.1 / 0.9999, -0.27 / 0.9999));
  ASSERT_TRUE(paper.record(0).active);
  ASSERT_TRUE(paper.record(1).active);
  EXPECT_NEAR(paper.gdp(2), -0.27, 6e-6);
}

// The corner slides sideways 52 um over a floor, beyond the margin, into a wall: 5 um more than the wall's 50
// um would tie, but the segment does not run into the floor. Abduction by a takes the corner at the side to
// 20 sin a + cos a.
TEST(GdpByHand, AFloorThatTheSegmentSlidesOverIsNoPartOfTheWallsContact) {
  const double wall = -20e-3 * std::sin(0.2) - 1e-3 * std::cos(0.2) - kPaperMargin;
  TriangleMesh object =
      test::moved(make_box(Vec3(0.03, 0.002, 0.01), 12), test::at(0.0, -2e-3 - 52e-6, -0.02));
  append(object, make_box(Vec3(0.002, 0.01, 0.01), 12), test::at(wall - 1e-3, 0.0, -0.02));
  const test::Setup model = paper_model(object);
  Paper paper(model);
  paper.tick(index_angles(0.0, 0.0, 0.0, 0.1));
  paper.tick(index_angles(0.0, 0.0, 0.0, 0.3));
  ASSERT_TRUE(paper.record(0).active);
  EXPECT_NEAR(paper.gdp(1), 0.2, 1e-6);
  EXPECT_LT((paper.record(0).n_c - Vec3::UnitX()).norm(), 1e-12);
}

/// A 2 mm cube so far from a wall towards +x and from a floor towards -y, moving at `velocity`: its contact
/// within 50 um.
ContactPatch before_wall_and_floor(double wall, double floor, const Vec3& velocity) {
  TriangleMesh walls = test::moved(make_box(Vec3(0.04, 0.002, 0.04), 12), test::at(0.0, -1e-3, 0.0));
  append(walls, make_box(Vec3(0.002, 0.04, 0.04), 12), test::at(1e-3, 0.0, 0.0));
  const ObjectModel object(walls);
  const SegmentTree cube(make_box(Vec3::Constant(2e-3), 12));
  SearchScratch scratch(cube);
  const Pose X{Mat3::Identity(), Vec3(-1e-3 - wall, 1e-3 + floor, 0.0)};
  SegmentMotion motion;
  motion.linear = velocity;
  return contact_patch({cube, X, scratch}, object, 50e-6, &motion);
}

TEST(ContactPatchByHand, CountsWhatClosesAtLeastHalfAsFastAsTheFastest) {
  const Vec3 off_wall = -Vec3::UnitX();
  const Vec3 off_floor = Vec3::UnitY();
  // Towards the wall alone: the floor, though it is nearer, has no part in it.
  ContactPatch patch = before_wall_and_floor(48e-6, 47e-6, Vec3(1.0, 0.0, 0.0));
  EXPECT_NEAR(patch.distance, 48e-6, 1e-12);
  EXPECT_LT((patch.direction - off_wall).norm(), 1e-12);
  // 0.4 of the wall's speed towards the floor: less than half, so the same.
  patch = before_wall_and_floor(48e-6, 47e-6, Vec3(1.0, -0.4, 0.0));
  EXPECT_LT((patch.direction - off_wall).norm(), 1e-12);
  // 0.6 of it: both count.
  patch = before_wall_and_floor(48e-6, 47e-6, Vec3(1.0, -0.6, 0.0));
  EXPECT_NEAR(patch.distance, 47e-6, 1e-12);
  EXPECT_GT(patch.direction.dot(off_wall), 0.5);
  EXPECT_GT(patch.direction.dot(off_floor), 0.5);
  // Away from the floor at the wall: the floor does not close.
  patch = before_wall_and_floor(48e-6, 47e-6, Vec3(1.0, 2.0, 0.0));
  EXPECT_LT((patch.direction - off_wall).norm(), 1e-12);
  // A wall beyond the 50 um leads nothing, however fast it comes.
  patch = before_wall_and_floor(53e-6, 47e-6, Vec3(1.0, -0.3, 0.0));
  EXPECT_NEAR(patch.distance, 47e-6, 1e-12);
  EXPECT_LT((patch.direction - off_floor).norm(), 1e-12);
  // Nothing closes: all count.
  patch = before_wall_and_floor(48e-6, 47e-6, Vec3(-1.0, 1.0, 0.0));
  EXPECT_GT(patch.direction.dot(off_wall), 0.5);
  EXPECT_GT(patch.direction.dot(off_floor), 0.5);
}

/// A slab whose face has the unit normal n, in the xy plane, and is so far from the origin.
TriangleMesh wall_facing(const Vec3& n, double apart) {
  const Mat3 R = Eigen::AngleAxisd(std::atan2(-n.x(), n.y()), Vec3::UnitZ()).toRotationMatrix();
  // Off the middle, where the face's two triangles meet.
  return test::moved(make_box(Vec3(0.04, 0.002, 0.03), 12), Pose{R, -(apart + 1e-3) * n + Vec3(0, 0, 3e-3)});
}

/// A narrow pyramid that stands on its apex, which is at the origin.
TriangleMesh spike_down() {
  TriangleMesh spike;
  spike.vertices = {Vec3::Zero(), Vec3(2e-4, 2e-3, 1e-4), Vec3(-2e-4, 2e-3, 1e-4), Vec3(0, 2e-3, -2e-4)};
  spike.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  return spike;
}

// A spike's lowest corner in a groove of two walls at 45 degrees, 48 um from the one and 49 from the other:
// one point of the spike, two places on the walls. Within 53 um they count 1 and 1 - 1 um / 5 um.
TEST(ContactPatchByHand, OnePointOfTheSegmentBeforeTwoWallsIsTwoPlaces) {
  const double half = std::numbers::sqrt2 / 2.0;
  const Vec3 left(half, half, 0.0);  // out of the wall on the left
  const Vec3 right(-half, half, 0.0);
  TriangleMesh groove = wall_facing(left, 48e-6);
  append(groove, wall_facing(right, 49e-6));
  const SegmentTree segment(spike_down());
  SearchScratch scratch(segment);
  const Pose X;
  const ContactPatch patch = contact_patch({segment, X, scratch}, ObjectModel(groove), 1e-4);
  EXPECT_NEAR(patch.distance, 48e-6, 1e-12);
  EXPECT_LT((patch.direction - (left + 0.8 * right).normalized()).norm(), 1e-6);
  EXPECT_LT((patch.object_normal - patch.direction).norm(), 1e-6) << "between the walls' normals: itself";
  // Feet at -48 um left and -49 um right, weighed the same way.
  EXPECT_LT((patch.on_object + (48e-6 * left + 0.8 * 49e-6 * right) / 1.8).norm(), 1e-10);
}

// A spike 480 um over a floor and 481 um from a wall that leans by `lean` against it. It comes down at a
// slant of `slant` away from the wall: the floor closes at cos(slant), the wall at cos(slant + lean). At a
// slant of 50 degrees that is less than half as fast, and the wall counts only if it leans by less than 30
// degrees.
TEST(ContactPatchByHand, CountsWhatFacesWithinThirtyDegreesOfTheFastestHoweverSlowlyItCloses) {
  struct Approach {
    double lean;
    double slant;
    bool both;
  };
  for (const Approach& way : {Approach{25.0, 50.0, true},
                              {29.0, 50.0, true},
                              {31.0, 50.0, false},
                              {35.0, 50.0, false},
                              {35.0, 0.0, true}}) {
    SCOPED_TRACE(::testing::Message() << way.lean << " degrees, at a slant of " << way.slant);
    const double lean = way.lean * kDeg;
    const double slant = way.slant * kDeg;
    const Vec3 wall(-std::sin(lean), std::cos(lean), 0.0);
    TriangleMesh object = wall_facing(Vec3::UnitY(), 480e-6);
    append(object, wall_facing(wall, 481e-6));
    const SegmentTree segment(spike_down());
    SearchScratch scratch(segment);
    const Pose X;
    SegmentMotion motion;
    motion.linear = Vec3(-std::sin(slant), -std::cos(slant), 0.0);
    const ContactPatch patch = contact_patch({segment, X, scratch}, ObjectModel(object), 1e-3, &motion);
    EXPECT_NEAR(patch.distance, 480e-6, 1e-12);
    const Vec3 expected = way.both ? Vec3((Vec3::UnitY() + 0.8 * wall).normalized()) : Vec3(Vec3::UnitY());
    EXPECT_LT((patch.direction - expected).norm(), 1e-6);
  }
}

// A triangle with legs of 3 and 4 mm lies 50 um over a large one: A = 6 mm^2, its edges 3, 5 and 4 mm.
TEST(TiedRegionByHand, OfAFaceOverAFaceIsTheFaceWidenedByTheBand) {
  const double e = 5e-6;
  const double up = 50e-6;
  const Corners small = {Vec3(0, 0, up), Vec3(3e-3, 0, up), Vec3(0, 4e-3, up)};
  const Corners large = {Vec3(-1, -1, 0), Vec3(3, -1, 0), Vec3(-1, 3, 0)};
  const TiedRegion region = tied_region(small, large, triangle_distance(small, large), up + e, e);
  const double disc = std::numbers::pi * e * e;
  const double weight = 6e-6 + 12e-3 * e + disc;
  EXPECT_NEAR(region.weight, weight, 1e-17);
  const Vec3 centroid(1e-3, 4e-3 / 3.0, 0.0);  // also the corners' mean
  const Vec3 rim = 3e-3 * Vec3(1.5e-3, 0, 0) + 5e-3 * Vec3(1.5e-3, 2e-3, 0) + 4e-3 * Vec3(0, 2e-3, 0);
  const Vec3 middle = ((6e-6 + disc) * centroid + e * rim) / weight;
  EXPECT_LT((region.on_a - middle - Vec3(0, 0, up)).norm(), 1e-14);
  EXPECT_LT((region.on_b - middle).norm(), 1e-14);
}

// In mm: the triangle (0, 0), (6, 0), (0, 6), 50 um over (1, 1), (9, -1), (3, 9). They overlap in (1, 1), a
// corner of the lower one; (5, 0), where two edges cross; (6, 0), a corner of the upper one; and (1.8, 4.2),
// where two edges cross again. The shoelace formula's terms are -5, 0, 25.2 and -2.4, so that A = 8.9 mm^2,
// and 6 A times the centroid is (159.84, 88.36).
TEST(TiedRegionByHand, OfTwoFacesIsWhereTheyOverlap) {
  const double e = 5e-6;
  const Vec3 up(0, 0, 50e-6);
  const auto in_mm = [](double x, double y) { return Vec3(1e-3 * x, 1e-3 * y, 0.0); };
  const Corners upper = {in_mm(0, 0) + up, in_mm(6, 0) + up, in_mm(0, 6) + up};
  const Corners lower = {in_mm(1, 1), in_mm(9, -1), in_mm(3, 9)};
  const std::array<Vec3, 4> corner = {in_mm(1, 1), in_mm(5, 0), in_mm(6, 0), in_mm(1.8, 4.2)};
  const double disc = std::numbers::pi * e * e;
  double weight = 8.9e-6 + disc;
  Vec3 sum = 8.9e-6 * in_mm(159.84, 88.36) / (6.0 * 8.9);
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3& next = corner[(i + 1) % 4];
    const double band = e * (next - corner[i]).norm();
    weight += band;
    sum += 0.5 * band * (corner[i] + next) + 0.25 * disc * corner[i];
  }
  const Vec3 middle = sum / weight;
  const TiedRegion region = tied_region(upper, lower, triangle_distance(upper, lower), up.z() + e, e);
  EXPECT_NEAR(region.weight, weight, 1e-15);
  EXPECT_LT((region.on_a - middle - up).norm(), 1e-11);
  EXPECT_LT((region.on_b - middle).norm(), 1e-11);
  const TiedRegion turned = tied_region(lower, upper, triangle_distance(lower, upper), up.z() + e, e);
  EXPECT_NEAR(turned.weight, weight, 1e-15);
  EXPECT_LT((turned.on_a - middle).norm(), 1e-11);
  EXPECT_LT((turned.on_b - middle - up).norm(), 1e-11);
}

// A triangle that stands on an edge of 2 mm, 50 um over the middle of a ridge of 6 mm: the line is one of 2
// mm, there and back, with no area. Its ends are found several times, which moves the middle by the disc's
// share of 0.4 % of less than 1 mm, but along the line alone.
TEST(TiedRegionByHand, OfAnEdgeOverAnEdgeIsALineOnEach) {
  const double e = 5e-6;
  const double up = 50e-6;
  const Corners standing = {Vec3(-1e-3, 0, up), Vec3(1e-3, 0, up), Vec3(0, 1e-3, 5e-3)};
  const Corners ridge = {Vec3(-3e-3, 0, 0), Vec3(3e-3, 0, 0), Vec3(0, 1e-3, -5e-3)};
  for (const bool first : {true, false}) {
    const Corners& a = first ? standing : ridge;
    const Corners& b = first ? ridge : standing;
    const TiedRegion region = tied_region(a, b, triangle_distance(a, b), up + e, e);
    EXPECT_NEAR(region.weight, 4e-3 * e + std::numbers::pi * e * e, 1e-14);
    EXPECT_NEAR(region.on_a.x(), 0.0, 4e-6);
    EXPECT_NEAR(region.on_b.x(), 0.0, 4e-6);
    EXPECT_NEAR(region.on_a.y(), 0.0, 1e-12);
    EXPECT_NEAR(region.on_b.y(), 0.0, 1e-12);
    EXPECT_NEAR(region.on_a.z(), first ? up : 0.0, 1e-12);
    EXPECT_NEAR(region.on_b.z(), first ? 0.0 : up, 1e-12);
  }
}

// In um: a face with the corners (0, 0), (20, 15) and (30, -15), 50 over the x axis. All of it is within 55
// of the axis, for 15 aside make 52.2; nearest are its first corner and the middle of the opposite edge. A =
// |20 (-15) - 30 15| / 2 = 375. On the axis it is the line from 0 to 30, there and back.
TEST(TiedRegionByHand, OfASmallFaceOverALineIsTheWholeFace) {
  const double um = 1e-6;
  const double e = 5.0 * um;
  const double up = 50.0 * um;
  const Corners face = {Vec3(0, 0, up), Vec3(20 * um, 15 * um, up), Vec3(30 * um, -15 * um, up)};
  const Corners line = {Vec3(-1e-3, 0, 0), Vec3(1e-3, 0, 0), Vec3(1e-3, 0, 0)};
  const double disc = std::numbers::pi * e * e;
  const double rim = (25.0 + std::sqrt(1125.0) + std::sqrt(1000.0)) * um;
  const TiedRegion region = tied_region(face, line, triangle_distance(face, line), up + e, e);
  EXPECT_NEAR(region.weight, 375.0 * um * um + e * rim + disc, 1e-15);
  const TiedRegion turned = tied_region(line, face, triangle_distance(line, face), up + e, e);
  EXPECT_GE(turned.weight, e * 60.0 * um + disc - 1e-15);
}

// Edges that cross 2 apart. Where rounding makes the limit a little less than that, nothing ties: the region
// is the closest point.
TEST(TiedRegionByHand, OfNothingWithinTheLimitIsTheClosestPoint) {
  const Corners a = {Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, -1)};
  const Corners b = {Vec3(0, -1, 2), Vec3(0, 1, 2), Vec3(0, 0, 3)};
  const TiedRegion region = tied_region(a, b, triangle_distance(a, b), 2.0 - 1e-12, 0.5);
  EXPECT_NEAR(region.weight, std::numbers::pi / 4.0, 1e-12);
  EXPECT_EQ(region.on_a, Vec3(0, 0, 0));
  EXPECT_EQ(region.on_b, Vec3(0, 0, 2));
}

// Twelve faces, 5 um beside the contact and turned by 20 to 75 degrees, tie before the one that the contact
// lies on. Each counts by half, so that they fill the fan with 10 to 37.5 degrees; that one's own normal is
// in it all the same.
TEST(NormalFanByHand, TheNearestFacesOwnNormalHasRoomHoweverManyTieBeforeIt) {
  TriangleMesh mesh;
  const auto add_face = [&](double turn, double apart) {
    const Vec3 normal(std::sin(turn), 0.0, std::cos(turn));
    const Vec3 u = 1e-3 * Vec3(std::cos(turn), 0.0, -std::sin(turn));
    const Vec3 v = 1e-3 * Vec3::UnitY();
    const Vec3 foot = -apart * normal;
    test::add_triangle(mesh, foot - u - v, foot + u - v, foot + v);
  };
  for (int i = 0; i < 12; ++i) add_face((20.0 + 5.0 * i) * kDeg, 5e-6);
  add_face(0.0, 0.0);
  const ObjectModel object(mesh);
  TiedTriangles tied;
  for (const bool nearest : {false, true}) {
    for (int slot = 0; slot < object.tree().size(); ++slot)
      if ((object.tree().source(slot) == 12) == nearest) tied.add(slot);
  }
  const Vec3 normal = normal_at_contact(object, tied, Vec3::Zero(), Vec3::UnitZ());
  EXPECT_LT((normal - Vec3::UnitZ()).norm(), 1e-9);
}

// A right-angled crease along y, one face z = 0 towards -x, one down from it. The contact is 5 um before the
// crease on the first face: the second face counts by half (10 um is the edge's width), so the fan reaches
// from z to the middle of z and x, 45 degrees. An n_c 60 degrees from z gets that end; one of 20 degrees
// itself.
TEST(NormalFanByHand, BesideACreaseTheOtherFaceCountsByHowNearItIs) {
  const TriangleMesh crease{
      {{-0.03, -0.03, 0}, {0, -0.03, 0}, {0, 0.03, 0}, {-0.03, 0.03, 0}, {0, -0.03, -0.03}, {0, 0.03, -0.03}},
      {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}};
  const ObjectModel object(crease);
  TiedTriangles tied;
  for (int slot = 0; slot < object.tree().size(); ++slot) tied.add(slot);
  const auto leaning = [](double degrees) {
    const double a = degrees * std::numbers::pi / 180.0;
    return Vec3(std::sin(a), 0.0, std::cos(a));
  };
  const Vec3 contact(-5e-6, 1e-3, 0.0);
  EXPECT_LT((normal_at_contact(object, tied, contact, leaning(60.0)) - leaning(45.0)).norm(), 1e-6);
  EXPECT_LT((normal_at_contact(object, tied, contact, leaning(20.0)) - leaning(20.0)).norm(), 1e-6);
  // A mean of places that hovers 4 um below the first face and 3 um before the second: the second is nearest,
  // the first counts by 1 - (4 - 3) / (10 + 3) = 12 / 13, and the fan ends at (1, 0, 12).
  const Vec3 hovering(-3e-6, 1e-3, -4e-6);
  const Vec3 end = Vec3(1.0, 0.0, 12.0).normalized();
  EXPECT_LT((normal_at_contact(object, tied, hovering, leaning(1.0)) - end).norm(), 1e-6);
  EXPECT_LT((normal_at_contact(object, tied, contact, Vec3::Zero()) - leaning(0.0)).norm(), 1e-12)
      << "they touch: the nearest face's own";
  EXPECT_EQ(normal_at_contact(object, {}, contact, leaning(20.0)), leaning(20.0))
      << "without a face there is no other";
}

// A sheet in the plane z = 0. 2.5 um inside any of its rims the way out counts by 3 / 4, 5 um inside by a
// half, 20 um inside not at all: the fan ends at 0.75 out + 0.25 up, halfway, or straight up.
TEST(NormalFanByHand, BesideARimTheWayOutCountsByHowNearItIs) {
  const ObjectModel object(TriangleMesh{{{-0.03, -0.03, 0}, {0, -0.03, 0}, {0, 0.03, 0}, {-0.03, 0.03, 0}},
                                        {{0, 1, 2}, {0, 2, 3}}});
  TiedTriangles tied;
  for (int slot = 0; slot < object.tree().size(); ++slot) tied.add(slot);
  struct Rim {
    Vec3 place;
    Vec3 out;
  };
  const Rim rims[] = {{Vec3(0, 1e-3, 0), Vec3::UnitX()},
                      {Vec3(-0.01, -0.03, 0), -Vec3::UnitY()},
                      {Vec3(-0.02, 0.03, 0), Vec3::UnitY()},
                      {Vec3(-0.03, 0.01, 0), -Vec3::UnitX()}};
  for (const Rim& rim : rims) {
    SCOPED_TRACE(::testing::Message() << "out along " << rim.out.transpose());
    const Vec3 n_c = (Vec3::UnitZ() + 20.0 * rim.out).normalized();
    const auto normal_inside = [&](double depth) {
      return normal_at_contact(object, tied, rim.place - depth * rim.out, n_c);
    };
    EXPECT_LT((normal_inside(2.5e-6) - (Vec3::UnitZ() + 3.0 * rim.out).normalized()).norm(), 1e-6);
    EXPECT_LT((normal_inside(5e-6) - (Vec3::UnitZ() + rim.out).normalized()).norm(), 1e-6);
    EXPECT_LT((normal_inside(20e-6) - Vec3::UnitZ()).norm(), 1e-6);
  }
}

// Links with offsets along their axes: 30 mm at the first segment's own joint, 20 mm at the second's. From
// joint to joint the first is hypot(40, 30) = 50 mm long.
TEST(ReachByHand, CountsTheOffsetsAlongTheAxes) {
  HandParameters parameters = test::simple_parameters();
  parameters.digits[test::kIndex].dh[1].d = 0.030;
  parameters.digits[test::kIndex].dh[2].d = -0.020;
  SegmentMeshes meshes = make_capsule_meshes(parameters, Handedness::kRight, 800);
  for (int k = 0; k < kSegmentsPerDigit; ++k) meshes[idx(segment_index(test::kIndex, k))] = diamond();
  const HandModel hand(parameters, Handedness::kRight, Pose{}, std::move(meshes));
  constexpr double kOwn = 21e-3;  // a diamond's farthest corner
  EXPECT_NEAR(hand.reach(test::kIndex, axis_of_joint(1), 0), kOwn + 0.030, 1e-15);
  EXPECT_NEAR(hand.reach(test::kIndex, axis_of_joint(0), 0), kOwn + 0.030, 1e-15);
  EXPECT_NEAR(hand.reach(test::kIndex, axis_of_joint(2), 1), kOwn + 0.020, 1e-15);
  EXPECT_NEAR(hand.reach(test::kIndex, axis_of_joint(1), 1), kOwn + 0.020 + 0.050, 1e-15);
  EXPECT_NEAR(hand.reach(test::kIndex, axis_of_joint(2), 2), kOwn + std::hypot(test::kLength2, 0.020), 1e-15);
}

// A point beyond a corner's angle has no negative share: (1, 1) mm before the legs x + y = 1 mm.
TEST(BarycentricByHand, APointBesideTheTriangleHasNoNegativeWeight) {
  const Corners t = {Vec3(0, 0, 0), Vec3(1e-3, 0, 0), Vec3(0, 1e-3, 0)};
  EXPECT_LT((barycentric(t, Vec3(1e-3, 1e-3, 0.0)) - Vec3(0.0, 0.5, 0.5)).norm(), 1e-12);
  EXPECT_LT((barycentric(t, Vec3(-1e-3, 0.5e-3, 0.0)) - Vec3(0.5, 0.0, 0.5)).norm(), 1e-12);
}

// (0.2, 0.3) of the legs, 5 mm above the triangle. And three corners on a line.
TEST(BarycentricByHand, WithinTheTriangleTheyAreTheShares) {
  const Corners t = {Vec3(0, 0, 0), Vec3(1e-3, 0, 0), Vec3(0, 1e-3, 0)};
  EXPECT_LT((barycentric(t, Vec3(0.2e-3, 0.3e-3, 5e-3)) - Vec3(0.5, 0.2, 0.3)).norm(), 1e-12);
  const Corners line = {Vec3(0, 0, 0), Vec3(1.0, 0, 0), Vec3(2.0, 0, 0)};
  EXPECT_EQ(barycentric(line, Vec3(0.5, 0.1, 0.2)), Vec3(Vec3::Constant(1.0 / 3.0)));
}

// Steps shorter than the margin: what is known of the distance is spent to the last micrometre before it is
// asked for again, and it must be asked for before the margin is reached.
TEST(GdpByHand, ASlowApproachStopsAtTheMargin) {
  for (const double step : {1e-4, 3e-4, 7e-4, 2e-3}) {  // 2 to 40 um of the corner's way
    SCOPED_TRACE(step);
    const test::Setup model = paper_model(plate(f1(0.5), y1(0.5)));
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

// A distance is asked for as far as the tip would go in 16 ticks, but for 0.3 mm at least and 4 mm at most,
// or twice what this tick needs; beyond the margin. The tick spends what the tip goes. Where nothing is
// within reach, the answer is all that was asked for.
TEST(GdpByHand, WhatIsKnownOfADistanceIsWhatWasAskedForLessTheWay) {
  struct Tick {
    double way;
    double asked;
  };
  const test::Setup model = far_model();
  const std::size_t tip = idx(segment_index(test::kIndex, 2));
  for (const Tick& tick : {Tick{10e-6, 0.3e-3}, {100e-6, 1.6e-3}, {400e-6, 4e-3}, {2.4e-3, 4.8e-3}}) {
    Paper paper(model);
    const GdpState& state = paper.tick(index_angles(tick.way / kTipReach));
    EXPECT_NEAR(state.clearance[tip].bound(), kPaperMargin + tick.asked - tick.way, 1e-12) << tick.way;
  }
}

// 4.05 mm are known, and each tick spends 0.39 mm. The tenth needs 0.44 with the margin, and 0.54 are left;
// the eleventh, for which 0.15 are left, asks again at once.
TEST(GdpByHand, ADistanceThatSufficedIsAskedForAgainWhenItIsSpent) {
  const test::Setup model = far_model();
  const std::size_t tip = idx(segment_index(test::kIndex, 2));
  Paper paper(model);
  for (int n = 1; n <= 11; ++n) {
    const GdpState& state = paper.tick(index_angles(n * 0.39e-3 / kTipReach));
    const double spent = 0.39e-3 * (n <= 10 ? n : 1);
    EXPECT_NEAR(state.clearance[tip].bound(), 4.05e-3 - spent, 1e-12) << n;
  }
}

}  // namespace
}  // namespace phalanx
