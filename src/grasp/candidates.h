// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>

#include "grasp/object_shape.h"
#include "phalanx/core/index.h"
#include "phalanx/core/random.h"
#include "phalanx/grasp/grasp_type.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// Candidate of a grasp: a pose of the wrist, and where the digits close to from the open hand.
struct GraspCandidate {
  Pose X_WH;
  JointArray close{};  ///< beyond the object [rad]
  /// Direction in which the wrist moves until palm or fingers touch; zero: it stays [-]
  Vec3 approach = Vec3::Zero();
  /// The contacts of the digits must look across it, not at the ends of the object; zero: in any direction [-]
  Vec3 axis = Vec3::Zero();
  double standoff = 0.0;  ///< distance from the object at which the wrist stops, above touching distance [m]
};

/// Stores the angles of one digit among those of the hand [rad].
inline void set_digit(JointArray& angle, int digit, const DigitAngles& q) noexcept {
  for (int i = 0; i < kJointsPerDigit; ++i) angle[idx(joint_index(digit, i))] = q[idx(i)];
}

/// Draws candidates for one type, hand and object.
class GraspCandidates {
 public:
  virtual ~GraspCandidates() = default;
  /// @param random  of this candidate alone
  /// @returns nothing if the object has no place for the hand, as two faces that are opposed within its reach
  [[nodiscard]] virtual std::optional<GraspCandidate> draw(Random& random) const = 0;
};

/// Candidates with the palm towards the object: cylinder, sphere, hook, disk.
[[nodiscard]] std::unique_ptr<GraspCandidates> palm_candidates(GraspType type, const HandModel& hand,
                                                               const ObjectShape& shape);
/// Candidates with two opposed places of the object between the thumb's pad and the other digits': tripod, pinch, lateral.
[[nodiscard]] std::unique_ptr<GraspCandidates> pad_candidates(GraspType type, const HandModel& hand,
                                                              const TriangleMesh& object,
                                                              const ObjectShape& shape, double friction,
                                                              Random& random);

}  // namespace phalanx
