// SPDX-License-Identifier: Apache-2.0
#include "phalanx/hand/hand_model.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <string>

#include "phalanx/hand/fit.h"
#include "support/simple_hand.h"

namespace phalanx {
namespace {

using test::at;
using test::simple_hand;
using test::simple_parameters;

JointArray random_angles(std::mt19937_64& random) {
  std::uniform_real_distribution<double> u(-0.5, 1.8);
  JointArray q{};
  for (double& angle : q) angle = u(random);
  return q;
}

// docs/link.md: four joints and three segments a digit, from the thumb on; then the palm.
TEST(JointNames, EachIsFoundWhereItStands) {
  EXPECT_EQ(find_joint("thumb_cmc_flexion"), 0);
  EXPECT_EQ(find_joint("index_mcp_flexion"), 4);
  EXPECT_EQ(find_joint("middle_mcp_abduction"), 9);
  EXPECT_EQ(find_joint("little_dip_flexion"), 19);
  EXPECT_EQ(find_segment("thumb-metacarpal"), 0);
  EXPECT_EQ(find_segment("middle-finger-phalanx-distal"), 8);
  EXPECT_EQ(find_segment("wrist"), 15);
  for (int joint = 0; joint < kJoints; ++joint) EXPECT_EQ(find_joint(joint_name(joint)), joint);
  for (int segment = 0; segment < kSegments; ++segment)
    EXPECT_EQ(find_segment(segment_name(segment)), segment);
  for (const char* name : {"", "thumb", "thumb_cmc_flexio", "thumb_cmc_flexion ", "little"}) {
    EXPECT_EQ(find_joint(name), std::nullopt) << name;
    EXPECT_EQ(find_segment(name), std::nullopt) << name;
  }
}

HandModel coupled_hand(Handedness side = Handedness::kRight, const Pose& X_WH = {}) {
  return make_hand_model(test::coupled(simple_parameters()), side, X_WH, 800);
}

Pose somewhere(std::mt19937_64& random) {
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  return Pose{rotation_about(Vec3(u(random), u(random), u(random)).normalized(), 3.0 * u(random)),
              Vec3(u(random), u(random), u(random))};
}

/// Independent kinematics: a digit as a product of homogeneous 4x4 transforms written from the hand's
/// description (hinges about -X for flexion and +Y for abduction in the segment's own WebXR frame), without
/// any D-H table.
Eigen::Matrix4d rotate(const Vec3& axis, double angle) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  Mat3 K;
  K << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  T.topLeftCorner<3, 3>() += std::sin(angle) * K + (1.0 - std::cos(angle)) * K * K;  // Rodrigues
  return T;
}
Eigen::Matrix4d translate(const Vec3& v) {
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  T.topRightCorner<3, 1>() = v;
  return T;
}
std::array<Eigen::Matrix4d, 3> homogeneous_chain(const DigitParameters& digit, const DigitAngles& q) {
  const Vec3 z = -digit.distal.normalized();
  const Vec3 x = digit.dorsal.cross(z).normalized();
  const DigitCoupling& coupling = digit.coupling;
  Eigen::Matrix4d T = translate(digit.base);
  T.col(0).head<3>() = x;
  T.col(1).head<3>() = z.cross(x);
  T.col(2).head<3>() = z;
  T = translate(digit.metacarpal_base) *
      rotate(digit.metacarpal_axis.normalized(), coupling.metacarpal_per_flexion * q[0]) *
      translate(-digit.metacarpal_base) * T;
  T = T * rotate(-Vec3::UnitX(), q[0]) * rotate(Vec3::UnitY(), q[1]);
  T = T *
      rotate(Vec3::UnitZ(), coupling.pronation_per_flexion * q[0] + coupling.pronation_per_abduction * q[1]);
  std::array<Eigen::Matrix4d, 3> out;
  out[0] = T;
  T = T * translate(Vec3(0, 0, -digit.dh[1].a)) * rotate(-Vec3::UnitX(), q[2]);
  out[1] = T;
  T = T * translate(Vec3(0, 0, -digit.dh[2].a)) * rotate(-Vec3::UnitX(), q[3]);
  out[2] = T;
  return out;
}

TEST(HandModel, ForwardKinematicsEqualTheProductOfHomogeneousTransforms) {
  std::mt19937_64 random(1);
  for (int n = 0; n < 200; ++n) {
    const Pose X_WH = somewhere(random);
    const HandModel hand =
        n % 2 == 0 ? simple_hand(Handedness::kRight, X_WH, 800) : coupled_hand(Handedness::kRight, X_WH);
    const JointArray q = random_angles(random);
    HandPoses poses;
    hand.poses(q, poses);
    Eigen::Matrix4d W = translate(X_WH.p);
    W.topLeftCorner<3, 3>() = X_WH.R;
    for (int d = 0; d < kDigits; ++d) {
      const auto expected =
          homogeneous_chain(hand.parameters().digits[static_cast<std::size_t>(d)], digit_angles(q, d));
      for (std::size_t k = 0; k < 3; ++k) {
        const Eigen::Matrix4d T = W * expected[k];
        const Pose& X = poses.digit[static_cast<std::size_t>(d)].segment[k];
        EXPECT_LT((T.topLeftCorner<3, 3>() - X.R).norm(), 1e-13) << "seed 1 case " << n;
        EXPECT_LT((T.topRightCorner<3, 1>() - X.p).norm(), 1e-13) << "seed 1 case " << n;
      }
    }
  }
}

TEST(HandModel, AFlexedFingerIsWhereTrigonometryPutsIt) {
  const HandModel hand = simple_hand();
  HandPoses poses;
  hand.poses(test::index_angles(0.5, 0.4, 0.3), poses);
  const auto& index = poses.digit[test::kIndex].segment;
  const Vec3 pip(0.0, -0.040 * std::sin(0.5), -0.040 * std::cos(0.5));
  const Vec3 dip = pip + Vec3(0.0, -0.025 * std::sin(0.9), -0.025 * std::cos(0.9));
  EXPECT_LT((index[1].p - pip).norm(), 1e-15);
  EXPECT_LT((index[2].p - dip).norm(), 1e-15);
  EXPECT_LT(
      (index[2] * Vec3(0, 0, -0.02) - dip - Vec3(0.0, -0.02 * std::sin(1.2), -0.02 * std::cos(1.2))).norm(),
      1e-15);
}

TEST(HandModel, JacobiansEqualFiniteDifferences) {
  std::mt19937_64 random(2);
  const Pose X_WH = somewhere(random);
  const HandModel plain = simple_hand(Handedness::kLeft, X_WH, 800);
  const HandModel with_coupling = coupled_hand(Handedness::kLeft, X_WH);
  for (int n = 0; n < 50; ++n) {
    const HandModel& hand = n % 2 == 0 ? plain : with_coupling;
    const JointArray q = random_angles(random);
    const Vec3 p_S(0.003, -0.004, -0.01);
    for (int d = 0; d < kDigits; ++d) {
      DigitPose pose;
      hand.digit_pose(d, digit_angles(q, d), pose);
      for (int k = 0; k < kSegmentsPerDigit; ++k) {
        const PointJacobian J = point_jacobian(pose, k, pose.segment[static_cast<std::size_t>(k)] * p_S);
        for (std::size_t i = 0; i < kJointsPerDigit; ++i) {
          constexpr double h = 1e-6;
          DigitAngles up = digit_angles(q, d);
          DigitAngles down = up;
          up[i] += h;
          down[i] -= h;
          DigitPose a;
          DigitPose b;
          hand.digit_pose(d, up, a);
          hand.digit_pose(d, down, b);
          const Pose& Xa = a.segment[static_cast<std::size_t>(k)];
          const Pose& Xb = b.segment[static_cast<std::size_t>(k)];
          EXPECT_LT(((Xa * p_S - Xb * p_S) / (2.0 * h) - J.linear[i]).norm(), 1e-9);
          const Mat3 spin =
              (Xa.R - Xb.R) / (2.0 * h) * pose.segment[static_cast<std::size_t>(k)].R.transpose();
          EXPECT_LT((Vec3(spin(2, 1), spin(0, 2), spin(1, 0)) - J.angular[i]).norm(), 1e-8);
        }
      }
    }
  }
}

void expect_mirrored(const HandModel& right, const HandModel& left) {
  std::mt19937_64 random(3);
  const Vec3 mirror(-1.0, 1.0, 1.0);
  for (int n = 0; n < 50; ++n) {
    const JointArray q = random_angles(random);
    HandPoses r;
    HandPoses l;
    right.poses(q, r);
    left.poses(q, l);
    for (int s = 0; s < kSegments; ++s) {
      const bool palm = s == kPalm;
      const std::size_t d = static_cast<std::size_t>(palm ? 0 : digit_of_segment(s));
      const std::size_t k = static_cast<std::size_t>(s % kSegmentsPerDigit);
      const Pose X_r = palm ? right.palm_pose() : r.digit[d].segment[k];
      const Pose X_l = palm ? left.palm_pose() : l.digit[d].segment[k];
      for (std::size_t v = 0; v < right.mesh(s).vertices.size(); ++v) {
        const Vec3 expected = mirror.cwiseProduct(X_r * right.mesh(s).vertices[v]);
        EXPECT_EQ(expected, X_l * left.mesh(s).vertices[v]);  // to the last bit
      }
    }
  }
  for (int s = 0; s < kSegments; ++s) EXPECT_GT(signed_volume(left.mesh(s)), 0.0) << segment_name(s);
}

TEST(HandModel, ALeftHandMirrorsARightHandExactly) {
  expect_mirrored(simple_hand(Handedness::kRight), simple_hand(Handedness::kLeft));
}

TEST(HandModel, ALeftHandMirrorsARightHandExactlyWithCouplingToo) {
  expect_mirrored(coupled_hand(Handedness::kRight), coupled_hand(Handedness::kLeft));
}

// By hand: q = 0.4 flexes, 0.1 abducts. The metacarpal turns by 0.25 x 0.4, pronation is 0.35 x 0.4 - 0.2 x 0.1.
TEST(DigitCoupling, TurnsTheCoupledAxesInProportion) {
  const DigitCoupling coupling = test::coupled(simple_parameters()).digits[0].coupling;
  const AxisAngles expected{0.1, 0.4, 0.1, 0.12, 0.7, 0.6};
  const AxisAngles found = axis_angles(coupling, {0.4, 0.1, 0.7, 0.6});
  for (std::size_t a = 0; a < kAxesPerDigit; ++a) EXPECT_NEAR(found[a], expected[a], 1e-15) << a;
  const AxisAngles plain = axis_angles({}, {0.4, 0.1, 0.7, 0.6});
  EXPECT_EQ(plain, (AxisAngles{0.0, 0.4, 0.1, 0.0, 0.7, 0.6}));
}

// A straight digit along -Z that flexes by a quarter turn, and pronates by another: it points to -Y, and its
// back, which would look along -Z, has turned about the bone: to -X of a right hand, the thumb's side.
TEST(DigitCoupling, PronationTurnsTheBackOfARightHandsThumbAwayFromTheFingers) {
  HandParameters parameters = simple_parameters();
  parameters.digits[0].coupling.pronation_per_flexion = 1.0;
  const HandModel hand = make_hand_model(parameters, Handedness::kRight, {}, 800);
  DigitPose pose;
  constexpr double kQuarter = 1.5707963267948966;
  hand.digit_pose(0, {kQuarter, 0.0, 0.0, 0.0}, pose);
  EXPECT_LT((-pose.segment[0].R.col(2) + Vec3::UnitY()).norm(), 1e-15);
  EXPECT_LT((pose.segment[0].R.col(1) + Vec3::UnitX()).norm(), 1e-15);
}

// The metacarpal turns by half of the flexion about an axis 100 mm before the knuckle. At a flexion of 90
// degrees the knuckle is 45 degrees round, and the finger points 135 degrees round, down and back.
TEST(DigitCoupling, TheMetacarpalCarriesTheDigit) {
  HandParameters parameters = simple_parameters();
  DigitParameters& digit = parameters.digits[test::kIndex];
  digit.coupling.metacarpal_per_flexion = 0.5;
  digit.metacarpal_base = Vec3(0.0, 0.0, 0.1);
  const HandModel hand = make_hand_model(parameters, Handedness::kRight, {}, 800);
  DigitPose pose;
  constexpr double kQuarter = 1.5707963267948966;
  hand.digit_pose(test::kIndex, {kQuarter, 0.0, 0.0, 0.0}, pose);
  const double c = std::sqrt(0.5);
  EXPECT_LT((pose.segment[0].p - Vec3(0.0, -0.1 * c, 0.1 - 0.1 * c)).norm(), 1e-15);
  EXPECT_LT((-pose.segment[0].R.col(2) - Vec3(0.0, -c, c)).norm(), 1e-15);
}

// The torques of a force are its virtual work for a small turn of each joint, also through coupled axes.
TEST(DigitCoupling, TorquesAreTheVirtualWorkByFiniteDifferences) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (const Handedness side : {Handedness::kRight, Handedness::kLeft}) {
    const HandModel hand = coupled_hand(side, somewhere(random));
    for (int n = 0; n < 100; ++n) {
      const JointArray q = random_angles(random);
      const int d = n % kDigits;
      const int k = n / kDigits % kSegmentsPerDigit;
      const Vec3 p_S(0.01 * u(random), 0.01 * u(random), -0.02);
      const Vec3 force(u(random), u(random), u(random));
      DigitPose pose;
      hand.digit_pose(d, digit_angles(q, d), pose);
      JointArray torque{};
      add_torques(pose, d, k, pose.segment[static_cast<std::size_t>(k)] * p_S, force, torque);
      for (int i = 0; i < kJointsPerDigit; ++i) {
        constexpr double h = 1e-5;
        const auto work = [&](double turn) {
          DigitAngles at = digit_angles(q, d);
          at[static_cast<std::size_t>(i)] += turn;
          DigitPose there;
          hand.digit_pose(d, at, there);
          return force.dot(there.segment[static_cast<std::size_t>(k)] * p_S);
        };
        EXPECT_NEAR(torque[static_cast<std::size_t>(joint_index(d, i))], (work(h) - work(-h)) / (2.0 * h),
                    1e-9)
            << "seed 7 case " << n << " joint " << i;
      }
    }
  }
}

TEST(DigitCoupling, ACoupleIsTwoOppositeForces) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> u(-1.0, 1.0);
  for (const Handedness side : {Handedness::kRight, Handedness::kLeft}) {
    const HandModel hand = coupled_hand(side, somewhere(random));
    for (int n = 0; n < 30; ++n) {
      const JointArray q = random_angles(random);
      const int d = n % kDigits;
      const int k = n / kDigits % kSegmentsPerDigit;
      const Vec3 at(u(random), u(random), u(random));
      const Vec3 arm(u(random), u(random), u(random));
      const Vec3 force(u(random), u(random), u(random));
      DigitPose pose;
      hand.digit_pose(d, digit_angles(q, d), pose);
      JointArray by_forces{};
      add_torques(pose, d, k, at + arm, force, by_forces);
      add_torques(pose, d, k, at, -force, by_forces);
      JointArray by_couple{};
      add_couple(pose, d, k, arm.cross(force), by_couple);
      for (std::size_t j = 0; j < kJoints; ++j)
        EXPECT_NEAR(by_couple[j], by_forces[j], 1e-14) << "seed 8 case " << n << " joint " << j;
    }
  }
}

TEST(DigitCoupling, IsRefusedIfItIsNotFiniteOrHasNoAxis) {
  const auto refused = [](const auto& change, const char* words) {
    HandParameters parameters = test::coupled(simple_parameters());
    change(parameters.digits[test::kIndex]);
    try {
      (void)make_hand_model(parameters, Handedness::kRight, {}, 800);
      ADD_FAILURE() << "accepted: " << words;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), ::testing::AllOf(::testing::HasSubstr("index"), ::testing::HasSubstr(words)));
    }
  };
  const double nan = std::nan("");
  refused([&](DigitParameters& d) { d.coupling.pronation_per_flexion = nan; }, "ratio nan");
  refused([&](DigitParameters& d) { d.coupling.pronation_per_abduction = -1.5; }, "ratio -1.5");
  refused([&](DigitParameters& d) { d.coupling.metacarpal_per_flexion = 1.01; }, "ratio 1.01");
  refused([&](DigitParameters& d) { d.metacarpal_base.y() = nan; }, "not finite");
  refused([&](DigitParameters& d) { d.metacarpal_axis.z() = nan; }, "axis");
  refused([](DigitParameters& d) { d.metacarpal_axis.z() = 1e200; }, "axis");
  refused([](DigitParameters& d) { d.metacarpal_axis = Vec3::Zero(); }, "axis");
}

TEST(HandModel, OfEitherSideMovesWithItsPoseInTheWorld) {
  std::mt19937_64 random(5);
  for (const Handedness side : {Handedness::kRight, Handedness::kLeft}) {
    const Pose X_WH = somewhere(random);
    const HandModel here = coupled_hand(side);
    const HandModel there = coupled_hand(side, X_WH);
    const JointArray q = random_angles(random);
    for (int d = 0; d < kDigits; ++d) {
      DigitPose a;
      DigitPose b;
      here.digit_pose(d, digit_angles(q, d), a);
      there.digit_pose(d, digit_angles(q, d), b);
      for (std::size_t k = 0; k < kSegmentsPerDigit; ++k) {
        EXPECT_LT((X_WH.R * a.segment[k].R - b.segment[k].R).norm(), 1e-13) << "seed 5";
        EXPECT_LT((X_WH * a.segment[k].p - b.segment[k].p).norm(), 1e-13) << "seed 5";
        EXPECT_NEAR(b.segment[k].R.determinant(), 1.0, 1e-13) << "seed 5: not a reflection";
      }
      for (std::size_t i = 0; i < kAxesPerDigit; ++i) {
        EXPECT_LT((X_WH.R * a.axis[i].axis - b.axis[i].axis).norm(), 1e-13) << "seed 5";
        EXPECT_LT((X_WH * a.axis[i].centre - b.axis[i].centre).norm(), 1e-13) << "seed 5";
      }
    }
  }
}

double distance(const Vec3& p, const JointAxis& axis) { return axis.axis.cross(p - axis.centre).norm(); }

TEST(HandModel, ReachBoundsEveryPointOfTheSegmentAtEveryAngle) {
  std::mt19937_64 random(4);
  const HandModel hand = coupled_hand();
  for (int n = 0; n < 100; ++n) {
    const JointArray q = random_angles(random);
    for (int d = 0; d < kDigits; ++d) {
      DigitPose pose;
      hand.digit_pose(d, digit_angles(q, d), pose);
      for (int k = 0; k < kSegmentsPerDigit; ++k) {
        for (int i = 0; i < axes_that_move(k); ++i) {
          for (const Vec3& v : hand.mesh(segment_index(d, k)).vertices) {
            const double r = distance(pose.segment[static_cast<std::size_t>(k)] * v,
                                      pose.axis[static_cast<std::size_t>(i)]);
            ASSERT_LE(r, hand.reach(d, i, k) + 1e-15) << "axis " << i << " segment " << k;
          }
        }
      }
    }
  }
}

TEST(HandModel, ReachHoldsForLinkOffsetsToo) {
  std::mt19937_64 random(6);
  std::uniform_real_distribution<double> u(-0.05, 0.08);
  for (int n = 0; n < 20; ++n) {
    HandParameters parameters = simple_parameters();
    for (DhRow& row : parameters.digits[1].dh) {
      row.d = u(random);
      row.a += 0.2 * std::abs(u(random));
      row.theta = u(random);
    }
    const HandModel hand = make_hand_model(test::coupled(parameters), Handedness::kRight, {}, 800);
    DigitPose pose;
    hand.digit_pose(1, digit_angles(random_angles(random), 1), pose);
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      for (int i = 0; i < axes_that_move(k); ++i) {
        for (const Vec3& v : hand.mesh(segment_index(1, k)).vertices) {
          const Vec3 p = pose.segment[static_cast<std::size_t>(k)] * v;
          ASSERT_LE(distance(p, pose.axis[static_cast<std::size_t>(i)]), hand.reach(1, i, k) + 1e-15)
              << "seed 6 case " << n;
        }
      }
    }
  }
}

// Straight, by hand: the mesh's farthest point is the tip's pole, 20 + 5, 25 + 6 and 40 + 7 mm from the
// segment's joint; then the bones before it. Offsets of 3 mm and of 7 mm beside 24 mm: sqrt(24^2 + 7^2) = 25.
TEST(HandModel, ReachIsNoFartherThanTheStraightDigit) {
  HandParameters parameters = simple_parameters();
  const HandModel hand = make_hand_model(parameters, Handedness::kRight, {}, 800);
  const auto expect = [](const HandModel& of, int joint, int k, double reach) {
    EXPECT_NEAR(of.reach(test::kIndex, axis_of_joint(joint), k), reach, 1e-12) << joint << " " << k;
  };
  expect(hand, 3, 2, 0.025);
  expect(hand, 2, 2, 0.050);
  expect(hand, 1, 2, 0.090);
  expect(hand, 0, 2, 0.090);
  expect(hand, 2, 1, 0.031);
  expect(hand, 0, 1, 0.071);
  expect(hand, 0, 0, 0.047);
  parameters.digits[test::kIndex].dh[2].a = 0.024;
  parameters.digits[test::kIndex].dh[2].d = 0.007;
  parameters.digits[test::kIndex].dh[3].d = -0.003;
  const HandModel offset = make_hand_model(parameters, Handedness::kRight, {}, 800);
  expect(offset, 3, 2, 0.028);
  expect(offset, 2, 2, 0.053);
  expect(offset, 0, 2, 0.093);
  expect(offset, 2, 1, 0.038);
}

// Pronation turns the first segment about its bone, 8 mm round at its base, and the others about a line through
// their first joint. The metacarpal's axis is 30 mm before the knuckle and 40 mm below it: 50 mm farther away.
TEST(HandModel, ReachOfTheCoupledAxesByHand) {
  HandParameters parameters = simple_parameters();
  parameters.digits[test::kIndex].metacarpal_base =
      parameters.digits[test::kIndex].base + Vec3(0.0, -0.040, 0.030);
  const HandModel hand = make_hand_model(parameters, Handedness::kRight, {}, 800);
  EXPECT_NEAR(hand.reach(test::kIndex, kPronationAxis, 0), 0.008, 5e-6) << "the widest ring's distance";
  EXPECT_NEAR(hand.reach(test::kIndex, kPronationAxis, 1), 0.031, 1e-12);
  EXPECT_NEAR(hand.reach(test::kIndex, kPronationAxis, 2), 0.050, 1e-12);
  EXPECT_NEAR(hand.reach(test::kIndex, kMetacarpalAxis, 0), 0.047 + 0.050, 1e-12);
  EXPECT_NEAR(hand.reach(test::kIndex, kMetacarpalAxis, 2), 0.090 + 0.050, 1e-12);
}

TEST(HandModel, RefusesAPoseThatIsNotRigid) {
  Pose nan;
  nan.p.x() = std::nan("");
  EXPECT_THROW((void)simple_hand(Handedness::kRight, nan), std::invalid_argument);
  Pose scaled;
  scaled.R *= 2.0;
  EXPECT_THROW((void)simple_hand(Handedness::kRight, scaled), std::invalid_argument);
  Pose reflected;
  reflected.R = Vec3(-1.0, 1.0, 1.0).asDiagonal();
  EXPECT_THROW((void)simple_hand(Handedness::kRight, reflected), std::invalid_argument);
}

TEST(HandModel, EverySegmentIsOneClosedMeshAndTheCountIsNearWhatWasAsked) {
  for (const int asked : {800, 2250, 20000}) {
    const HandModel hand = simple_hand(Handedness::kRight, {}, asked);
    EXPECT_NEAR(hand.triangle_count(), asked, 0.1 * asked);
    for (int s = 0; s < kSegments; ++s) {
      EXPECT_TRUE(is_closed(hand.mesh(s))) << segment_name(s);
      EXPECT_GT(signed_volume(hand.mesh(s)), 0.0) << segment_name(s);
    }
  }
}

// Of 2250 triangles a sixteenth is 140: 10 sides to 7 rings, 2 x 10 x 7. The palm takes the 150 that are
// left: 2 x 11 x 7 = 154 is nearest to that. Of 800 each capsule takes the fewest, 6 sides to 4 rings, and
// the palm the 80 that are left, 10 sides to 4 rings.
TEST(CapsuleMeshes, HaveAboutTenSidesToSevenRingsAndThePalmTakesWhatIsLeft) {
  struct Expected {
    int asked, triangles, sides, palm_triangles, palm_sides;
  };
  for (const Expected& expected : {Expected{2250, 140, 10, 154, 11}, Expected{800, 48, 6, 80, 10}}) {
    const SegmentMeshes meshes = make_capsule_meshes(simple_parameters(), Handedness::kRight, expected.asked);
    for (std::size_t s = 0; s < kSegments; ++s) {
      const TriangleMesh& mesh = meshes[s];
      const auto tip = std::min_element(mesh.vertices.begin(), mesh.vertices.end(),
                                        [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
      const auto pole = tip - mesh.vertices.begin();
      const auto sides = std::count_if(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        return t[0] == pole || t[1] == pole || t[2] == pole;
      });
      EXPECT_EQ(static_cast<int>(mesh.triangles.size()),
                s == kPalm ? expected.palm_triangles : expected.triangles)
          << expected.asked << " " << s;
      EXPECT_EQ(sides, s == kPalm ? expected.palm_sides : expected.sides) << expected.asked << " " << s;
    }
  }
}

TEST(CapsuleMeshes, AreOfEightHundredToTwoMillionTriangles) {
  for (const int asked : {799, 2'000'001}) {
    EXPECT_THAT([&] { (void)make_capsule_meshes(simple_parameters(), Handedness::kRight, asked); },
                ::testing::ThrowsMessage<std::invalid_argument>(
                    ::testing::HasSubstr(std::to_string(asked) + " triangles asked for")));
  }
}

// Each number of a digit by itself, and directions that leave no axis to flex about.
TEST(HandModel, RefusesADigitThatIsNotFiniteOrHasNoFlexionAxis) {
  using Number = double& (*)(DigitParameters&);
  const Number numbers[] = {
      [](DigitParameters& d) -> double& { return d.base.x(); },
      [](DigitParameters& d) -> double& { return d.distal.y(); },
      [](DigitParameters& d) -> double& { return d.dorsal.z(); },
      [](DigitParameters& d) -> double& { return d.dh[0].a; },
      [](DigitParameters& d) -> double& { return d.dh[1].alpha; },
      [](DigitParameters& d) -> double& { return d.dh[2].d; },
      [](DigitParameters& d) -> double& { return d.dh[3].theta; },
  };
  const auto expect_refused = [](const HandParameters& hand) {
    EXPECT_THAT([&] { (void)make_hand_model(hand, Handedness::kRight, {}, 800); },
                ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("digit ring has")));
  };
  for (const Number number : numbers) {
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
      HandParameters hand = simple_parameters();
      number(hand.digits[3]) = bad;
      expect_refused(hand);
    }
  }
  HandParameters hand = simple_parameters();
  hand.digits[3].dorsal = Vec3(0.0, 0.0, 2.0);
  expect_refused(hand);
}

TEST(HandModel, RefusesAMeshWithoutATriangle) {
  for (const int s : {0, 7, kPalm}) {
    SegmentMeshes meshes = make_capsule_meshes(simple_parameters(), Handedness::kRight, 800);
    meshes[static_cast<std::size_t>(s)].triangles.clear();
    EXPECT_THAT([&] { (void)HandModel(simple_parameters(), Handedness::kRight, {}, meshes); },
                ::testing::ThrowsMessage<std::invalid_argument>(
                    ::testing::HasSubstr("segment " + std::string(segment_name(s)))));
  }
}

TEST(HandModel, RefusesARangeOfMotionWithoutAnEnd) {
  HandParameters downwards = simple_parameters();
  downwards.min_angle[5] = -std::numeric_limits<double>::infinity();
  HandParameters upwards = simple_parameters();
  upwards.max_angle[5] = std::numeric_limits<double>::infinity();
  for (const HandParameters& bad : {downwards, upwards}) {
    EXPECT_THAT([&] { (void)make_hand_model(bad, Handedness::kRight, {}, 800); },
                ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("index_mcp_abduction")));
  }
}

TEST(HandModel, RefusesAnEmptyRangeOfMotion) {
  HandParameters bad = simple_parameters();
  bad.max_angle[5] = bad.min_angle[5];
  EXPECT_THAT([&] { (void)make_hand_model(bad, Handedness::kRight, {}, 2250); },
              ::testing::ThrowsMessage<std::invalid_argument>(::testing::HasSubstr("index_mcp_abduction")));
}

TEST(HandModel, RefusesAHandThatIsOpenOutsideItsRangeOfMotion) {
  const HandParameters good = simple_parameters();
  for (const double open : {good.min_angle[5] - 1e-3, good.max_angle[5] + 1e-3}) {
    HandParameters bad = good;
    bad.open_angle[5] = open;
    EXPECT_THAT([&] { (void)make_hand_model(bad, Handedness::kRight, {}, 2250); },
                ::testing::ThrowsMessage<std::invalid_argument>(::testing::AllOf(
                    ::testing::HasSubstr("index_mcp_abduction"), ::testing::HasSubstr("open outside"))));
  }
  HandParameters at_its_end = good;
  at_its_end.open_angle[5] = good.max_angle[5];
  EXPECT_NO_THROW((void)make_hand_model(at_its_end, Handedness::kRight, {}, 2250));
}

TEST(Joints, NamesAndNumbersAgree) {
  EXPECT_EQ(joint_name(joint_index(1, 0)), "index_mcp_flexion");
  EXPECT_EQ(joint_name(joint_index(0, 1)), "thumb_cmc_abduction");
  EXPECT_EQ(joint_name(19), "little_dip_flexion");
  EXPECT_EQ(segment_name(segment_index(1, 0)), "index-finger-phalanx-proximal");
  EXPECT_EQ(segment_name(kPalm), "wrist");
  for (int j = 0; j < kJoints; ++j) EXPECT_EQ(find_joint(joint_name(j)), j);
  for (int s = 0; s < kSegments; ++s) EXPECT_EQ(find_segment(segment_name(s)), s);
  EXPECT_FALSE(find_joint("index_mcp").has_value());
  for (int s = 0; s < kPalm; ++s) EXPECT_EQ(digit_of_segment(s), s / 3) << s;
  EXPECT_EQ(digit_of_segment(kPalm), -1);
}

// Before a file states anything: no length, breadth or angle, and digits that point away from the wrist.
TEST(HandParameters, AreZeroUntilStated) {
  const HandParameters hand{};
  for (const DigitParameters& digit : hand.digits) {
    EXPECT_EQ(digit.base, Vec3(0, 0, 0));
    EXPECT_EQ(digit.distal, Vec3(0, 0, -1));
    EXPECT_EQ(digit.dorsal, Vec3(0, 1, 0));
    for (const DhRow& row : digit.dh)
      for (const double number : {row.a, row.alpha, row.d, row.theta}) EXPECT_EQ(number, 0.0);
  }
  for (const SegmentShape& shape : hand.segments)
    for (const double number : {shape.length, shape.radius_base, shape.radius_tip}) EXPECT_EQ(number, 0.0);
  const PalmShape& palm = hand.palm;
  for (const double number :
       {palm.length, palm.wrist_breadth, palm.wrist_thickness, palm.knuckle_breadth, palm.knuckle_thickness})
    EXPECT_EQ(number, 0.0);
  EXPECT_EQ(palm.offset, Vec3(0, 0, 0));
  for (const JointArray& angles : {hand.min_angle, hand.max_angle, hand.open_angle})
    for (const double angle : angles) EXPECT_EQ(angle, 0.0);
}

// Knuckles 90 mm before the wrist and 20 mm apart; bones of 40, 25 and 20 mm, and a tip of 5 mm.
TEST(StraightHand, IsThatOfItsDescription) {
  const HandModel hand = make_hand_model(straight_hand(), Handedness::kRight, {}, 2000);
  EXPECT_NEAR(hand_length(hand.parameters()), 0.18, 1e-12);
  HandPoses poses;
  hand.poses({}, poses);
  for (std::size_t d = 0; d < kDigits; ++d) {
    const double x = 0.02 * (static_cast<double>(d) - 2.0);
    EXPECT_LT((poses.digit[d].segment[0].p - Vec3(x, 0.0, -0.09)).norm(), 1e-12) << d;
    EXPECT_LT((poses.digit[d].segment[2].p - Vec3(x, 0.0, -0.155)).norm(), 1e-12) << d;
  }
}

}  // namespace
}  // namespace phalanx
