// SPDX-License-Identifier: Apache-2.0
// Detection of an oscillating force from its values at successive steps, and the reaction to it.
#pragma once

#include <array>
#include <cstdint>

namespace phalanx {

/// Reaction to an oscillation.
enum class OscillationReaction {
  kReport,  ///< status and snapshot report it
  kHalve,   ///< also, the law's force is halved for all contacts
};

/// Parameters of the detection and of the reaction.
struct OscillationParameters {
  OscillationReaction reaction = OscillationReaction::kReport;
  double swing = 0.5;  ///< [N] > 0: least peak-to-peak size of a swing
};

/// Oscillation detector of one force: a zigzag with hysteresis.
/// - A leg is counted when the force has returned by more than `swing` from the last extreme. The time
///   between two counts is a half-swing.
/// - The detector fires from the 4th leg in a row on, if the last three half-swings took at most 240 ms
///   together (6.25 Hz and up). From the 6th leg on it fires if each half-swing took at most 260 ms (2
///   Hz and up).
/// - It fires only if the last half-swing is at least half the size of the first of these. A faster decay is
///   the end of a bump.
/// - A half-swing below 4 ms is noise between two steps and starts a new row. So does a leg after more than
///   260 ms, in either direction.
/// - The verdict holds until 0.5 s have passed without a leg.
/// An oscillation of 8 Hz or more is thus detected within 200 ms of its first full swing. A press, bump,
/// release or double tap does not fire. Faster and longer tapping is indistinguishable from an oscillation,
/// and is reported as one.
/// Memory is O(1), and results are bounded and finite for any input. The rule is ours.
class OscillationObserver {
 public:
  /// Processes one step.
  /// @param force   magnitude [N]; a value that is not finite counts as 0
  /// @param swing   OscillationParameters::swing [N]
  /// @param period  period of a step [s] > 0
  /// @returns true if the detector fired in this step, also while it oscillates already
  /// Real-time: O(1), no allocation, lock, throw or I/O.
  bool watch(double force, double swing, double period) noexcept;

  [[nodiscard]] bool oscillating() const noexcept { return oscillating_; }
  /// Returns the frequency from up to five half-swings of the row [Hz]; 0 while not oscillating.
  [[nodiscard]] double frequency() const noexcept { return oscillating_ ? frequency_ : 0.0; }
  /// Returns the last full swing from peak to peak [N]; 0 while not oscillating.
  [[nodiscard]] double swing() const noexcept { return oscillating_ ? last_swing_ : 0.0; }
  /// @returns true if there is no history: watching another 0 changes nothing
  [[nodiscard]] bool idle() const noexcept {
    return leg_ == Leg::kEither && !oscillating_ && low_ == 0.0 && high_ == 0.0;
  }

 private:
  enum class Leg : std::uint8_t { kEither, kRising, kFalling };

  void forget_row(double force) noexcept;
  bool count(Leg leg, double force) noexcept;

  static constexpr std::size_t kMostHalfSwings = 5;

  std::array<double, kMostHalfSwings> half_swing_{};  ///< newest first [s]
  std::array<double, kMostHalfSwings> swing_{};       ///< sizes of the half-swings, newest first [N]
  /// Lowest force [N]. Falling: of this leg so far; rising: where this leg began; either: since
  /// the row ended.
  double low_ = 0.0;
  double high_ = 0.0;        ///< highest force, likewise [N]
  double since_ = 0.0;       ///< time since the last counted leg, while needed [s]
  double last_swing_ = 0.0;  ///< [N]
  double frequency_ = 0.0;   ///< [Hz]
  int legs_ = 0;             ///< in the row, at most kMostHalfSwings + 1
  Leg leg_ = Leg::kEither;
  bool oscillating_ = false;
};

/// Factor on the law's force under OscillationReaction::kHalve. It is halved when an oscillation still
/// swings, at most once in 0.5 s, and reaches its new value linearly over 200 ms. It never rises again for
/// the life of the state.
class StiffnessFactor {
 public:
  /// Advances the factor by one step of `period` [s]. Real-time: O(1).
  /// @param swings  true if a leg was counted in this step for a contact that oscillates
  void advance(bool swings, double period) noexcept;

  /// Returns the factor, in 1 / 1024 .. 1.
  [[nodiscard]] double value() const noexcept { return value_; }

 private:
  double value_ = 1.0;
  double target_ = 1.0;
  double rate_ = 0.0;     ///< slope of the ramp [1/s]
  double waiting_ = 0.0;  ///< time until the next halving is allowed [s]
};

}  // namespace phalanx
