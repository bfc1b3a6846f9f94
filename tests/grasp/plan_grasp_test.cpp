// SPDX-License-Identifier: Apache-2.0
// Planned grasps: their contacts are checked against the conditions of the type.
#include "phalanx/grasp/plan_grasp.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "grasp/wrench_ball.h"
#include "phalanx/core/index.h"
#include "phalanx/mesh/objects.h"
#include "phalanx/mesh/primitives.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

const HandModel& adult() {
  static const HapticModel kModel = build_model(load_scene("wave"));
  return kModel.hand;
}

GraspSearch planned(GraspType type, const TriangleMesh& mesh, const HandModel& hand = adult(),
                    std::uint64_t seed = 1) {
  return plan_grasp(hand, ObjectModel(mesh), {.type = type, .seed = seed, .parameters = {}, .progress = {}});
}

/// Checks what each grasp must fulfil, whatever the object.
void expect_grasp(GraspType type, const PlannedGrasp& grasp, const HandModel& hand = adult()) {
  const GraspRule& rule = grasp_rule(type);
  SCOPED_TRACE(std::string(rule.name));
  const HandModel placed(hand.parameters(), hand.handedness(), grasp.X_WH, hand.meshes());
  HandPoses poses;
  placed.poses(grasp.touch, poses);
  Vec3 thumb = Vec3::Zero();
  Vec3 fingers = Vec3::Zero();
  std::array<bool, kDigits> touches{};
  std::array<bool, kDigits> with_distal_pad{};
  std::array<bool, kDigits> holds_pull{};
  bool palm = false;
  for (const PlannedContact& contact : grasp.contact) {
    EXPECT_NEAR(contact.normal.norm(), 1.0, 1e-9);
    if (contact.segment == kPalm) {
      palm = true;
      continue;
    }
    const int digit = digit_of_segment(contact.segment);
    touches[idx(digit)] = true;
    EXPECT_TRUE(rule.digit[idx(digit)]) << digit_name(digit);
    (digit == 0 ? thumb : fingers) += contact.normal;
    if (contact.segment % kSegmentsPerDigit == 2 && contact.pad) with_distal_pad[idx(digit)] = true;
    // The hand's +Z looks from the fingertips to the wrist; the object is pushed against the normal.
    if (-contact.normal.dot(grasp.X_WH.R.col(2)) >= 0.5) holds_pull[idx(digit)] = true;
    const bool aside = type == GraspType::kLateral && digit > 0;
    const Mat3& R = poses.digit[idx(digit)].segment[idx(contact.segment % kSegmentsPerDigit)].R;
    if (aside) {
      const double side = hand.handedness() == Handedness::kRight ? 1.0 : -1.0;
      EXPECT_GE(side * R.col(0).dot(contact.normal), 0.5) << "not the side that looks to the thumb";
    } else {
      EXPECT_GT(R.col(1).dot(contact.normal), 0.25) << segment_name(contact.segment);
    }
  }
  EXPECT_TRUE(!rule.pads || with_distal_pad == touches);
  EXPECT_TRUE(type != GraspType::kLateral || with_distal_pad[0]);
  EXPECT_TRUE(type != GraspType::kHook || std::count(holds_pull.begin(), holds_pull.end(), true) >= 2);
  EXPECT_EQ(palm, rule.palm);
  if (rule.digit[0]) {
    EXPECT_TRUE(touches[0]);
    EXPECT_LE(thumb.normalized().dot(fingers.normalized()), rule.most_cosine);
  }
  EXPECT_GE(std::count(touches.begin() + 1, touches.end(), true), rule.least_fingers);
  EXPECT_TRUE(!rule.closure || grasp.wrench_ball >= PlannedGrasp::kLeastBall);
  for (int j = 0; j < kJoints; ++j) {
    for (const double angle : {grasp.touch[idx(j)], grasp.press[idx(j)]}) {
      EXPECT_GE(angle, hand.parameters().min_angle[idx(j)]) << joint_name(j);
      EXPECT_LE(angle, hand.parameters().max_angle[idx(j)]) << joint_name(j);
    }
  }
  EXPECT_GT(grasp.comfort, 0.0);
  EXPECT_LE(grasp.comfort, 1.0);
}

struct Case {
  GraspType type;
  TriangleMesh mesh;
};
std::vector<Case> cases() {
  return {{GraspType::kCylinder, make_cylinder(0.05, 0.14, 800)},
          {GraspType::kSphere, make_sphere(0.07, 400)},
          {GraspType::kTripod, make_sphere(0.05, 400)},
          {GraspType::kPinch, make_sphere(0.04, 400)},
          {GraspType::kLateral, make_key(0.057, 0.025, 0.0022, 800)},
          {GraspType::kHook, make_torus(0.11, 0.024, 1000)},
          {GraspType::kDisk, make_cylinder(0.07, 0.02, 800)}};
}

TEST(PlanGrasp, FindsEachTypeOnAnObjectOfItsKind) {
  for (const auto& [type, mesh] : cases()) {
    const GraspSearch search = planned(type, mesh);
    ASSERT_TRUE(search.grasp.has_value())
        << grasp_rule(type).name << ": " << grasp_condition_text(search.obstacle());
    expect_grasp(type, *search.grasp);
    // The open hand, with which a scene begins, is clear of the object.
    const PlannedGrasp& grasp = *search.grasp;
    const HapticModel model(
        HandModel(adult().parameters(), adult().handedness(), grasp.X_WH, adult().meshes()),
        ObjectModel(mesh));
    EXPECT_NO_THROW(HapticState(model, HapticParameters())) << grasp_rule(type).name;
  }
}

// On a ball the contacts' places and directions are known: on its surface, away from its centre.
TEST(PlanGrasp, ContactsOfABallAreOnItAndLookOutwards) {
  for (const GraspType type : {GraspType::kSphere, GraspType::kTripod, GraspType::kPinch}) {
    const GraspSearch search = planned(type, make_sphere(0.06, 2000));
    ASSERT_TRUE(search.grasp.has_value()) << grasp_rule(type).name;
    for (const PlannedContact& contact : search.grasp->contact) {
      EXPECT_NEAR(contact.point.norm(), 0.03, 0.2e-3);
      EXPECT_GT(contact.normal.dot(contact.point.normalized()), 0.99);
    }
  }
}

TEST(PlanGrasp, WrenchBallIsThatOfItsContacts) {
  const GraspSearch search = planned(GraspType::kTripod, make_sphere(0.05, 400));
  ASSERT_TRUE(search.grasp.has_value());
  std::vector<WrenchContact> contacts;
  for (const PlannedContact& contact : search.grasp->contact)
    contacts.push_back({contact.point, -contact.normal});
  const ContactParameters standard;
  const auto wrenches =
      contact_wrenches(contacts, standard.friction, standard.spin_radius, Vec3::Zero(), 0.025);
  EXPECT_NEAR(search.grasp->wrench_ball, wrench_ball(wrenches), 4e-3) << "of an ideal ball of this size";
}

TEST(PlanGrasp, EqualArgumentsGiveEqualBitsAndSeedsDiffer) {
  const TriangleMesh ball = make_sphere(0.05, 400);
  const auto first = planned(GraspType::kTripod, ball).grasp;
  const auto again = planned(GraspType::kTripod, ball).grasp;
  const auto other = planned(GraspType::kTripod, ball, adult(), 2).grasp;
  ASSERT_TRUE(first && again && other);
  EXPECT_EQ(first->press, again->press);
  EXPECT_EQ(first->X_WH.p, again->X_WH.p);
  EXPECT_EQ(first->X_WH.R, again->X_WH.R);
  EXPECT_EQ(first->wrench_ball, again->wrench_ball);
  EXPECT_NE(first->X_WH.p, other->X_WH.p);
  expect_grasp(GraspType::kTripod, *other);
}

TEST(PlanGrasp, TheScenesMotionPressesWithEveryPlannedDigit) {
  const TriangleMesh ball = make_sphere(0.05, 400);
  const GraspSearch search = planned(GraspType::kTripod, ball);
  ASSERT_TRUE(search.grasp.has_value());
  const PlannedGrasp& grasp = *search.grasp;
  const HapticModel model(HandModel(adult().parameters(), adult().handedness(), grasp.X_WH, adult().meshes()),
                          ObjectModel(ball));
  const HapticParameters parameters;
  HapticState state(model, parameters);
  const JointArray& open = adult().parameters().open_angle;
  for (int i = 0; i <= 400; ++i) {
    Sample sample;
    sample.time_s = i * parameters.period();
    const double share = std::min(1.0, i / 300.0);
    for (std::size_t j = 0; j < open.size(); ++j)
      sample.angle[j] = open[j] + share * (grasp.press[j] - open[j]);
    step(model, parameters, sample, state);
  }
  for (const int digit : {0, 1, 2}) {
    double force = 0.0;
    for (int k = 0; k < kSegmentsPerDigit; ++k)
      force += state.snapshot().segment[idx(segment_index(digit, k))].force;
    EXPECT_GT(force, 0.1) << digit_name(digit);
  }
}

TEST(PlanGrasp, NamesTheConditionThatFails) {
  const GraspSearch large = planned(GraspType::kPinch, make_sphere(0.4, 1000));
  EXPECT_FALSE(large.grasp.has_value());
  EXPECT_EQ(large.obstacle(), GraspCondition::kReach);
  int failed = 0;
  for (const int count : large.failed) failed += count;
  EXPECT_EQ(failed, large.candidates);

  // Along its axis a cylinder is held by friction alone.
  HapticParameters slippery;
  slippery.contact.friction = 0.002;
  const GraspSearch smooth =
      plan_grasp(adult(), ObjectModel(make_cylinder(0.05, 0.3, 800)),
                 {.type = GraspType::kCylinder, .seed = 1, .parameters = slippery, .progress = {}});
  EXPECT_FALSE(smooth.grasp.has_value());
  EXPECT_EQ(smooth.obstacle(), GraspCondition::kClosure);
}

// A wrist that approaches from far away is there after a few steps, however large the object is.
TEST(PlanGrasp, EndsForAHugeObject) {
  const GraspSearch search = planned(GraspType::kSphere, make_sphere(900.0, 400));
  EXPECT_FALSE(search.grasp.has_value());
}

TEST(PlanGrasp, RefusesAnObjectWithoutTriangles) {
  EXPECT_THROW(static_cast<void>(plan_grasp(adult(), ObjectModel(), {})), std::invalid_argument);
}

TEST(PlanGrasp, EndsWhereProgressSaysSo) {
  int calls = 0;
  const GraspSearch search =
      plan_grasp(adult(), ObjectModel(make_sphere(0.05, 400)),
                 {.type = GraspType::kTripod, .seed = 1, .parameters = {}, .progress = [&](double) {
                    return ++calls < 3;
                  }});
  EXPECT_EQ(calls, 3);
  EXPECT_FALSE(search.grasp.has_value());
  EXPECT_LE(search.candidates, 200);
}

TEST(PlanGrasp, ProgressRisesToOne) {
  double last = -1.0;
  (void)plan_grasp(adult(), ObjectModel(make_sphere(0.05, 400)),
                   {.type = GraspType::kPinch, .seed = 1, .parameters = {}, .progress = [&](double done) {
                      EXPECT_GE(done, last);
                      last = done;
                      return true;
                    }});
  EXPECT_EQ(last, 1.0);
}

// The principal axes of a cube are any; its faces are where a hand holds it.
TEST(PlanGrasp, HoldsACubeFromAStatedSide) {
  for (const GraspType type : {GraspType::kDisk, GraspType::kCylinder}) {
    const GraspSearch search = plan_grasp(adult(), ObjectModel(make_box(Vec3::Constant(0.06), 1000)),
                                          {.type = type,
                                           .forearm = Vec3(0.0, -1.0, 0.3),
                                           .palm = Vec3(0.0, 0.0, -1.0),
                                           .parameters = {},
                                           .progress = {}});
    ASSERT_TRUE(search.grasp.has_value()) << grasp_rule(type).name;
    expect_grasp(type, *search.grasp);
    EXPECT_GE(search.grasp->X_WH.R(2, 1), std::cos(kDirectionCone) - 1e-12) << "the back of the hand is up";
    EXPECT_GE(search.grasp->X_WH.R.col(2).dot(Vec3(0.0, -1.0, 0.3).normalized()),
              std::cos(kDirectionCone) - 1e-12);
  }
}

/// Other hands: the shipped profiles, and a left hand. The stiff hand's ranges do not suffice for every type.
TEST(ManyGrasps, OfOtherHandsFulfilTheirConditionsToo) {
  for (const std::string profile : {"stiff-hand", "small-woman", "large-man"}) {
    if (test::kSlowBuild && profile != "stiff-hand") return;
    SCOPED_TRACE(profile);
    const HapticModel model = build_model(load_scene("wave", {{"hand.profile", "\"" + profile + "\""}}));
    for (const auto& [type, mesh] : cases()) {
      const GraspSearch search = planned(type, mesh, model.hand);
      EXPECT_TRUE(search.grasp.has_value() || profile == "stiff-hand")
          << grasp_rule(type).name << ": " << grasp_condition_text(search.obstacle());
      if (search.grasp) expect_grasp(type, *search.grasp, model.hand);
    }
  }
  const HapticModel left = build_model(load_scene("wave", {{"hand.side", "\"left\""}}));
  for (const auto& [type, mesh] : cases()) {
    const GraspSearch search = planned(type, mesh, left.hand);
    EXPECT_TRUE(search.grasp.has_value()) << "left, " << grasp_rule(type).name;
    if (search.grasp) expect_grasp(type, *search.grasp, left.hand);
  }
}

}  // namespace
}  // namespace phalanx
