// SPDX-License-Identifier: Apache-2.0
// The GDP: the hand that is shown, which never penetrates.                       docs/architecture.md "The
// GDP, exactly"
#pragma once

#include <array>
#include <vector>

#include "phalanx/contact/clearance.h"
#include "phalanx/contact/contact_parameters.h"
#include "phalanx/contact/object_model.h"
#include "phalanx/contact/pair_list.h"
#include "phalanx/contact/segment_tree.h"
#include "phalanx/core/status.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// A contact of one segment with the object. At most one a segment.
struct ContactRecord {
  bool active = false;
  Vec3 p_S = Vec3::Zero();  ///< the material point, in the segment's frame [m]
  Vec3 n_c = Vec3::Zero();  ///< unit vector from the object to the segment at closest approach, in W
  Vec3 force_normal =
      Vec3::Zero();     ///< direction of the force on the finger, in W: the object's normal or n_c
  double offset = 0.0;  ///< d0 [m]
  bool fades = false;   ///< d0 shrinks as the HCP moves: the contact has hopped, and its force went on
  bool along =
      false;  ///< made where the HCP was above the contact's plane, but in the object: depth along the way
  bool silent = false;  ///< its digit started inside the object: no force until it has been clear
  // What this tick's poses make of it:
  double penetration = 0.0;   ///< d + d0 [m]
  double depth = 0.0;         ///< d = (p_gdp - p_hcp) . n_c - d0, may be negative [m]      S1 eq. (2)
                              ///< `along`: the deepest place on the way from GDP to HCP, less d0
  Vec3 p_gdp = Vec3::Zero();  ///< p on the GDP segment, in W [m]
  Vec3 p_hcp = Vec3::Zero();  ///< p on the HCP segment, in W [m]
};

/// Angles of one digit at recent ticks, newest last: S1's "recorded motion trajectory".
class AngleRing {
 public:
  static constexpr int kCapacity = 64;
  void push(const DigitAngles& angle) noexcept;
  [[nodiscard]] int size() const noexcept { return size_; }
  /// 0: newest.
  [[nodiscard]] const DigitAngles& back(int age) const noexcept;

 private:
  std::array<DigitAngles, kCapacity> angle_{};
  int next_ = 0;
  int size_ = 0;
};

/// Each segment's search tree.
[[nodiscard]] SegmentTrees make_segment_trees(const HandModel& hand);

/// The constant side of the search, by reference.
struct ContactModel {
  const HandModel& hand;
  const SegmentTrees& trees;
  const ObjectModel& object;
  const ContactParameters& parameters;
};

/// What the GDP remembers from tick to tick, and its scratch memory.
struct GdpState {
  /// The open hand, clear of the object.
  /// @throws std::invalid_argument if the open hand is within the margin of the object, or the palm goes
  /// through it.
  explicit GdpState(const ContactModel& model);

  JointArray angle{};                   ///< q_gdp [rad]
  HandPoses poses;                      ///< at q_gdp
  JointArray hcp_angle{};               ///< q_hcp of the last tick [rad]
  std::array<bool, kDigits> started{};  ///< the digit has had a tick with measured angles
  std::array<bool, kDigits> inside{};   ///< start_inside: no force until the digit has once been clear
  std::array<ContactRecord, kSegments> record;
  std::array<Clearance, kSegments> clearance;  ///< of the GDP's segments
  SearchScratch scratch;                       ///< what one search writes on
  PairList pairs;                              ///< scratch: what a digit may meet in this tick
  std::array<AngleRing, kDigits> recorded;     ///< for GdpMethod::kTrajectory
};

/// Moves the GDP towards the HCP for one tick and updates the contact records.
/// @param hcp_angle  this tick's measured angles, finite [rad]
/// @param hcp        the hand at `hcp_angle`
/// @param measured   whether all angles of a digit come from the device yet, rather than from the open hand
/// @returns kStartInside, kSlid, kSearchExhausted or kTrajectoryExhausted where they hold
/// Real-time: bounded, no allocation, lock, throw or I/O.
Status advance_gdp(const ContactModel& model, const JointArray& hcp_angle, const HandPoses& hcp,
                   const std::array<bool, kDigits>& measured, GdpState& state) noexcept;

}  // namespace phalanx
