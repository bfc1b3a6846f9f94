// SPDX-License-Identifier: Apache-2.0
// The GDP and its contacts. The papers S1 and S2 name two hands: the HCP is the hand at the measured angles,
// and may penetrate the object. The GDP is the hand that is shown, and never does. See docs/architecture.md
// "The GDP, exactly" and docs/contact.md.
//
// The folder `contact` moves the GDP towards the HCP for one tick, and records where its segments touch:
// 1. advance_gdp() (below) goes digit by digit: joints up to the most distal pushing contact stay,
//    the others move. In sliding mode contacts slide instead: docs/sliding.md.
// 2. first_contact.h finds the first time of contact along the digit's path in joint space.
// 3. clearance.h, pair_search.h and proximity.h answer its questions about distance.
// 4. segment_tree.h and object_tree.h hold the meshes; src/contact/search holds the vectorised inner loops.
// 5. proximity.h and normal_fan.h compute the contact's point, direction and normal, which
//    form its ContactRecord.
#pragma once

#include <array>
#include <vector>

#include "phalanx/contact/clearance.h"
#include "phalanx/contact/contact_parameters.h"
#include "phalanx/contact/near_pairs.h"
#include "phalanx/contact/object_model.h"
#include "phalanx/contact/pair_list.h"
#include "phalanx/contact/segment_tree.h"
#include "phalanx/contact/sliding_contact.h"
#include "phalanx/core/status.h"
#include "phalanx/hand/hand_model.h"

namespace phalanx {

/// Contact of one segment with the object; at most one a segment. In sliding mode the resultant of its contact
/// points: p_S is their centre of pressure, n_c the direction of their normal forces, and `depth` and `penetration`
/// are the size of their depths' sum. Then no offset is used.
struct ContactRecord {
  bool active = false;
  Vec3 p_S = Vec3::Zero();  ///< the material point, in the segment's frame [m]
  Vec3 n_c = Vec3::Zero();  ///< unit vector from the object to the segment at closest approach, in W
  /// Direction of the force on the finger, in W: the object's normal or n_c.
  Vec3 force_normal = Vec3::Zero();
  double offset = 0.0;  ///< d0 [m]
  bool fades = false;   ///< d0 shrinks as the HCP moves, because the contact has hopped
  /// The HCP was above the contact's plane, but inside the object: the depth is counted along the way.
  bool along = false;
  bool silent = false;  ///< the digit started inside the object: no force until it has been clear
  // Values at this tick's poses:
  double penetration = 0.0;  ///< d + d0 [m]
  /// Depth d = (p_gdp - p_hcp) . n_c - d0, may be negative [m].   S1 eq. (2)
  /// If `along` is set: the greatest depth on the way from GDP to HCP, less d0.
  double depth = 0.0;
  Vec3 p_gdp = Vec3::Zero();  ///< p on the GDP segment, in W [m]
  Vec3 p_hcp = Vec3::Zero();  ///< p on the HCP segment, in W [m]
  double slid = 0.0;          ///< tangential offset between p_hcp and p_gdp [m]
  /// Sliding mode: moment about p_gdp per force, of several contact points and of spin, in W [m].
  Vec3 couple = Vec3::Zero();
};

/// Angles of one digit at the last ticks: S1's "recorded motion trajectory". Real-time: O(1), no allocation.
class AngleRing {
 public:
  static constexpr int kCapacity = 64;
  /// Adds the angles of this tick. If the ring is full, the oldest are dropped.
  void push(const DigitAngles& angle) noexcept;
  [[nodiscard]] int size() const noexcept { return size_; }
  /// Returns the angles of `age` ticks ago [rad]; 0 is the newest.
  /// @pre 0 <= age < size()
  [[nodiscard]] const DigitAngles& back(int age) const noexcept;

 private:
  std::array<DigitAngles, kCapacity> angle_{};
  int next_ = 0;
  int size_ = 0;
};

/// Makes the search tree of each segment. Set-up only.
[[nodiscard]] SegmentTrees make_segment_trees(const HandModel& hand);

/// Constant inputs of the search, by reference: they must outlive every use.
struct ContactModel {
  const HandModel& hand;
  const SegmentTrees& trees;
  const ObjectModel& object;
  const ContactParameters& parameters;
  double period = 1e-3;  ///< of a tick [s]; sliding mode divides it into substeps of 1 ms at most
};

/// State of the GDP between ticks, and the search's scratch memory.
struct GdpState {
  /// Starts at the open hand, which must be clear of the object. A state that is made in static mode may slide later,
  /// with longer searches. Set-up only.
  /// @throws std::invalid_argument if a digit of the open hand is within the margin of the object, or a
  /// segment goes through it
  explicit GdpState(const ContactModel& model);

  JointArray angle{};                   ///< q_gdp [rad]
  HandPoses poses;                      ///< at q_gdp
  JointArray hcp_angle{};               ///< q_hcp of the last tick [rad]
  std::array<bool, kDigits> started{};  ///< true once all angles of the digit came from the device
  std::array<bool, kDigits> inside{};   ///< Status::kStartInside: no force until the digit has been clear
  std::array<ContactRecord, kSegments> record;
  std::array<Clearance, kSegments> clearance;  ///< bounds for the GDP's segments
  std::array<NearPairs, kPalm> near;           ///< of the digits' segments where they last stopped
  SearchScratch scratch;                       ///< memory of one search
  PairList pairs;  ///< scratch: pairs of triangles that a digit may meet in this tick
  std::array<AngleRing, kDigits> recorded;     ///< for GdpMethod::kTrajectory
  std::array<DigitContacts, kDigits> sliding;  ///< for ContactMode::kSliding
  ContactMode mode = ContactMode::kStatic;     ///< of the last tick
};

/// Moves the GDP towards the HCP for one tick and updates the contact records.
/// @param hcp_angle  this tick's measured angles, finite [rad]
/// @param hcp        poses of the hand at `hcp_angle`
/// @param measured   per digit: true if all its angles come from the device, false if some are
/// the open hand's
/// @returns those of kStartInside, kSlid, kSearchExhausted and kTrajectoryExhausted that hold
/// Real-time: bounded, no allocation, lock, throw or I/O.
Status advance_gdp(const ContactModel& model, const JointArray& hcp_angle, const HandPoses& hcp,
                   const std::array<bool, kDigits>& measured, GdpState& state) noexcept;

}  // namespace phalanx
