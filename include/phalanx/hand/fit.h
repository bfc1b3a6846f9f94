// SPDX-License-Identifier: Apache-2.0
// Fit of a base hand to one person: lengths, breadths and meshes.
#pragma once

#include <array>
#include <optional>

#include "phalanx/hand/hand_model.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Returns the hand length of our model [m]: from the wrist's centre to the tip of the straight middle
/// finger, measured along H's -Z. The wrist's centre is the origin of H, at the wrist crease. The length is
///   -base.z - distal.z (a_0 + a_1 + a_2 + length + radius_tip)
/// with the middle finger's Denavit-Hartenberg (D-H) lengths a, and the length and tip radius of
/// its distal capsule.
[[nodiscard]] double hand_length(const HandParameters& parameters) noexcept;
/// Returns the hand breadth at the metacarpals [m]: the palm's `knuckle_breadth`.
[[nodiscard]] double hand_breadth(const HandParameters& parameters) noexcept;
/// Returns the bone length of a digit's segment, from joint to joint [m]: its D-H length a. A distal phalanx
/// counts without its soft tip.
[[nodiscard]] double segment_length(const HandParameters& parameters, int segment) noexcept;
/// Returns the breadth of a digit's segment at the middle of its bone [m]: the sum of its capsule's radii.
[[nodiscard]] double segment_breadth(const HandParameters& parameters, int segment) noexcept;

/// Measured sizes of a person's hand [m]. A missing size is estimated in proportion: fit_hand().
struct HandSize {
  struct Segment {
    std::optional<double> length;
    std::optional<double> breadth;
  };
  std::optional<double> hand_length;
  std::optional<double> hand_breadth;
  std::array<Segment, kSegments - 1> segment;
};

/// Ratios of a segment to the base hand's [-].
struct SegmentFit {
  double length = 1.0;          ///< ratio of its bone's length
  double breadth_base = 1.0;    ///< ratio of breadth and thickness at its joint, the neighbour's too
  double breadth_middle = 1.0;  ///< ratio of its breadth at the middle of the bone
  double breadth_end = 1.0;     ///< ratio of its breadth at the next segment's joint
};

/// Ratios of a hand to the base hand [-].
struct HandFit {
  double palm_length = 1.0;   ///< along H's z
  double palm_breadth = 1.0;  ///< along H's x and y
  std::array<SegmentFit, kSegments - 1> segment;
};

/// Returns the ratios that scale `base` to a hand of this size.
///   - The common ratio of lengths is that of the hand lengths. Without a hand length it is the ratio of the
///     sums of all segments' lengths, if all are stated. Else it is the common ratio of breadths, or 1.
///   - A segment's length is the stated one, else the base's times the common ratio.
///   - The palm's length is the hand length less the middle finger's, if the hand length and a segment of
///     that finger are stated. Else the palm is scaled by the common ratio.
///   - Breadths follow the same rules with the hand breadth. At a joint between two segments, both have the
///     mean of their ratios. At a digit's first joint both have the palm's, so that neighbours keep matching.
/// This function does not check whether a size is plausible; docs/hands.md has published sizes.
/// @throws std::invalid_argument if a size is not finite and above 0, or if the hand length leaves no length
/// for the palm. Set-up only.
[[nodiscard]] HandFit fit_hand(const HandParameters& base, const HandSize& size);

/// Returns the base hand's numbers, scaled. A segment's ratios scale its D-H lengths and its capsule. The
/// palm's ratios scale the palm and the digits' bases: along z by its length, along x and y by its breadth.
/// DigitCoupling::metacarpal_per_flexion is multiplied by the palm's breadth ratio over its length ratio, so that
/// the knuckle's way scales with the breadth. Directions, twists and ranges of motion stay.
/// hand_length(), hand_breadth(), segment_length() and segment_breadth() of the result equal the requested
/// sizes to 1e-12 m.
/// @throws std::invalid_argument if a segment is too short for its breadth. Set-up only.
[[nodiscard]] HandParameters fitted_parameters(const HandParameters& base, const HandFit& fit);

/// Returns the base hand's meshes, scaled by the same ratios. Input and output are right-handed. Let t be a
/// point's share of the segment's bone, 0 at the joint and 1 at the far end.
///   - Across the bone the ratio changes smoothly from the joint's (t <= 0) over the middle's to the far
///     end's (t >= 1).
///   - Along the bone the point follows a cubic in t, whose slopes at both ends are the joints' ratios.
/// So both segments at a joint are scaled by the same ratio in all directions. Where t is outside (0, 1), a
/// gap between them at any angle is at most the base hand's times that ratio.
/// The palm is scaled as its parameters are. Within 35 mm of the digits' first joints its ratio changes, and
/// within 10 mm it is the palm's breadth ratio in all directions. Set-up only.
[[nodiscard]] SegmentMeshes fitted_meshes(const HandParameters& base, const HandFit& fit,
                                          SegmentMeshes meshes);

}  // namespace phalanx
