// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <memory>

#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// The hand that is drawn. The GDP never penetrates the object, but its digits may go through each other and the palm,
/// because forces must not depend on that. The displayed hand follows the GDP. On its way no pair of triangles of two
/// bodies that are kept apart comes nearer than the margin less 10 nm. Kept apart are the segments of different digits,
/// the palm and the object, except the roots of digits: keeps_apart(). All digits move together, so that none has
/// precedence. No force depends on this hand. See docs/contact.md "The displayed hand".
class DisplayedHand {
 public:
  /// Begins at the open hand. Set-up only.
  /// @param model   must outlive the object; its open hand is clear of the object
  /// @param margin  least distance of two bodies [m]
  DisplayedHand(const HapticModel& model, double margin);
  DisplayedHand(DisplayedHand&&) noexcept;
  DisplayedHand& operator=(DisplayedHand&&) noexcept;
  DisplayedHand(const DisplayedHand&) = delete;
  DisplayedHand& operator=(const DisplayedHand&) = delete;
  ~DisplayedHand();

  /// Follows the GDP: at once where nothing can be met on the way, else by up to kMostSteps steps of motions in which no
  /// point moves farther than kMostWay. Two GDPs are shown without a way, if their digits are clear of each other: that of
  /// the first call, and one that has been clear and not reached for kLongest.
  /// @param gdp     angles of the GDP [rad]; does nothing if one is not finite
  /// @param period  since the last call [s]
  /// Bounded, without allocation, lock, throw or I/O. It takes up to some milliseconds: not for the loop.
  void follow(const JointArray& gdp, double period) noexcept;

  [[nodiscard]] const JointArray& angle() const noexcept;  ///< [rad]
  /// Returns the pose X_WS of a segment.
  [[nodiscard]] const Pose& pose(int segment) const noexcept;
  /// draw_at() with this hand's poses. Real-time safe.
  void draw(Snapshot& snapshot) const noexcept;
  /// @returns true if two segments are kept apart. Segments of one digit are not, nor the first segments of two
  /// digits, nor those that touch or overlap at the open hand: roots of digits and the palm.
  [[nodiscard]] bool keeps_apart(int segment, int other) const noexcept;

  static constexpr double kMostWay = 2e-3;     ///< of a point in a motion [m]
  static constexpr int kMostSteps = 10;        ///< of a call
  static constexpr double kLongest = 0.5;      ///< [s]
  static constexpr double kLeastGap = 0.2e-3;  ///< of segments that are kept apart, at the open hand [m]

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

/// Replaces the poses of the GDP by those of the hand that is drawn, and moves the points of contacts and forces along
/// with their segments. Directions and sizes stay. Where no object keeps a digit from where it is measured, its measured
/// poses are replaced, too: the measured hand is drawn only where an object is in its way. Real-time safe.
/// @param displayed  DisplayedHand::pose() of each segment
void draw_at(const std::array<Pose, kSegments>& displayed, Snapshot& snapshot) noexcept;

}  // namespace phalanx
