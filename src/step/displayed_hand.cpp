// SPDX-License-Identifier: Apache-2.0
#include "phalanx/step/displayed_hand.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "contact/first_contact.h"
#include "contact/manifold.h"
#include "contact/pair_search.h"
#include "phalanx/contact/clearance.h"
#include "phalanx/contact/near_pairs.h"
#include "phalanx/contact/object_tree.h"
#include "phalanx/contact/pair_list.h"
#include "phalanx/contact/proximity.h"
#include "phalanx/contact/segment_motion.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

/// Number of the object among the bodies; the segments have theirs.
constexpr int kObjectBody = kSegments;

constexpr double kDistanceRounding = 1e-9;  // [m]
constexpr double kRoom = 50e-6;     // above the margin, of bodies that are kept apart, at the open hand [m]
constexpr double kReached = 50e-6;  // way to the GDP that is left where the hand touches something [m]

/// @returns the body's digit, or -1: it does not move
int moving_digit(int body) noexcept { return body < kPalm ? digit_of_segment(body) : -1; }

/// @returns true if both are the first segments of digits. Their meshes reach into the palm, and meet there when the
/// thumb opposes.
bool are_roots(int segment, int other) {
  return segment != kPalm && other != kPalm && segment % kSegmentsPerDigit == 0 &&
         other % kSegmentsPerDigit == 0;
}

}  // namespace

class DisplayedHand::Impl {
 public:
  Impl(const HapticModel& model, double margin);

  void follow(const JointArray& gdp, double period) noexcept;
  [[nodiscard]] const JointArray& angle() const noexcept { return angle_; }
  [[nodiscard]] const Pose& pose(int segment) const noexcept { return pose_in(poses_, segment); }
  [[nodiscard]] bool keeps_apart(int segment, int other) const noexcept;

 private:
  /// A digit's segment and what it is kept apart from: a segment of another digit, the palm, or the object.
  struct BodyPair {
    int segment = 0;
    int other = 0;
    Clearance clearance;
    bool asked = false;  ///< in this step, for a bound
  };
  class Step;

  [[nodiscard]] const Pose& pose_in(const HandPoses& poses, int body) const noexcept;
  [[nodiscard]] const ObjectTree& tree_of(int body) const noexcept;
  /// @returns true if no bodies are nearer to each other than the margin at these angles
  [[nodiscard]] bool is_clear(const JointArray& angle) noexcept;
  /// Returns how far a point moves at most to these angles [m].
  [[nodiscard]] double way_to(const JointArray& angle) const noexcept;
  void show(const JointArray& angle) noexcept;
  /// Shows the hand elsewhere, without a way.
  void jump(const JointArray& angle) noexcept;

  const HandModel& hand_;
  const SegmentTrees& trees_;
  const ObjectModel& object_;
  const double margin_;
  std::array<ObjectTree, kSegments> as_object_;  ///< segments as objects for others, in their own frames
  std::vector<BodyPair> pair_;
  JointArray angle_{};  ///< [rad]
  HandPoses poses_;     ///< at angle_
  bool begun_ = false;
  double waits_for_ = 0.0;  ///< time for which the GDP has been clear and has not been reached [s]
  NearPairs near_;          ///< scratch
  PairList list_;           ///< scratch
  SearchScratch scratch_;
};

/// One step of the displayed hand.
class DisplayedHand::Impl::Step {
 public:
  static constexpr double kStill = 1e-6;  // way that is no progress [m]

  Step(Impl& hand, const JointArray& goal) noexcept : hand_(hand), goal_(goal) {
    for (BodyPair& pair : hand_.pair_) pair.asked = false;
  }

  /// @returns how far a point has moved at most [m]
  double run() noexcept {
    if (is_free()) {
      spend(1.0);
      hand_.show(goal_);
      return kMostWay;
    }
    double way = 0.0;
    for (int event = 0; event <= kMostEvents && way < kMostWay; ++event) {
      JointArray x = towards_goal();
      gather();
      recover(event == 0 ? kMostRecovery : kWorkingGap);
      x = towards_goal();
      solve(false, x);
      const double done = move(x);
      if (!(done > 0.0)) hold_stopped();
      way += done * *std::max_element(speed_.begin(), speed_.end());
      if (done >= 1.0) break;
    }
    return way;
  }

 private:
  static constexpr double kWorkingGap = 10e-6;     // above the margin, at which contacts are held [m]
  static constexpr double kMostReach = 50e-6;      // beyond it the continuous search finds contacts [m]
  static constexpr double kSlack = 20e-6;          // of the reach, above the way of this step [m]
  static constexpr double kLongestReach = 2.5e-3;  // way for which pairs are listed at once [m]
  static constexpr double kMostRecovery = 2e-6;    // way back to the working gap at a step's begin [m]
  static constexpr double kLeastRecovery = 1e-9;   // [m]
  static constexpr double kRecoverySoftness =
      0.05;                                   // of a row, so that it converges between opposed contacts
  static constexpr double kTolerance = 1e-9;  // of a sweep [m]
  static constexpr double kLever = 0.1;       // of a joint, as the tolerance counts it [m]
  static constexpr int kMostRows = 256;
  static constexpr int kMostEvents = 4;
  static constexpr int kSweeps = 60;
  static constexpr int kMostPoses = 200;  // of one pair of bodies on one way

  /// Row of a contact of two bodies along its normal.
  struct Row {
    std::array<int, 2> digit{-1, -1};
    std::array<DigitAngles, 2> J{};  ///< opening per joint displacement [m/rad]
    double room = 0.0;               ///< above the working gap [m]
    double square = 0.0;             ///< product of the row with itself [m^2]
    double p = 0.0;                  ///< multiplier [1/m]

    [[nodiscard]] double dot(const JointArray& x) const noexcept {
      double sum = 0.0;
      for_each([&](std::size_t joint, double J_j) { sum += J_j * x[joint]; });
      return sum;
    }
    template <class Use>
    void for_each(Use&& use) const noexcept {
      for (std::size_t side = 0; side < digit.size(); ++side)
        for (int i = 0; digit[side] >= 0 && i < kJointsPerDigit; ++i)
          use(idx(joint_index(digit[side], i)), J[side][idx(i)]);
    }
  };

  [[nodiscard]] const Pose& pose_of(int body) const noexcept {
    return body == kObjectBody ? world_ : hand_.pose(body);
  }
  [[nodiscard]] double working_gap() const noexcept { return hand_.margin_ + kWorkingGap; }

  /// Bounds the way of each segment's points for a displacement of the joints.
  void set_speeds(const JointArray& x) noexcept {
    for (int s = 0; s < kPalm; ++s) {
      const int digit = digit_of_segment(s);
      speed_[idx(s)] = segment_speed(hand_.hand_, digit, digit_angles(x, digit), s % kSegmentsPerDigit);
    }
  }
  [[nodiscard]] double speed(const BodyPair& pair) const noexcept {
    return speed_[idx(pair.segment)] + speed_[idx(pair.other)];
  }
  void spend(double share) noexcept {
    for (BodyPair& pair : hand_.pair_) pair.clearance.spend(share * speed(pair));
  }
  [[nodiscard]] JointArray moved(const JointArray& x, double share) const noexcept {
    JointArray to = hand_.angle_;
    for (std::size_t j = 0; j < kJoints; ++j) to[j] += share * x[j];
    return to;
  }
  /// Returns the displacement to the goal, shortened to kMostWay [rad].
  JointArray towards_goal() noexcept {
    JointArray x{};
    for (std::size_t j = 0; j < kJoints; ++j)
      if (!held_[idx(digit_of_joint(static_cast<int>(j)))]) x[j] = goal_[j] - hand_.angle_[j];
    shorten(x);
    return x;
  }
  /// Shortens x so that no point moves farther than kMostWay, and sets the bodies' ways.
  void shorten(JointArray& x) noexcept {
    set_speeds(x);
    const double farthest = *std::max_element(speed_.begin(), speed_.end());
    if (farthest <= kMostWay) return;
    for (double& angle : x) angle *= kMostWay / farthest;
    set_speeds(x);
  }
  /// @returns true if no pair of bodies may come within the margin on the way to the goal
  [[nodiscard]] bool is_free() noexcept {
    JointArray x{};
    for (std::size_t j = 0; j < kJoints; ++j) x[j] = goal_[j] - hand_.angle_[j];
    set_speeds(x);
    return std::all_of(hand_.pair_.begin(), hand_.pair_.end(),
                       [&](BodyPair& pair) { return is_farther(pair, hand_.margin_ + speed(pair)); });
  }
  /// @returns true if the pair's bodies are known to be farther apart than `distance` [m]. Computes a new bound at most
  /// once a step.
  [[nodiscard]] bool is_farther(BodyPair& pair, double distance) noexcept {
    constexpr double kStepsAhead = 16.0;    // steps of this way that a new bound should last
    constexpr double kLeastAhead = 0.3e-3;  // [m]
    constexpr double kMostAhead = 4e-3;     // [m]
    if (pair.clearance.bound() > distance) return true;
    if (pair.asked) return false;
    pair.asked = true;
    const double way = speed(pair);
    const double cap =
        std::max(distance,
                 hand_.margin_ + std::max({std::min(kStepsAhead * way, kMostAhead), 2.0 * way, kLeastAhead}));
    const Pose X = pose_of(pair.other).inverse() * pose_of(pair.segment);
    pair.clearance.learn(distance_bound(placed(pair, X), hand_.tree_of(pair.other), cap), true);
    return pair.clearance.bound() > distance;
  }
  /// @param X  pose of the segment in the other body's frame
  [[nodiscard]] PlacedSegment placed(const BodyPair& pair, const Pose& X) noexcept {
    return {hand_.trees_[idx(pair.segment)], X, hand_.scratch_};
  }

  /// Lists the contacts at the hand's pose, and what the range of motion leaves.
  void gather() noexcept {
    rows_ = 0;
    const HandParameters& range = hand_.hand_.parameters();
    for (std::size_t j = 0; j < kJoints; ++j) {
      const double to_goal = goal_[j] - hand_.angle_[j];
      const bool held = held_[idx(digit_of_joint(static_cast<int>(j)))];
      lowest_[j] = held ? 0.0 : std::min({range.min_angle[j] - hand_.angle_[j], to_goal, 0.0});
      highest_[j] = held ? 0.0 : std::max({range.max_angle[j] - hand_.angle_[j], to_goal, 0.0});
    }
    for (BodyPair& pair : hand_.pair_) {
      const double reach = working_gap() + std::min(kMostReach, speed(pair) + kSlack);
      if (is_farther(pair, reach)) continue;
      const Pose& other = pose_of(pair.other);
      const Pose X = other.inverse() * pose_of(pair.segment);
      Manifold manifold;
      hand_.near_.clear();
      find_manifold(placed(pair, X), hand_.tree_of(pair.other), reach, working_gap() + kSlack,
                    Manifold::kMost, hand_.near_, manifold);
      for (int i = 0; i < manifold.count && rows_ < kMostRows; ++i) add(pair, manifold.place[idx(i)], other);
    }
  }
  void add(const BodyPair& pair, const ContactPlace& place, const Pose& other) noexcept {
    Row& row = row_[idx(rows_++)];
    row = {};
    row.room = place.gap - working_gap();
    const Vec3 direction = other.R * place.direction;
    const std::array<int, 2> body = {pair.segment, pair.other};
    const std::array<Vec3, 2> at = {other * place.on_segment, other * place.on_object};
    for (std::size_t side = 0; side < body.size(); ++side) {
      row.digit[side] = moving_digit(body[side]);
      if (row.digit[side] < 0) continue;
      const DigitPose& pose = hand_.poses_.digit[idx(row.digit[side])];
      const PointJacobian J = point_jacobian(pose, body[side] % kSegmentsPerDigit, at[side]);
      for (std::size_t i = 0; i < J.linear.size(); ++i) {
        row.J[side][i] = (side == 0 ? 1.0 : -1.0) * direction.dot(J.linear[i]);
        row.square += row.J[side][i] * row.J[side][i];
      }
    }
  }
  /// Turns x into the displacement nearest to it in joint space that the rows and the range of motion admit, by
  /// Gauss-Seidel. An angle that is beyond the range already, or of the GDP, may stay there.
  ///   0 <= J x' + room  complementary to  p >= 0,  x' = x + sum J^T p + limits' multipliers
  void solve(bool recovers, JointArray& x) noexcept {
    const double softness = recovers ? kRecoverySoftness : 0.0;
    for (int r = 0; r < rows_; ++r) row_[idx(r)].p = 0.0;
    JointArray limit{};
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      double largest = 0.0;
      for (int r = 0; r < rows_; ++r) {
        Row& row = row_[idx(r)];
        if (!(row.square > 0.0)) continue;
        const double room = recovers ? row.room : std::max(0.0, row.room);
        const double apart = row.dot(x) + room + softness * row.square * row.p;
        const double p = std::max(0.0, row.p - apart / ((1.0 + softness) * row.square));
        const double change = p - row.p;
        row.p = p;
        row.for_each([&](std::size_t joint, double J_j) { x[joint] += change * J_j; });
        largest = std::max(largest, std::abs(change) * row.square);
      }
      for (std::size_t j = 0; j < kJoints; ++j) {
        const double before = x[j];
        const double without = before - limit[j];
        x[j] = std::clamp(without, lowest_[j], highest_[j]);
        limit[j] = x[j] - without;
        largest = std::max(largest, kLever * std::abs(x[j] - before));
      }
      if (largest < kTolerance) return;
    }
  }
  /// Moves bodies that are nearer than the working gap apart, by at most `most` [m].
  void recover(double most) noexcept {
    double least = 0.0;
    for (int r = 0; r < rows_; ++r) {
      Row& row = row_[idx(r)];
      row.room = std::max(row.room, -most);
      least = std::min(least, row.room);
    }
    if (least > -kLeastRecovery) return;
    JointArray x{};
    solve(true, x);
    if (move(x) > 0.0) gather();
  }
  /// Moves the hand along x, shortened to kMostWay, up to the first stop. @returns the share of that
  double move(JointArray& x) noexcept {
    shorten(x);
    double end = 1.0;
    stopping_ = nullptr;
    for (BodyPair& pair : hand_.pair_) {
      if (speed(pair) == 0.0 || is_farther(pair, hand_.margin_ + end * speed(pair))) continue;
      const double stop = first_stop(pair, x, end);
      if (stop < end) stopping_ = &pair;
      end = std::min(end, stop);
    }
    if (!(end > 0.0)) return 0.0;
    spend(end);
    hand_.show(moved(x, end));
    return end;
  }

  /// Lets the digits that stop each other at once, though no contact point forbids it, stay for the rest of the step.
  void hold_stopped() noexcept {
    if (stopping_ == nullptr) return;
    for (const int body : {stopping_->segment, stopping_->other})
      if (const int digit = moving_digit(body); digit >= 0) held_[idx(digit)] = true;
  }

  /// Segment of a pair in the other body's frame, on the way x.
  struct Placed {
    Pose X;
    SegmentMotion motion;
  };
  [[nodiscard]] Placed place(const BodyPair& pair, const JointArray& x, double share) const noexcept {
    const JointArray to = moved(x, share);
    const auto pose_at = [&](int digit, DigitPose& pose) {
      hand_.hand_.digit_pose(digit, digit_angles(to, digit), pose);
    };
    const SegmentTree& tree = hand_.trees_[idx(pair.segment)];
    const int digit = moving_digit(pair.segment);
    const DigitAngles rate = digit_angles(x, digit);
    DigitPose pose;
    pose_at(digit, pose);
    const MovingSegment segment{digit, pair.segment % kSegmentsPerDigit, pose, rate};
    const Pose& X = pose.segment[idx(segment.k)];
    const Sphere around{X * tree.centre(), tree.radius()};
    const int other = moving_digit(pair.other);
    if (other < 0) {
      const Pose& frame = pose_of(pair.other);
      return {frame.inverse() * X, relative_motion(hand_.hand_, segment, around, frame, nullptr, 0.0)};
    }
    const DigitAngles other_rate = digit_angles(x, other);
    DigitPose other_pose;
    pose_at(other, other_pose);
    const MovingSegment carrier{other, pair.other % kSegmentsPerDigit, other_pose, other_rate};
    const Pose& frame = other_pose.segment[idx(carrier.k)];
    return {frame.inverse() * X, relative_motion(hand_.hand_, segment, around, frame, &carrier, speed(pair))};
  }
  /// Returns the share of x at which the pair's bodies stop each other, at most `most`.
  [[nodiscard]] double first_stop(const BodyPair& pair, const JointArray& x, double most) noexcept {
    PairList& list = hand_.list_;
    const ObjectTree& other = hand_.tree_of(pair.other);
    const StopBand band = stop_band(hand_.margin_);
    double s = 0.0;
    Placed now = place(pair, x, s);
    for (int poses = 0; poses < kMostPoses;) {
      list.count = 0;
      list.begin = {};
      const double horizon =
          gather_pairs({placed(pair, now.X), other, now.motion, band}, s,
                       std::min(most, s + kLongestReach / std::max(now.motion.speed, 1e-12)), 0, list);
      std::fill(list.begin.begin() + 1, list.begin.end(), list.count);
      const bool crowded = s < most && !(horizon > s);
      for (bool reached = false; !reached && poses < kMostPoses; ++poses) {
        if (evaluate_pairs({placed(pair, now.X), other, now.motion, band}, s, horizon, 0, s >= horizon,
                           list) ||
            crowded)
          return s;
        const double next = std::min(horizon, least_until(list));
        reached = s >= horizon || (next >= horizon && !any_near(list));
        if (!reached && !(next > s)) return s;
        if (next > s) now = place(pair, x, s = next);
        if (reached && s >= most) return most;
      }
    }
    return s;
  }

  Impl& hand_;
  const JointArray& goal_;
  const Pose world_;                           ///< of the object: the identity
  std::array<bool, kDigits> held_{};           ///< for the rest of the step
  const BodyPair* stopping_ = nullptr;         ///< pair that stopped the last motion
  JointArray lowest_{};                        ///< of a displacement [rad]
  JointArray highest_{};                       ///< [rad]
  std::array<double, kSegments + 1> speed_{};  ///< of the bodies' points, on a way [m]
  std::array<Row, kMostRows> row_;
  int rows_ = 0;
};

DisplayedHand::Impl::Impl(const HapticModel& model, double margin)
    : hand_(model.hand), trees_(model.trees()), object_(model.object), margin_(margin), scratch_(trees_) {
  for (int s = 0; s < kSegments; ++s) as_object_[idx(s)] = ObjectTree(hand_.mesh(s));
  show(hand_.parameters().open_angle);
  for (int segment = 0; segment < kPalm; ++segment) {
    for (int other = segment + 1; other <= kPalm; ++other) {
      if (moving_digit(other) == moving_digit(segment)) continue;
      if (are_roots(segment, other)) continue;
      const Pose X = pose(other).inverse() * pose(segment);
      const PlacedSegment at{trees_[idx(segment)], X, scratch_};
      const double least = std::max(kLeastGap, margin_ + kRoom);
      if (distance(at, as_object_[idx(other)], 2.0 * least) >= least) pair_.push_back({segment, other, {}});
    }
    pair_.push_back({segment, kObjectBody, {}});
  }
}

const Pose& DisplayedHand::Impl::pose_in(const HandPoses& poses, int body) const noexcept {
  if (body == kPalm) return hand_.palm_pose();
  return poses.digit[idx(digit_of_segment(body))].segment[idx(body % kSegmentsPerDigit)];
}

const ObjectTree& DisplayedHand::Impl::tree_of(int body) const noexcept {
  return body == kObjectBody ? object_.tree() : as_object_[idx(body)];
}

bool DisplayedHand::Impl::keeps_apart(int segment, int other) const noexcept {
  return std::any_of(pair_.begin(), pair_.end(), [&](const BodyPair& pair) {
    return pair.segment == std::min(segment, other) && pair.other == std::max(segment, other);
  });
}

void DisplayedHand::Impl::show(const JointArray& angle) noexcept {
  angle_ = angle;
  hand_.poses(angle, poses_);
}

bool DisplayedHand::Impl::is_clear(const JointArray& angle) noexcept {
  HandPoses poses;
  hand_.poses(angle, poses);
  return std::all_of(pair_.begin(), pair_.end(), [&](const BodyPair& pair) {
    const Pose& segment = pose_in(poses, pair.segment);
    const Pose X = pair.other == kObjectBody ? segment : pose_in(poses, pair.other).inverse() * segment;
    const PlacedSegment at{trees_[idx(pair.segment)], X, scratch_};
    const double least = stop_band(margin_).floor - kDistanceRounding;
    return distance(at, tree_of(pair.other), 2.0 * margin_) >= least;
  });
}

double DisplayedHand::Impl::way_to(const JointArray& angle) const noexcept {
  JointArray change{};
  for (std::size_t j = 0; j < kJoints; ++j) change[j] = angle[j] - angle_[j];
  double way = 0.0;
  for (int s = 0; s < kPalm; ++s) {
    const int digit = digit_of_segment(s);
    way = std::max(way, segment_speed(hand_, digit, digit_angles(change, digit), s % kSegmentsPerDigit));
  }
  return way;
}

void DisplayedHand::Impl::follow(const JointArray& gdp, double period) noexcept {
  if (!std::all_of(gdp.begin(), gdp.end(), [](double angle) { return std::isfinite(angle); })) return;
  if (!std::exchange(begun_, true) && is_clear(gdp)) jump(gdp);
  for (int step = 0; step < kMostSteps && angle_ != gdp; ++step)
    if (Step(*this, gdp).run() < Step::kStill) break;
  // A GDP that is clear and not reached is beyond a digit.
  const bool waits = way_to(gdp) > kReached && is_clear(gdp);
  waits_for_ = waits ? waits_for_ + period : 0.0;
  if (waits_for_ > kLongest) jump(gdp);
}

void DisplayedHand::Impl::jump(const JointArray& angle) noexcept {
  show(angle);
  for (BodyPair& pair : pair_) pair.clearance = {};
  waits_for_ = 0.0;
}

DisplayedHand::DisplayedHand(const HapticModel& model, double margin)
    : impl_(std::make_unique<Impl>(model, margin)) {}
DisplayedHand::DisplayedHand(DisplayedHand&&) noexcept = default;
DisplayedHand& DisplayedHand::operator=(DisplayedHand&&) noexcept = default;
DisplayedHand::~DisplayedHand() = default;

void DisplayedHand::follow(const JointArray& gdp, double period) noexcept { impl_->follow(gdp, period); }
const JointArray& DisplayedHand::angle() const noexcept { return impl_->angle(); }
const Pose& DisplayedHand::pose(int segment) const noexcept { return impl_->pose(segment); }
bool DisplayedHand::keeps_apart(int segment, int other) const noexcept {
  return impl_->keeps_apart(segment, other);
}

void DisplayedHand::draw(Snapshot& snapshot) const noexcept {
  std::array<Pose, kSegments> poses;
  for (int s = 0; s < kSegments; ++s) poses[idx(s)] = pose(s);
  draw_at(poses, snapshot);
}

void draw_at(const std::array<Pose, kSegments>& displayed, Snapshot& snapshot) noexcept {
  const auto move = [&](int segment, Vec3& point) {
    point = displayed[idx(segment)] * (snapshot.gdp_pose[idx(segment)].inverse() * point);
  };
  for (int s = 0; s < kSegments; ++s) move(s, snapshot.segment[idx(s)].point);
  for (int i = 0; i < snapshot.contact_points.count; ++i) {
    ContactPoint& at = snapshot.contact_points.point[idx(i)];
    move(at.segment, at.point);
  }
  for (int d = 0; d < kDigits; ++d) {
    bool held = false;
    for (int k = 0; k < kSegmentsPerDigit; ++k) {
      const std::size_t s = idx(segment_index(d, k));
      held = held || snapshot.hcp_pose[s].p != snapshot.gdp_pose[s].p ||
             snapshot.hcp_pose[s].R != snapshot.gdp_pose[s].R;
    }
    for (int k = 0; k < kSegmentsPerDigit && !held; ++k)
      snapshot.hcp_pose[idx(segment_index(d, k))] = displayed[idx(segment_index(d, k))];
  }
  snapshot.gdp_pose = displayed;
}

}  // namespace phalanx
