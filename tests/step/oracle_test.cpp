// SPDX-License-Identifier: Apache-2.0
// Whatever the hand does, what is shown never penetrates: the project's own scenes, whole motions and seeded
// poses, against FCL.
#include <gmock/gmock.h>

#include <array>
#include <cstdio>
#include <random>
#include <string>
#include <tuple>

#include "phalanx/core/constants.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"
#include "support/reference/fcl_oracle.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

/// How far below the margin a stopped segment may be.
constexpr double kOracleTolerance = 10e-9;

/// Scene and contact mode.
using OracleCase = std::tuple<const char*, ContactMode>;

std::string case_name(const ::testing::TestParamInfo<OracleCase>& info) {
  return std::string(std::get<0>(info.param)) +
         (std::get<1>(info.param) == ContactMode::kSliding ? "_sliding" : "_static");
}

class OracleOnScene : public ::testing::TestWithParam<OracleCase> {
 protected:
  OracleOnScene() {
    scene_.parameters.contact.mode = std::get<1>(GetParam());
    for (int s = 0; s < kSegments; ++s) segment_.emplace_back(model_.hand.mesh(s));
  }

  void expect_clear(const Snapshot& snapshot, bool distances) {
    for (std::size_t s = 0; s < kSegments; ++s) {
      if (test::kSlowBuild && snapshot.tick % 4 != 0) continue;
      ASSERT_FALSE(segment_[s].collides(snapshot.gdp_pose[s], object_))
          << segment_name(static_cast<int>(s)) << " at tick " << snapshot.tick;
      if (!distances || test::kSlowBuild) continue;
      ASSERT_GE(segment_[s].distance(snapshot.gdp_pose[s], object_),
                scene_.parameters.contact.margin - kOracleTolerance)
          << segment_name(static_cast<int>(s)) << " at tick " << snapshot.tick;
    }
    // A digit is where it is measured unless something touches it, or in sliding mode its search has run out or it goes
    // round the object, which takes half a second at most.
    const bool exhausted =
        std::get<1>(GetParam()) == ContactMode::kSliding && has(snapshot.status, Status::kSearchExhausted);
    ++ticks_;
    exhausted_ += exhausted ? 1 : 0;
    for (int d = 0; d < kDigits; ++d) {
      bool record = false;
      for (int k = 0; k < kSegmentsPerDigit; ++k) {
        record = record || snapshot.segment[static_cast<std::size_t>(segment_index(d, k))].contact;
      }
      const bool there = digit_angles(snapshot.gdp_angle, d) == digit_angles(snapshot.hcp_angle, d);
      double& away = away_[static_cast<std::size_t>(d)];
      away = record || exhausted || there ? 0.0 : away + scene_.parameters.period();
      ASSERT_LE(away, std::get<1>(GetParam()) == ContactMode::kSliding
                          ? 0.5 + 2.0 * scene_.parameters.period()
                          : 0.0)
          << digit_name(d) << " at tick " << snapshot.tick;
      contacts_ += record ? 1 : 0;
    }
  }

  /// Poses follow each other without regard for what a hand can do; every fifth time back to the open hand,
  /// so that fingers come free.
  void expect_clear_at_seeded_poses(std::uint64_t seed, int poses) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    scene_.parameters.limits.joint_speed = kInfinity;
    away_ = {};
    HapticState state(model_, scene_.parameters);
    const HandParameters& hand = model_.hand.parameters();
    double time = 0.0;
    for (int n = 0; n < poses; ++n) {
      Sample sample{time += scene_.parameters.period(), {}};
      const double reach = n % 5 == 4 ? 0.0 : u(random);
      for (std::size_t j = 0; j < kJoints; ++j) {
        const double target = hand.min_angle[j] + u(random) * (hand.max_angle[j] - hand.min_angle[j]);
        sample.angle[j] = hand.open_angle[j] + reach * (target - hand.open_angle[j]);
      }
      step(model_, scene_.parameters, sample, state);
      ASSERT_NO_FATAL_FAILURE(expect_clear(state.snapshot(), n % 10 == 0));
    }
    EXPECT_LE(exhausted_, 10 + ticks_ / 200) << "of " << ticks_ << " ticks";
  }

  /// Each digit goes from one seeded posture to the next, every third of them open, in a time of its own.
  void expect_clear_over_seeded_motion(std::uint64_t seed, int ticks) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> u(0.0, 1.0);
    const HandParameters& hand = model_.hand.parameters();
    scene_.parameters.limits.joint_speed = kInfinity;
    away_ = {};
    HapticState state(model_, scene_.parameters);
    JointArray from = hand.open_angle;
    JointArray goal = hand.open_angle;
    std::array<int, kDigits> began{};
    std::array<int, kDigits> ends{};
    std::array<int, kDigits> postures{};
    for (int n = 0; n < ticks; ++n) {
      Sample sample{(n + 1) * scene_.parameters.period(), {}};
      for (int d = 0; d < kDigits; ++d) {
        const auto digit = static_cast<std::size_t>(d);
        if (n == ends[digit]) {
          const double reach = ++postures[digit] % 3 == 0 ? 0.0 : u(random);
          for (int i = 0; i < kJointsPerDigit; ++i) {
            const auto j = static_cast<std::size_t>(joint_index(d, i));
            const double target = hand.min_angle[j] + u(random) * (hand.max_angle[j] - hand.min_angle[j]);
            from[j] = goal[j];
            goal[j] = hand.open_angle[j] + reach * (target - hand.open_angle[j]);
          }
          began[digit] = n;
          ends[digit] = n + 100 + static_cast<int>(900.0 * u(random));
        }
        const double t = static_cast<double>(n - began[digit]) / (ends[digit] - began[digit]);
        const double share = t * t * (3.0 - 2.0 * t);
        for (int i = 0; i < kJointsPerDigit; ++i) {
          const auto j = static_cast<std::size_t>(joint_index(d, i));
          sample.angle[j] = from[j] + share * (goal[j] - from[j]);
        }
      }
      step(model_, scene_.parameters, sample, state);
      ASSERT_NO_FATAL_FAILURE(expect_clear(state.snapshot(), n % 10 == 0));
    }
    EXPECT_LE(exhausted_, 10 + ticks_ / 200) << "of " << ticks_ << " ticks";
  }

  SceneDescription scene_ =
      load_scene(std::get<0>(GetParam()), {{"objects.0.triangles", "1000"}, {"grasp.type", "none"}});
  const HapticModel model_ = build_model(scene_);
  test::FclMesh object_{model_.object.mesh()};
  std::vector<test::FclMesh> segment_;
  std::array<double, kDigits> away_{};  ///< from where it is measured, without a contact [s]
  int contacts_ = 0;
  int ticks_ = 0;
  int exhausted_ = 0;
};

TEST_P(OracleOnScene, NothingPenetratesOverTheWholeMotion) {
  const Motion motion = build_motion(scene_);
  HapticState state(model_, scene_.parameters);
  const int ticks = static_cast<int>(motion.duration() * scene_.parameters.rate_hz);
  for (int n = 0; n <= ticks; ++n) {
    const double t = n / scene_.parameters.rate_hz;
    step(model_, scene_.parameters, Sample{t, motion.at(t)}, state);
    ASSERT_NO_FATAL_FAILURE(expect_clear(state.snapshot(), n % 10 == 0));
  }
  EXPECT_GT(contacts_, 100) << "the scene is there to touch something";
  EXPECT_EQ(exhausted_, 0);
}

TEST_P(OracleOnScene, NothingPenetratesOverASeededMotion) {
  expect_clear_over_seeded_motion(2026, test::kSlowBuild ? 600 : 1000);
  EXPECT_GT(contacts_, 100);
}

TEST_P(OracleOnScene, NothingPenetratesAtAThousandSeededPoses) {
  expect_clear_at_seeded_poses(2026, test::kSlowBuild ? 200 : 1000);
  EXPECT_GT(contacts_, test::kSlowBuild ? 20 : 100);
}

/// The long version, for ./test --soak.
class SoakOracleOnScene : public OracleOnScene {};

TEST_P(SoakOracleOnScene, NothingPenetratesAtTwentyThousandSeededPoses) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    ASSERT_NO_FATAL_FAILURE(expect_clear_at_seeded_poses(seed, 1000));
  EXPECT_GT(contacts_, 2000);
}

TEST_P(SoakOracleOnScene, NothingPenetratesOverSeededMotions) {
  const int ticks = std::get<1>(GetParam()) == ContactMode::kSliding ? 10000 : 1000;
  for (std::uint64_t seed = 1; seed <= 20; ++seed)
    ASSERT_NO_FATAL_FAILURE(expect_clear_over_seeded_motion(seed, ticks));
  std::printf("%d contacts of digits in %d ticks, the search ran out in %d\n", contacts_, ticks_, exhausted_);
  EXPECT_GT(contacts_, ticks_ / 10);
}

const auto kBothModes = ::testing::Values(ContactMode::kStatic, ContactMode::kSliding);

INSTANTIATE_TEST_SUITE_P(Soak, SoakOracleOnScene,
                         ::testing::Combine(::testing::Values("grasp_teapot", "grasp_mug", "grasp_torus",
                                                              "grasp_box", "tripod_ball"),
                                            kBothModes),
                         case_name);

INSTANTIATE_TEST_SUITE_P(Scenes, OracleOnScene,
                         ::testing::Combine(::testing::Values("grasp_teapot", "grasp_mug", "grasp_torus"),
                                            kBothModes),
                         case_name);

}  // namespace
}  // namespace phalanx
