// SPDX-License-Identifier: Apache-2.0
// Planning of a grasp: where the wrist is and how the digits close, for one hand and one object.
//
// 1. Candidates are drawn from a seed: poses of the wrist about the object, and ratios in which the joints close.
// 2. Of each, the digits close along straight lines in joint space until they touch; contacts are found there.
// 3. What does not fulfil the type's conditions is dropped. The rest is ranked by wrench ball and comfort.
// 4. The best are played through step(), as a scene will play them. The first one that holds is the plan.
// See docs/grasps.md.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/contact/object_model.h"
#include "phalanx/core/constants.h"
#include "phalanx/core/math.h"
#include "phalanx/force/haptic_parameters.h"
#include "phalanx/grasp/grasp_type.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// Contact of a planned grasp, in the world W.
struct PlannedContact {
  int segment = 0;
  Vec3 point = Vec3::Zero();   ///< on the object [m]
  Vec3 normal = Vec3::Zero();  ///< unit vector from the object to the segment
  bool pad = false;            ///< the palmar side of the segment touches
};

/// A grasp that fulfils the conditions of its type.
struct PlannedGrasp {
  Pose X_WH;           ///< of the wrist
  JointArray touch{};  ///< angles at which the digits touch [rad]
  JointArray press{};  ///< angles that the measured hand goes to, beyond the touch [rad]
  std::vector<PlannedContact> contact;
  /// Radius of the largest ball around zero in the convex hull of the wrenches that the contacts can exert with normal
  /// forces that add up to 1 [-]. Torques are about the object's centre, over its greatest radius. 0 for a type that
  /// needs no force closure. Ferrari C., Canny J., "Planning optimal grasps", IEEE ICRA 1992.
  double wrench_ball = 0.0;
  /// Mean distance of the joints of the digits that take part from the nearer end of their range, over half of it: 0 at
  /// a limit, 1 in the middle [-].
  double comfort = 0.0;

  static constexpr double kPalmGap = 1e-3;      ///< of the palm, or the margin and 0.6 mm if that is more [m]
  static constexpr double kLeastBall = 5e-3;    ///< of a grasp with force closure [-]
  static constexpr double kCloseSeconds = 1.0;  ///< in which the hand goes to `press` when it is played [s]
};

/// Conditions of a grasp in the order in which candidates are checked.
enum class GraspCondition {
  kDirection,    ///< forearm and palm have the stated directions
  kOpenHand,     ///< the open hand is clear of the object
  kPalmTouches,  ///< the palm touches
  kReach,        ///< thumb and enough fingers touch
  kPads,         ///< they touch with their pads
  kAround,       ///< they touch around the axis of a cylinder or disk, not at its ends
  kOpposition,   ///< the thumb opposes the fingers
  kClosure,      ///< force closure: the wrench ball is at least kLeastBall
  kPull,         ///< a hook: two fingers hold a pull towards the fingertips
  kApart,        ///< digits and palm do not meet each other
  kMotion,       ///< played through step(), the digits touch as planned
};
inline constexpr int kGraspConditions = 11;
/// Returns a condition as a part of a sentence: "the open hand is clear of the object".
[[nodiscard]] std::string_view grasp_condition_text(GraspCondition condition) noexcept;

/// Result of a search.
struct GraspSearch {
  std::optional<PlannedGrasp> grasp;
  std::array<int, kGraspConditions> failed{};  ///< candidates by the first condition that they failed
  int candidates = 0;
  int untried = 0;  ///< candidates that fulfil all conditions but the last, which was not tried

  /// Returns the condition at which the candidates that went farthest failed.
  /// @pre there is no grasp
  [[nodiscard]] GraspCondition obstacle() const noexcept;
};

/// Greatest angle between forearm or palm and what GraspOptions states [rad].
inline constexpr double kDirectionCone = 45.0 * kDeg;

/// Options of plan_grasp().
struct GraspOptions {
  GraspType type = GraspType::kCylinder;
  std::uint64_t seed = 1;
  /// Directions in the world from the object to the elbow, and out of the palm. Those of the grasp are at most
  /// kDirectionCone off. Zero: any [-]
  Vec3 forearm = Vec3::Zero();
  Vec3 palm = Vec3::Zero();
  /// Of the scene: margin, friction, spin radius, stiffness, rate. Friction that an object has of its own, that of its
  /// first triangle, replaces contact.friction.
  HapticParameters parameters;
  /// Called from time to time, with the part of the work that is done, 0 to 1; false ends the search. May be empty.
  std::function<bool(double)> progress;
};

/// Plans a grasp. The number of candidates is fixed; equal arguments give equal bits.
/// @param hand    its pose in the world does not matter
/// @param object  in the world [m]; at least one triangle
/// @throws std::invalid_argument if the object has no triangles. Set-up only.
[[nodiscard]] GraspSearch plan_grasp(const HandModel& hand, const ObjectModel& object,
                                     const GraspOptions& options);

/// Returns the message about a search without a grasp: the condition that failed, a remedy, and the candidates by the
/// condition that they failed.
/// @pre there is no grasp
[[nodiscard]] std::string no_grasp_text(const GraspSearch& search, GraspType type, const std::string& hand);

}  // namespace phalanx
