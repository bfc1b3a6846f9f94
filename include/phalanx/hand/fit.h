// SPDX-License-Identifier: Apache-2.0
// One person's hand out of a base hand: lengths, breadths, and the meshes that go with them.
#pragma once

#include <array>
#include <optional>

#include "phalanx/hand/hand_model.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Hand length of our model [m]: from the wrist's centre (the origin of H, at the wrist crease) to the tip of
/// the straight middle finger, measured along H's -Z:
///   -base.z - distal.z (a_0 + a_1 + a_2 + length + radius_tip)
/// of the middle finger, with the D-H lengths a, and the distal capsule's length and tip.
[[nodiscard]] double hand_length(const HandParameters& parameters) noexcept;
/// Hand breadth at the metacarpals [m]: the palm's `knuckle_breadth`.
[[nodiscard]] double hand_breadth(const HandParameters& parameters) noexcept;
/// Bone length of a digit's segment, joint to joint; a distal phalanx without its soft tip [m]: its D-H a.
[[nodiscard]] double segment_length(const HandParameters& parameters, int segment) noexcept;
/// Breadth of a digit's segment at the middle of its bone [m]: the sum of its capsule's radii.
[[nodiscard]] double segment_breadth(const HandParameters& parameters, int segment) noexcept;

/// What is known of a person's hand [m]. What is not stated follows in proportion.
struct HandSize {
  struct Segment {
    std::optional<double> length;
    std::optional<double> breadth;
  };
  std::optional<double> hand_length;
  std::optional<double> hand_breadth;
  std::array<Segment, kSegments - 1> segment;
};

/// How a segment differs from the base hand's [-].
struct SegmentFit {
  double length = 1.0;          ///< its bone's length
  double breadth_base = 1.0;    ///< its breadth and thickness at its joint; the neighbour's there too
  double breadth_middle = 1.0;  ///< in the middle of the bone
  double breadth_end = 1.0;     ///< at the far end of the bone; the next segment's at its joint
};

/// How a hand differs from the base hand.
struct HandFit {
  double palm_length = 1.0;   ///< along H's z
  double palm_breadth = 1.0;  ///< along H's x and y
  std::array<SegmentFit, kSegments - 1> segment;
};

/// The ratios that make `base` a hand of this size.
///   - A segment's length: the stated one; else the base's times the common ratio. That is the ratio of the
///     hand lengths; without one, of the segments' lengths, summed, if all are stated; else that of the
///     breadths; else 1.
///   - The palm's length: what the hand length leaves for it beside the middle finger; else by the common
///   ratio.
///   - Breadths alike, with the hand's breadth. At a joint both segments have the mean of their two ratios,
///   at a
///     digit's first joint the palm's, so that neighbours keep matching.
/// @throws std::invalid_argument for a size that is not finite and above 0, or a hand length that leaves
/// nothing for the palm. Whether a size is plausible is for anthropometry.h to say. Set-up only.
[[nodiscard]] HandFit fit_hand(const HandParameters& base, const HandSize& size);

/// The base hand's numbers, scaled: D-H lengths and capsules by their segment; bases of the digits and the
/// palm along z by the palm's length, along x and y by its breadth. Directions, twists and ranges of motion
/// stay. hand_length(), hand_breadth(), segment_length() and segment_breadth() of the result are those that
/// were asked for, to 1e-12 m.
/// @throws std::invalid_argument if a segment is too short for its breadth.
[[nodiscard]] HandParameters fitted_parameters(const HandParameters& base, const HandFit& fit);

/// The base hand's meshes, scaled likewise; right-handed in, right-handed out. A point of a segment at the
/// share t of the bone moves across it by a ratio that goes smoothly from that of its joint (t <= 0) through
/// that of the middle to that of the far end (t >= 1), and along it by a cubic in t whose slopes at both ends
/// are the joints' ratios. So each joint's surroundings are scaled alike in all directions and alike for both
/// segments, and a gap between them at any angle is at most the base hand's times that ratio where t is
/// outside (0, 1). The palm is scaled as its parameters are, and turns to its breadth's ratio in all
/// directions within 10 to 35 mm of the digits' first joints.
[[nodiscard]] SegmentMeshes fitted_meshes(const HandParameters& base, const HandFit& fit,
                                          SegmentMeshes meshes);

}  // namespace phalanx
