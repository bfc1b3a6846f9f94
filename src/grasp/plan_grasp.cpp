// SPDX-License-Identifier: Apache-2.0
#include "phalanx/grasp/plan_grasp.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "grasp/candidates.h"
#include "grasp/object_shape.h"
#include "grasp/placed_hand.h"
#include "grasp/wrench_ball.h"
#include "mesh/import/decimate.h"
#include "phalanx/contact/gdp.h"
#include "phalanx/contact/segment_motion.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/index.h"
#include "phalanx/device/motion.h"
#include "phalanx/grasp/held_grasp.h"
#include "phalanx/step/displayed_hand.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {
namespace {

constexpr int kCandidates = 1000;
constexpr int kDrawsAgain = 200;  // of a candidate whose forearm or palm has another direction than stated
constexpr int kBatch = 50;        // candidates between two calls of GraspOptions::progress
static_assert(kCandidates % kBatch == 0);
constexpr int kCoarseTriangles = 3000;  // of the object that candidates are tried on
constexpr int kFinalists = 16;          // whose wrench ball is computed exactly, and that are played
constexpr std::size_t kAtOnce = 4;      // of them, side by side
constexpr double kOpenGap = 0.3e-3;     // of the open hand above the margin [m]
constexpr double kPressDepth = 2.5e-3;  // of a contact while the hand presses [m]
constexpr double kPressWay = 12e-3;     // greatest way of a fingertip beyond the touch [m]
constexpr double kMostAlong = 0.65;     // of a contact's normal along the axis of a cylinder or disk [-]
constexpr double kLeastAside = 0.5;     // of a contact's normal out of the side of the finger [-]
constexpr double kHookPull = 0.5;       // least part of a contact's normal that holds a distal pull [-]
constexpr double kApproach = 5e-3;      // motion of the wrist at once; it doubles while nothing is near [m]
constexpr double kHandReach = 0.1;      // of the hand out of the palm's plane [m]
constexpr double kHoldSeconds = 0.2;
constexpr double kFrame = 16e-3;           // of the hand that is drawn [s]
constexpr double kMostApart = 3.0 * kDeg;  // of it and the GDP
constexpr double kPlayedDepth = 0.7e-3;    // of each digit at the end, at least [m]

/// Candidate, and the first condition that it fails; empty: all but the last are fulfilled.
struct Ranked {
  std::optional<GraspCandidate> candidate;
  PlannedGrasp grasp;
  std::vector<Wrench> wrenches;
  double score = 0.0;
  std::optional<GraspCondition> failed;
};

class Planner {
 public:
  Planner(const HandModel& hand, const ObjectModel& object, const GraspOptions& options)
      : options_(options),
        rule_(grasp_rule(options.type)),
        given_(hand),
        hand_(hand.parameters(), hand.handedness(), Pose{}, hand.meshes()),
        trees_(make_segment_trees(hand_)),
        pairs_(hand_, options.parameters.contact.margin),
        object_(object),
        friction_(object.friction(0, options.parameters.contact.friction)),
        shape_(shape_of(object.mesh())),
        coarse_(coarse(object)) {}

  GraspSearch search() {
    Random random(options_.seed);
    const bool pads = options_.type == GraspType::kTripod || options_.type == GraspType::kPinch ||
                      options_.type == GraspType::kLateral;
    const auto candidates = pads ? pad_candidates(options_.type, hand_, (coarse_ ? *coarse_ : object_).mesh(),
                                                  shape_, friction_, random)
                                 : palm_candidates(options_.type, hand_, shape_);
    GraspSearch out;
    const auto beside = [this](const ObjectModel& object) {
      return tbb::enumerable_thread_specific<PlacedHand>(
          [&] { return PlacedHand(hand_, trees_, pairs_, object, options_.parameters.contact.margin); });
    };
    auto placed = beside(coarse_ ? *coarse_ : object_);
    std::vector<Ranked> ranked;
    for (int first = 0; first < kCandidates; first += kBatch) {
      std::array<Ranked, kBatch> batch;
      tbb::parallel_for(0, kBatch, [&](int i) {
        const auto index = static_cast<std::uint64_t>(first + i);
        Random own(options_.seed * std::uint64_t{0x9e3779b97f4a7c15U} + index + 1);
        Ranked& one = batch[idx(i)];
        one.candidate = candidates->draw(own);
        for (int again = 0; again < kDrawsAgain && one.candidate && !comes_as_stated(*one.candidate); ++again)
          one.candidate = candidates->draw(own);
        one.failed = !one.candidate                     ? GraspCondition::kReach
                     : !comes_as_stated(*one.candidate) ? GraspCondition::kDirection
                                                        : check(placed.local(), one);
      });
      out.candidates += kBatch;
      for (Ranked& one : batch) {
        if (one.failed) {
          ++out.failed[static_cast<std::size_t>(*one.failed)];
        } else {
          ranked.push_back(std::move(one));
        }
      }
      if (options_.progress && !options_.progress(0.8 * out.candidates / kCandidates)) return out;
    }
    std::stable_sort(ranked.begin(), ranked.end(),
                     [](const Ranked& a, const Ranked& b) { return a.score > b.score; });
    auto exact = beside(object_);
    const auto finalists = static_cast<std::size_t>(std::min<std::ptrdiff_t>(kFinalists, std::ssize(ranked)));
    out.untried = static_cast<int>(ranked.size() - finalists);
    for (std::size_t first = 0; first < finalists && !out.grasp; first += kAtOnce) {
      const std::size_t last = std::min(finalists, first + kAtOnce);
      tbb::parallel_for(first, last, [&](std::size_t i) { compute_exactly(exact.local(), ranked[i]); });
      std::stable_sort(ranked.begin() + static_cast<std::ptrdiff_t>(first),
                       ranked.begin() + static_cast<std::ptrdiff_t>(last),
                       [](const Ranked& a, const Ranked& b) { return a.score > b.score; });
      for (std::size_t i = first; i < last && !out.grasp; ++i) {
        if (!ranked[i].failed && !holds_when_played(ranked[i].grasp))
          ranked[i].failed = GraspCondition::kMotion;
        if (ranked[i].failed) {
          ++out.failed[static_cast<std::size_t>(*ranked[i].failed)];
        } else {
          out.grasp = ranked[i].grasp;
        }
      }
      if (options_.progress && !options_.progress(0.8 + 0.2 * static_cast<double>(last) / kFinalists))
        return out;
    }
    if (options_.progress) (void)options_.progress(1.0);
    return out;
  }

 private:
  /// @returns an object of fewer triangles, on which the search is quick; none if the object has few
  static std::optional<ObjectModel> coarse(const ObjectModel& object) {
    if (object.triangle_count() <= kCoarseTriangles) return std::nullopt;
    try {
      return ObjectModel(mesh::decimate(object.mesh(), kCoarseTriangles, "grasp"));
    } catch (const std::invalid_argument&) {
      return std::nullopt;  // it cannot be simplified so far
    }
  }

  /// @returns true if forearm and palm have the stated directions
  [[nodiscard]] bool comes_as_stated(const GraspCandidate& candidate) const {
    const auto near = [](const Vec3& direction, const Vec3& stated) {
      return stated.isZero(0.0) || direction.dot(stated) >= std::cos(kDirectionCone) * stated.norm();
    };
    const Mat3& R = candidate.X_WH.R;
    return near(R.col(2), options_.forearm) && near(-R.col(1), options_.palm);
  }

  /// Closes the digits on the object itself, and computes the wrench ball.
  void compute_exactly(PlacedHand& placed, Ranked& one) const {
    if (coarse_) one.failed = check(placed, one);
    if (one.failed) return;
    one.grasp.wrench_ball = rule_.closure ? wrench_ball(one.wrenches) : 0.0;
    one.score = score_of(one.grasp, one.grasp.wrench_ball);
    if (rule_.closure && one.grasp.wrench_ball < PlannedGrasp::kLeastBall)
      one.failed = GraspCondition::kClosure;
  }

  /// Checks a candidate up to force closure. @returns the first condition that it fails
  std::optional<GraspCondition> check(PlacedHand& placed, Ranked& out) const {
    const GraspCandidate& candidate = *out.candidate;
    const HandParameters& limits = hand_.parameters();
    const JointArray& open = limits.open_angle;
    placed.put_wrist(candidate.X_WH);
    if (!candidate.approach.isZero(0.0) && !approach(candidate, placed)) return GraspCondition::kReach;
    if (!placed.is_clear(open, options_.parameters.contact.margin + 0.5 * kOpenGap))
      return GraspCondition::kOpenHand;
    PlannedGrasp& grasp = out.grasp;
    grasp = {};
    grasp.X_WH = placed.wrist();
    const double touching = placed.touching_distance();
    const double gap = palm_gap(options_.parameters.contact.margin);
    if (rule_.palm && !(placed.palm_distance(2.0 * gap) <= gap)) return GraspCondition::kPalmTouches;
    if (const auto palm = placed.contact(kPalm, open, gap); palm && rule_.palm)
      grasp.contact.push_back(*palm);

    // Digits that do not take part close too, up to the object, but their contacts do not count.
    grasp.touch = open;
    grasp.press = open;
    Vec3 thumb = Vec3::Zero();
    Vec3 fingers = Vec3::Zero();
    int fingers_touch = 0;
    bool pads = true;
    bool around = true;
    for (int digit = 0; digit < kDigits; ++digit) {
      const DigitAngles to = digit_angles(candidate.close, digit);
      const DigitAngles from = digit_angles(open, digit);
      if (to == from) continue;
      const ClosedDigit closed = placed.close(digit, from, to, rule_.wraps);
      set_digit(grasp.touch, digit, closed.angle);
      set_digit(grasp.press, digit, closed.angle);
      if (!rule_.digit[idx(digit)]) continue;
      if (!closed.any()) {
        if (digit == 0) return GraspCondition::kReach;
        continue;
      }
      if (digit > 0) ++fingers_touch;
      bool with_pad = false;
      DigitAngles rate{};
      for (std::size_t i = 0; i < rate.size(); ++i) rate[i] = to[i] - from[i];
      for (int k = 0; k < kSegmentsPerDigit; ++k) {
        const int segment = segment_index(digit, k);
        if (!closed.touches[idx(k)]) continue;
        const auto contact = placed.contact(segment, grasp.touch, touching + 2.0 * PlacedHand::kTolerance);
        if (!contact) continue;
        const bool aside = options_.type == GraspType::kLateral && digit > 0;
        pads = pads && (aside ? on_thumbs_side(placed, digit, k, closed.angle, *contact) : contact->pad);
        around = around && std::abs(contact->normal.dot(candidate.axis)) <= kMostAlong;
        with_pad = with_pad || (k == kSegmentsPerDigit - 1 && contact->pad);
        (digit == 0 ? thumb : fingers) += contact->normal;
        grasp.contact.push_back(*contact);
        set_digit(grasp.press, digit, pressed(*contact, closed, rate, grasp.X_WH));
      }
      if (rule_.pads || (options_.type == GraspType::kLateral && digit == 0)) pads = pads && with_pad;
    }
    if (fingers_touch < rule_.least_fingers) return GraspCondition::kReach;
    if (!pads) return GraspCondition::kPads;
    if (!around) return GraspCondition::kAround;
    if (rule_.digit[0] && cosine(thumb, fingers) > rule_.most_cosine) return GraspCondition::kOpposition;
    std::vector<WrenchContact> contacts;
    for (const PlannedContact& contact : grasp.contact) contacts.push_back({contact.point, -contact.normal});
    out.wrenches = contact_wrenches(contacts, friction_, options_.parameters.contact.spin_radius,
                                    shape_.centre, shape_.radius);
    const double bound = wrench_ball_bound(out.wrenches);
    if (rule_.closure && bound < PlannedGrasp::kLeastBall) return GraspCondition::kClosure;
    if (!rule_.closure && !holds_pull(grasp)) return GraspCondition::kPull;
    if (!placed.digits_are_apart(grasp.touch, options_.parameters.contact.margin))
      return GraspCondition::kApart;
    grasp.comfort = comfort(grasp.touch);
    out.score = score_of(grasp, bound);
    return std::nullopt;
  }

  /// @returns true if segment k of a finger touches with the side that looks to the thumb
  [[nodiscard]] bool on_thumbs_side(const PlacedHand& placed, int digit, int k, const DigitAngles& angle,
                                    const PlannedContact& contact) const {
    const double side = hand_.handedness() == Handedness::kRight ? 1.0 : -1.0;
    return side * placed.digit_poses(digit, angle)[idx(k)].R.col(0).dot(contact.normal) >= kLeastAside;
  }

  /// Moves the wrist along the candidate's direction until palm or fingers touch. @returns false if none does
  bool approach(const GraspCandidate& candidate, PlacedHand& placed) const {
    const JointArray& open = hand_.parameters().open_angle;
    const double stop = options_.parameters.contact.margin + kOpenGap + candidate.standoff;
    const double most = 2.0 * (shape_.radius + kHandReach);
    double cap = kApproach;  // a search is quick if it need not find a greater distance
    for (double moved = 0.0; moved < most;) {
      const double gap = placed.distance_without_thumb(open, stop + cap) - stop;
      if (gap < PlacedHand::kTolerance) return true;
      cap = gap < cap ? kApproach : 2.0 * cap;
      moved += gap;
      Pose X_WH = placed.wrist();
      X_WH.p += gap * candidate.approach;
      placed.put_wrist(X_WH);
    }
    return false;
  }

  /// Returns the angles of a digit that presses: its joints go on in the direction in which they closed, until its most
  /// distal contact would be kPressDepth deep, or its tip kPressWay further.
  DigitAngles pressed(const PlannedContact& contact, const ClosedDigit& closed, const DigitAngles& rate,
                      const Pose& X_WH) const {
    const HandParameters& limits = hand_.parameters();
    const int digit = digit_of_segment(contact.segment);
    DigitPose pose;
    hand_.digit_pose(digit, closed.angle, pose);
    const PointJacobian J =
        point_jacobian(pose, contact.segment % kSegmentsPerDigit, X_WH.inverse() * contact.point);
    const Vec3 normal = X_WH.R.transpose() * contact.normal;
    double inward = 0.0;
    for (std::size_t i = 0; i < rate.size(); ++i) inward -= normal.dot(J.linear[i]) * rate[i];
    const double speed = segment_speed(hand_, digit, rate, kSegmentsPerDigit - 1);
    DigitAngles out = closed.angle;
    if (!(speed > 0.0)) return out;
    const double share = inward > 0.0 ? std::min(kPressDepth / inward, kPressWay / speed) : kPressWay / speed;
    for (int i = 0; i < kJointsPerDigit; ++i) {
      const std::size_t j = idx(joint_index(digit, i));
      out[idx(i)] = std::clamp(out[idx(i)] + share * rate[idx(i)], limits.min_angle[j], limits.max_angle[j]);
    }
    return out;
  }

  static double cosine(const Vec3& a, const Vec3& b) {
    const double length = a.norm() * b.norm();
    return length > 0.0 ? a.dot(b) / length : 1.0;
  }

  /// @returns true if two fingers hold a pull of the object towards the fingertips
  bool holds_pull(const PlannedGrasp& grasp) const {
    std::array<bool, kDigits> holds{};
    for (const PlannedContact& contact : grasp.contact) {
      if (contact.segment == kPalm) continue;
      if (-contact.normal.dot(grasp.X_WH.R.col(2)) >= kHookPull)
        holds[idx(digit_of_segment(contact.segment))] = true;
    }
    return std::count(holds.begin(), holds.end(), true) >= 2;
  }

  double comfort(const JointArray& angle) const {
    const HandParameters& limits = hand_.parameters();
    double sum = 0.0;
    int count = 0;
    for (int j = 0; j < kJoints; ++j) {
      if (!rule_.digit[idx(digit_of_joint(j))]) continue;
      const double half = 0.5 * (limits.max_angle[idx(j)] - limits.min_angle[idx(j)]);
      if (!(half > 0.0)) continue;
      const double from_end =
          std::min(angle[idx(j)] - limits.min_angle[idx(j)], limits.max_angle[idx(j)] - angle[idx(j)]);
      sum += std::clamp(from_end / half, 0.0, 1.0);
      ++count;
    }
    return count > 0 ? sum / count : 0.0;
  }

  double score_of(const PlannedGrasp& grasp, double ball) const {
    std::array<bool, kDigits> touches{};
    for (const PlannedContact& contact : grasp.contact)
      if (contact.segment != kPalm) touches[idx(digit_of_segment(contact.segment))] = true;
    const auto digits = static_cast<double>(std::count(touches.begin(), touches.end(), true));
    return (rule_.closure ? ball : 1.0) * grasp.comfort * digits;
  }

  /// Plays the grasp as a scene does: straight in joint space from the open hand to the pressing one.
  bool holds_when_played(const PlannedGrasp& grasp) const {
    const HapticModel model(HandModel(given_.parameters(), given_.handedness(), grasp.X_WH, given_.meshes()),
                            object_);
    std::optional<HapticState> state;
    try {
      state.emplace(model, options_.parameters);
    } catch (const std::invalid_argument&) {
      return false;
    }
    const double period = options_.parameters.period();
    const int ticks = static_cast<int>(std::ceil((PlannedGrasp::kCloseSeconds + kHoldSeconds) / period));
    const int every = std::max(1, static_cast<int>(kFrame / period));
    const JointArray& open = hand_.parameters().open_angle;
    DisplayedHand shown(model, options_.parameters.contact.margin);
    for (int i = 0; i <= ticks; ++i) {
      Sample sample;
      sample.time_s = i * period;
      const double share = minimum_jerk(sample.time_s / PlannedGrasp::kCloseSeconds);
      for (std::size_t j = 0; j < open.size(); ++j)
        sample.angle[j] = open[j] + share * (grasp.press[j] - open[j]);
      const Status status = step(model, options_.parameters, sample, *state);
      if (has(status, Status::kStartInside) || has(status, Status::kSlid)) return false;
      if (i % every == 0 || i == ticks) shown.follow(state->snapshot().gdp_angle, every * period);
    }
    const Snapshot& end = state->snapshot();
    if (goes_through_itself(shown, end)) return false;
    std::array<bool, kDigits> planned{};
    std::array<bool, kDigits> touches{};
    bool pads = true;
    for (const PlannedContact& contact : grasp.contact)
      if (contact.segment != kPalm) planned[idx(digit_of_segment(contact.segment))] = true;
    for (int segment = 0; segment < kPalm; ++segment) {
      const SegmentSnapshot& now = end.segment[idx(segment)];
      if (!now.contact || now.depth < kPlayedDepth) continue;
      const int digit = digit_of_segment(segment);
      touches[idx(digit)] = true;
      const bool aside = options_.type == GraspType::kLateral && digit > 0;
      pads = pads && (aside || end.gdp_pose[idx(segment)].R.col(1).dot(now.normal) > 0.0);
    }
    for (std::size_t digit = 0; digit < planned.size(); ++digit)
      if (planned[digit] && !touches[digit]) return false;
    return pads && (!rule_.closure ||
                    held_grasp(model, options_.parameters, end).closure_margin >= PlannedGrasp::kLeastBall);
  }

  /// @returns true if the hand that is drawn could not follow the GDP, because digits are in each other's way
  bool goes_through_itself(const DisplayedHand& shown, const Snapshot& end) const {
    for (std::size_t j = 0; j < end.gdp_angle.size(); ++j)
      if (rule_.digit[idx(digit_of_joint(static_cast<int>(j)))] &&
          std::abs(shown.angle()[j] - end.gdp_angle[j]) > kMostApart)
        return true;
    return false;
  }

  const GraspOptions& options_;
  const GraspRule& rule_;
  const HandModel& given_;
  HandModel hand_;
  SegmentTrees trees_;
  SegmentPairs pairs_;
  const ObjectModel& object_;
  double friction_;
  ObjectShape shape_;
  std::optional<ObjectModel> coarse_;  ///< searched in place of the object
};

}  // namespace

std::string_view grasp_condition_text(GraspCondition condition) noexcept {
  switch (condition) {
    case GraspCondition::kDirection:
      return "forearm and palm have the stated directions";
    case GraspCondition::kOpenHand:
      return "the open hand is clear of the object";
    case GraspCondition::kPalmTouches:
      return "the palm touches the object";
    case GraspCondition::kReach:
      return "the digits reach the object";
    case GraspCondition::kPads:
      return "the digits touch with their pads";
    case GraspCondition::kAround:
      return "the digits touch around the object's axis, not at its ends";
    case GraspCondition::kOpposition:
      return "the thumb opposes the fingers";
    case GraspCondition::kClosure:
      return "the contacts have force closure";
    case GraspCondition::kPull:
      return "two fingers hold a pull towards the fingertips";
    case GraspCondition::kApart:
      return "the digits do not meet each other";
    case GraspCondition::kMotion:
      return "the digits touch as planned when the motion is played";
  }
  return "";
}

GraspCondition GraspSearch::obstacle() const noexcept {
  for (int i = kGraspConditions - 1; i > 0; --i)
    if (failed[idx(i)] > 0) return static_cast<GraspCondition>(i);
  return GraspCondition::kDirection;
}

GraspSearch plan_grasp(const HandModel& hand, const ObjectModel& object, const GraspOptions& options) {
  if (object.triangle_count() == 0)
    throw std::invalid_argument("plan_grasp: the object has no triangles; name one");
  return Planner(hand, object, options).search();
}

std::string no_grasp_text(const GraspSearch& search, GraspType type, const std::string& hand) {
  const GraspCondition obstacle = search.obstacle();
  const int outside = search.failed[idx(static_cast<int>(GraspCondition::kDirection))];
  const std::string_view remedy =
      2 * outside > search.candidates
          ? "leave out or change the directions of forearm and palm (grasp.forearm, grasp.palm)"
      : obstacle == GraspCondition::kReach   ? "choose a smaller or larger object, or another type"
      : obstacle == GraspCondition::kClosure ? "raise contact.friction, or choose another type"
                                             : "choose another type, size or seed";
  std::string counts;
  for (int i = 0; i < kGraspConditions; ++i)
    if (search.failed[idx(i)] > 0)
      counts += fmt::format("{}{}: {}", counts.empty() ? "" : "; ",
                            grasp_condition_text(static_cast<GraspCondition>(i)), search.failed[idx(i)]);
  return fmt::format(
      "no {} grasp by {}: of {} candidates none fulfils \"{}\"; {}. Candidates by the condition that failed: "
      "{}",
      grasp_rule(type).name, hand, search.candidates, grasp_condition_text(obstacle), remedy, counts);
}

}  // namespace phalanx
