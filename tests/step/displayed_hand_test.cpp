// SPDX-License-Identifier: Apache-2.0
// The hand that is drawn: no digit goes through another one, the palm or the object, by FCL.
#include "phalanx/step/displayed_hand.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/contact/gdp.h"
#include "phalanx/core/index.h"
#include "phalanx/scene/build_model.h"
#include "phalanx/scene/posture_file.h"
#include "phalanx/scene/scene.h"
#include "phalanx/step/haptic_step.h"
#include "support/count_allocations.h"
#include "support/human_motion.h"
#include "support/reference/fcl_oracle.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

constexpr double kFrame = 1.0 / 60.0;  // [s]
// The object is far away, and the wrist does not go there.
const Overrides kAlone = {{"objects.0.position_mm", "[2000, 0, 0]"}, {"grasp.type", "\"none\""}};

/// A scene's hand that is drawn at 60 Hz, and FCL's meshes of it.
class Drawn {
 public:
  explicit Drawn(const char* scene, const Overrides& overrides = {})
      : scene_(load_scene(scene, overrides)),
        model_(build_model(scene_)),
        margin_(scene_.parameters.contact.margin),
        hand_(model_, margin_),
        object_(model_.object.mesh()) {
    for (int s = 0; s < kSegments; ++s) segment_.emplace_back(model_.hand.mesh(s));
  }

  [[nodiscard]] const HandParameters& parameters() const { return model_.hand.parameters(); }
  [[nodiscard]] const HapticModel& model() const { return model_; }
  [[nodiscard]] const SceneDescription& scene() const { return scene_; }
  [[nodiscard]] DisplayedHand& hand() { return hand_; }

  /// Returns the number of pairs of segments that FCL finds in each other, of those that are kept apart.
  [[nodiscard]] int crossings(const JointArray& angle) const {
    HandPoses poses;
    model_.hand.poses(angle, poses);
    int count = 0;
    for_each_pair([&](int a, int b) {
      const Pose X = pose(poses, b).inverse() * pose(poses, a);
      count += segment_[idx(a)].collides(X, segment_[idx(b)]) ? 1 : 0;
    });
    return count;
  }
  /// Returns the digits that FCL finds in each other, if they are two.
  [[nodiscard]] std::optional<std::pair<int, int>> crossing_digits(const JointArray& angle) const {
    HandPoses poses;
    model_.hand.poses(angle, poses);
    std::set<std::pair<int, int>> found;
    for_each_pair([&](int a, int b) {
      if (segment_[idx(a)].collides(pose(poses, b).inverse() * pose(poses, a), segment_[idx(b)]))
        found.emplace(digit_of_segment(a), digit_of_segment(b));
    });
    return found.size() == 1 && found.begin()->second >= 0 ? std::optional(*found.begin()) : std::nullopt;
  }
  /// @returns true if segments that are kept apart are farther than 0.1 mm from each other
  [[nodiscard]] bool is_clear(const JointArray& angle) const {
    HandPoses poses;
    model_.hand.poses(angle, poses);
    bool clear = true;
    for_each_pair([&](int a, int b) {
      if (clear)
        clear = segment_[idx(a)].distance(pose(poses, b).inverse() * pose(poses, a), segment_[idx(b)]) > 1e-4;
    });
    return clear;
  }
  void expect_clear(const std::string& when) const {
    for (std::size_t j = 0; j < kJoints; ++j) {
      ASSERT_GE(hand_.angle()[j], parameters().min_angle[j] - 1e-9) << when << ", joint " << j;
      ASSERT_LE(hand_.angle()[j], parameters().max_angle[j] + 1e-9) << when << ", joint " << j;
    }
    for_each_pair([&](int a, int b) {
      expect_apart(segment_[idx(a)], hand_.pose(b).inverse() * hand_.pose(a), segment_[idx(b)],
                   when + ", " + std::string(segment_name(a)) + " and " + std::string(segment_name(b)));
    });
    for (int s = 0; s < kPalm; ++s)
      expect_apart(segment_[idx(s)], hand_.pose(s), object_, when + ", " + std::string(segment_name(s)));
  }
  /// All flexion, and some abduction of the thumb, at a share of its range.
  [[nodiscard]] JointArray fist(double share, double thumb) const {
    JointArray q = parameters().open_angle;
    for (int d = 0; d < kDigits; ++d)
      for (int i = 0; i < kJointsPerDigit; ++i) {
        const std::size_t j = idx(joint_index(d, i));
        if (i == kAbductionJoint && d != 0) continue;
        q[j] += (d == 0 ? thumb : share) * (i == kAbductionJoint ? 0.5 : 1.0) *
                (parameters().max_angle[j] - q[j]);
      }
    return q;
  }

  /// Fingers that bend at their middle joints alone.
  [[nodiscard]] JointArray curl(double share) const {
    JointArray q = parameters().open_angle;
    for (int d = 1; d < kDigits; ++d)
      q[idx(joint_index(d, 1))] += share * parameters().max_angle[idx(joint_index(d, 1))];
    return q;
  }

 private:
  [[nodiscard]] const Pose& pose(const HandPoses& poses, int s) const {
    return s == kPalm ? model_.hand.palm_pose()
                      : poses.digit[idx(digit_of_segment(s))].segment[idx(s % kSegmentsPerDigit)];
  }
  template <class Use>
  void for_each_pair(Use&& use) const {
    for (int a = 0; a < kPalm; ++a)
      for (int b = a + 1; b <= kPalm; ++b)
        if (hand_.keeps_apart(a, b)) use(a, b);
  }
  void expect_apart(const test::FclMesh& a, const Pose& X, const test::FclMesh& b,
                    const std::string& what) const {
    ASSERT_FALSE(a.collides(X, b)) << what;
    if (test::kSlowBuild) return;  // distances take FCL most of the time; the release build has them
    ASSERT_GE(a.distance(X, b), margin_ - 10e-9) << what;
  }

  SceneDescription scene_;
  HapticModel model_;
  double margin_;
  DisplayedHand hand_;
  std::vector<test::FclMesh> segment_;
  test::FclMesh object_;
};

/// Share of a motion that goes to 1 between `from` and `to`.
double ramp(double t, double from, double to) { return std::clamp((t - from) / (to - from), 0.0, 1.0); }

TEST(DisplayedHand, DigitsOfAFistDoNotGoThroughEachOther) {
  for (const double thumb_after : {0.0, 0.8}) {  // under the fingers, over them
    Drawn drawn("first_touch", kAlone);
    int crossed = 0;
    for (double t = 0.0; t < 2.6; t += kFrame) {
      const double opens = 1.0 - ramp(t, 1.8, 2.3);
      const JointArray q =
          drawn.fist(0.9 * ramp(t, 0.0, 0.8) * opens, 0.9 * ramp(t, thumb_after, thumb_after + 0.6) * opens);
      drawn.hand().follow(q, kFrame);
      crossed += drawn.crossings(q) > 0 ? 1 : 0;
      ASSERT_NO_FATAL_FAILURE(drawn.expect_clear("thumb after " + std::to_string(thumb_after) + " s, at " +
                                                 std::to_string(t) + " s"));
      if (test::kSlowBuild) t += 2.0 * kFrame;
    }
    EXPECT_GT(crossed, 15) << "the GDP goes through itself";
    EXPECT_EQ(drawn.hand().angle(), drawn.parameters().open_angle) << "it is open again";
  }
}

TEST(DisplayedHand, FingersThatCrossDoNotGoThroughEachOther) {
  int crossed = 0;
  int compared = 0;
  for (const int finger : {1, 2}) {  // in one of both senses they go towards each other
    Drawn drawn("first_touch", kAlone);
    const HandParameters& range = drawn.parameters();
    const std::size_t out = idx(joint_index(finger, kAbductionJoint));
    const std::size_t in = idx(joint_index(3 - finger, kAbductionJoint));
    for (double t = 0.0; t < 2.0; t += kFrame) {
      JointArray q = range.open_angle;
      const double share = ramp(t, 0.0, 0.8) * (1.0 - ramp(t, 1.2, 1.6));
      q[out] += share * (range.max_angle[out] - q[out]);
      q[in] += share * (range.min_angle[in] - q[in]);
      drawn.hand().follow(q, kFrame);
      crossed += drawn.crossings(q) > 0 ? 1 : 0;
      ASSERT_NO_FATAL_FAILURE(drawn.expect_clear("at " + std::to_string(t) + " s"));
      const auto digits = drawn.crossing_digits(q);
      if (t < 1.0 || t > 1.1 || !digits) continue;
      // Neither of both has precedence: each gives way.
      const auto way = [&](int digit) {
        double most = 0.0;
        for (int i = 0; i < kJointsPerDigit; ++i) {
          const std::size_t j = idx(joint_index(digit, i));
          most = std::max(most, std::abs(drawn.hand().angle()[j] - q[j]));
        }
        return most;
      };
      const double first = way(digits->first);
      const double second = way(digits->second);
      EXPECT_GT(first, 0.25 * (first + second)) << digits->first << " and " << digits->second;
      EXPECT_GT(second, 0.25 * (first + second)) << digits->first << " and " << digits->second;
      ++compared;
    }
  }
  EXPECT_GT(crossed, 15);
  EXPECT_GT(compared, 3);
}

// Between two postures that are clear, fingers may be in the way.
TEST(DisplayedHand, EveryPostureThatIsClearIsShownInTheEnd) {
  constexpr std::uint64_t kSeed = 9;
  SCOPED_TRACE("seed " + std::to_string(kSeed));
  test::Random random(kSeed);
  Drawn drawn("first_touch", kAlone);
  const auto posture = [&] {
    for (;;) {
      JointArray q = drawn.parameters().open_angle;
      for (std::size_t j = 0; j < kJoints; ++j)
        q[j] += test::between(random, 0.0, 0.9) * (drawn.parameters().max_angle[j] - q[j]);
      if (drawn.is_clear(q)) return q;
    }
  };
  for (int n = 0; n < (test::kSlowBuild ? 2 : 12); ++n) {
    const JointArray from = posture();
    const JointArray to = posture();
    Drawn hand("first_touch", kAlone);
    hand.hand().follow(from, kFrame);
    int frames = 0;
    while (hand.hand().angle() != to && frames < 60) {
      hand.hand().follow(to, kFrame);
      ASSERT_NO_FATAL_FAILURE(hand.expect_clear("pair " + std::to_string(n)));
      ++frames;
    }
    // 31 frames are the first longer than half a second; the way itself takes some before.
    EXPECT_LT(frames, 60) << "pair " << n;
  }
}

// The fingers close around a thumb in the palm; then the thumb is to lie over them.
TEST(DisplayedHand, AThumbUnderTheFingersIsShownOverThemAfterHalfASecond) {
  Drawn drawn("first_touch", kAlone);
  JointArray fist{};
  JointArray in_palm{};
  for (const Posture& posture : load_postures("adult")) {
    if (posture.name == "fist") fist = posture.angle;
    if (posture.name == "kapandji_10") in_palm = posture.angle;
  }
  JointArray fingers = fist;
  std::copy_n(drawn.parameters().open_angle.begin(), kJointsPerDigit, fingers.begin());
  JointArray under = fist;
  std::copy_n(in_palm.begin(), kJointsPerDigit, under.begin());
  Drawn other("first_touch", kAlone);
  for (int frame = 0; frame < 60; ++frame) other.hand().follow(fingers, kFrame);
  for (int frame = 0; frame < 60; ++frame) other.hand().follow(fist, kFrame);
  const JointArray over = other.hand().angle();
  for (int frame = 0; frame < 60; ++frame) drawn.hand().follow(in_palm, kFrame);
  for (int frame = 0; frame < 60; ++frame) {
    drawn.hand().follow(under, kFrame);
    ASSERT_NO_FATAL_FAILURE(drawn.expect_clear("under"));
  }
  int frames = 0;
  while (drawn.hand().angle() != over && frames < 90) {
    drawn.hand().follow(over, kFrame);
    ASSERT_NO_FATAL_FAILURE(drawn.expect_clear("over"));
    ++frames;
  }
  EXPECT_GE(frames, 31) << "it has to wait";
  EXPECT_LT(frames, 90);
}

TEST(DisplayedHand, WithAGreatMarginTheOpenHandStays) {
  for (const char* margin : {"0.5", "1.0"}) {
    Drawn drawn("first_touch", {kAlone.front(), kAlone.back(), {"contact.margin_mm", margin}});
    for (int frame = 0; frame < 5; ++frame) drawn.hand().follow(drawn.parameters().open_angle, kFrame);
    EXPECT_EQ(drawn.hand().angle(), drawn.parameters().open_angle) << margin;
    const JointArray q = drawn.fist(0.9, 0.9);
    for (int frame = 0; frame < 60; ++frame) drawn.hand().follow(q, kFrame);
    ASSERT_NO_FATAL_FAILURE(drawn.expect_clear(margin));
  }
}

TEST(DisplayedHand, AnglesThatAreNoNumbersChangeNothing) {
  Drawn drawn("first_touch", kAlone);
  JointArray q = drawn.parameters().open_angle;
  q[3] = std::numeric_limits<double>::quiet_NaN();
  drawn.hand().follow(q, kFrame);
  EXPECT_EQ(drawn.hand().angle(), drawn.parameters().open_angle);
}

TEST(DisplayedHand, AHandThatHoldsAnObjectGoesThroughNeither) {
  for (const char* mode : {"\"static\"", "\"sliding\""}) {
    Drawn drawn("pinch_peg", {{"contact.mode", mode}, {"rate_hz", "1000.0"}});
    const ContactModel contact{drawn.model().hand, drawn.model().trees(), drawn.model().object,
                               drawn.scene().parameters.contact, 1e-3};
    GdpState gdp(contact);
    HandPoses hcp;
    std::array<bool, kDigits> measured{};
    measured.fill(true);
    int crossed = 0;
    for (int tick = 0; tick < 1600; ++tick) {
      const double t = 1e-3 * tick;
      const JointArray q = drawn.fist(0.9 * ramp(t, 0.0, 0.8) * (1.0 - ramp(t, 1.2, 1.5)),
                                      0.9 * ramp(t, 0.3, 0.9) * (1.0 - ramp(t, 1.2, 1.5)));
      drawn.model().hand.poses(q, hcp);
      (void)advance_gdp(contact, q, hcp, measured, gdp);
      if (tick % (test::kSlowBuild ? 50 : 17) != 0) continue;
      drawn.hand().follow(gdp.angle, 17e-3);
      crossed += drawn.crossings(gdp.angle) > 0 ? 1 : 0;
      ASSERT_NO_FATAL_FAILURE(drawn.expect_clear(std::string(mode) + " at " + std::to_string(t) + " s"));
    }
    EXPECT_GT(crossed, test::kSlowBuild ? 1 : 5) << mode;
  }
}

void expect_seeded_motion_clear(std::uint64_t seed, int frames) {
  Drawn drawn("first_touch", kAlone);
  test::HumanMotion motion(drawn.parameters(), seed);
  int crossed = 0;
  for (int frame = 0; frame < frames; ++frame) {
    const JointArray q = motion.next(kFrame);
    drawn.hand().follow(q, kFrame);
    crossed += drawn.crossings(q) > 0 ? 1 : 0;
    ASSERT_NO_FATAL_FAILURE(
        drawn.expect_clear("seed " + std::to_string(seed) + ", frame " + std::to_string(frame)));
  }
  std::printf("seed %llu: the GDP goes through itself in %d of %d frames\n",
              static_cast<unsigned long long>(seed), crossed, frames);
  EXPECT_GT(crossed, frames / 5) << "without such frames the test shows nothing";
}

TEST(DisplayedHand, SeededMotionGoesThroughNothing) {
  expect_seeded_motion_clear(3, test::kSlowBuild ? 40 : 120);
}

/// The long version, for ./test --full.
TEST(ManyDisplayedHands, SeededMotionGoesThroughNothing) {
  for (std::uint64_t seed = 4; seed < (test::kSlowBuild ? 5 : 8); ++seed)
    expect_seeded_motion_clear(seed, test::kSlowBuild ? 100 : 600);
}

TEST(DisplayedHand, IsTheGdpWhereNothingMeets) {
  Drawn drawn("first_touch", kAlone);
  for (double t = 0.0; t < 1.0; t += kFrame) {
    const JointArray q = drawn.curl(0.5 * ramp(t, 0.0, 0.8));
    ASSERT_EQ(drawn.crossings(q), 0);
    drawn.hand().follow(q, kFrame);
    ASSERT_EQ(drawn.hand().angle(), q) << t;
  }
}

TEST(DisplayedHand, AStartInAFistIsMovedOut) {
  Drawn drawn("first_touch", kAlone);
  const JointArray q = drawn.fist(0.9, 0.9);
  ASSERT_GT(drawn.crossings(q), 0);
  for (int frame = 0; frame < 60; ++frame) {
    drawn.hand().follow(q, kFrame);
    ASSERT_NO_FATAL_FAILURE(drawn.expect_clear("frame " + std::to_string(frame)));
  }
  double closed = 0.0;
  for (const int d : {1, 2, 3, 4}) {
    const std::size_t j = idx(joint_index(d, 0));
    closed = std::max(closed, std::abs(drawn.hand().angle()[j] - drawn.parameters().open_angle[j]));
  }
  EXPECT_GT(closed, 0.5) << "it is a fist [rad]";
}

TEST(DisplayedHand, AStartInAPostureThatIsClearIsShownAtOnce) {
  Drawn drawn("first_touch", kAlone);
  const JointArray q = drawn.curl(0.5);
  ASSERT_EQ(drawn.crossings(q), 0);
  drawn.hand().follow(q, 0.0);
  EXPECT_EQ(drawn.hand().angle(), q);
}

TEST(DisplayedHand, AllocatesNothing) {
  Drawn drawn("first_touch", kAlone);
  const JointArray q = drawn.fist(0.9, 0.9);
  const std::size_t before = test::allocations_of_this_thread();
  for (int frame = 0; frame < 30; ++frame) drawn.hand().follow(q, kFrame);
  EXPECT_EQ(test::allocations_of_this_thread(), before);
}

TEST(DisplayedHand, KeepsApartWhatIsApartAtTheOpenHand) {
  Drawn drawn("first_touch", kAlone);
  const DisplayedHand& hand = drawn.hand();
  const auto segment = [](int digit, int k) { return segment_index(digit, k); };
  EXPECT_TRUE(hand.keeps_apart(segment(0, 2), segment(1, 1)));
  EXPECT_TRUE(hand.keeps_apart(segment(3, 1), segment(2, 1))) << "in either order";
  EXPECT_TRUE(hand.keeps_apart(segment(1, 2), kPalm));
  EXPECT_FALSE(hand.keeps_apart(segment(1, 0), segment(1, 2))) << "of one digit";
  EXPECT_FALSE(hand.keeps_apart(segment(1, 0), kPalm)) << "they overlap at the knuckle";
  EXPECT_FALSE(hand.keeps_apart(segment(1, 0), segment(2, 0))) << "they overlap at the fingers' roots";
  int exceptions = 0;
  for (int a = 0; a < kPalm; ++a)
    for (int b = a + 1; b <= kPalm; ++b)
      exceptions += digit_of_segment(a) != digit_of_segment(b) && !hand.keeps_apart(a, b) ? 1 : 0;
  EXPECT_EQ(exceptions, 10 + 4 + 2)
      << "roots of digits among themselves, fingers' roots in the palm, and the thumb's two in the palm";
}

// The thumb's metacarpal goes beside the middle finger's root when the thumb opposes.
TEST(DisplayedHand, FollowsAThumbThatOpposesEachFinger) {
  for (const Posture& posture : load_postures("adult")) {
    if (!posture.name.starts_with("pinch_")) continue;
    Drawn drawn("first_touch", kAlone);
    for (int frame = 0; frame < 90; ++frame) {
      JointArray q = drawn.parameters().open_angle;
      for (std::size_t j = 0; j < kJoints; ++j) q[j] += ramp(frame, 0.0, 60.0) * (posture.angle[j] - q[j]);
      drawn.hand().follow(q, kFrame);
    }
    for (std::size_t j = 0; j < kJoints; ++j) {
      EXPECT_NEAR(drawn.hand().angle()[j], posture.angle[j], 0.05)
          << posture.name << ", " << joint_name(static_cast<int>(j));
    }
  }
}

TEST(DisplayedHandDraw, MovesPosesAndPointsButNeitherForcesNorWhatIsMeasured) {
  Snapshot snapshot;
  snapshot.gdp_pose[3].p = snapshot.hcp_pose[3].p = Vec3(0.1, 0.0, 0.0);  // free
  snapshot.gdp_pose[7].p = Vec3(0.2, 0.0, 0.0);                           // held by an object
  snapshot.hcp_pose[7].p = Vec3(0.2, 0.0, -0.01);
  snapshot.segment[7].contact = true;
  snapshot.segment[7].force = 2.0;
  snapshot.segment[7].normal = Vec3::UnitZ();
  snapshot.segment[7].point = Vec3(0.21, 0.02, 0.0);
  snapshot.contact_points.count = 1;
  snapshot.contact_points.point[0] = {
      .segment = 7, .point = Vec3(0.21, -0.02, 0.0), .normal = Vec3::UnitZ(), .force = 2.0};
  std::array<Pose, kSegments> displayed = snapshot.gdp_pose;
  displayed[3].p.z() = displayed[6].p.z() = 0.005;
  // A quarter turn about z, and 3 mm up.
  displayed[7].R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  displayed[7].p.z() = 0.003;
  draw_at(displayed, snapshot);
  EXPECT_EQ(snapshot.gdp_pose[3].p, displayed[3].p);
  EXPECT_EQ(snapshot.hcp_pose[3].p, displayed[3].p) << "nothing keeps it from where it is measured";
  EXPECT_EQ(snapshot.hcp_pose[7].p, Vec3(0.2, 0.0, -0.01));
  EXPECT_EQ(snapshot.hcp_pose[6].p, Vec3(0.0, 0.0, 0.0))
      << "of the same digit: all of it is drawn as measured";
  EXPECT_LT((snapshot.segment[7].point - Vec3(0.18, 0.01, 0.003)).norm(), 1e-15);
  EXPECT_LT((snapshot.contact_points.point[0].point - Vec3(0.22, 0.01, 0.003)).norm(), 1e-15);
  EXPECT_EQ(snapshot.segment[7].normal, Vec3::UnitZ());
  EXPECT_EQ(snapshot.contact_points.point[0].normal, Vec3::UnitZ());
  EXPECT_EQ(snapshot.segment[7].force, 2.0);
}

}  // namespace
}  // namespace phalanx
