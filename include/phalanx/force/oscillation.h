// SPDX-License-Identifier: Apache-2.0
// Whether a force oscillates, seen from the force alone while it runs, and what is done about it.
#pragma once

#include <array>
#include <cstdint>

namespace phalanx {

enum class OscillationReaction {
  kReport,  ///< the status and the snapshot say it
  kHalve,   ///< and the law's force is halved, for all contacts
};

struct OscillationParameters {
  OscillationReaction reaction = OscillationReaction::kReport;
  double swing = 0.5;  ///< [N] > 0: a swing of the force is one that is larger than this, from peak to peak
};
inline constexpr OscillationParameters kDefaultOscillation{};

/// Watches one force. A zigzag with hysteresis: a leg counts once the force has come back by more than
/// `swing` from the extreme before it; the time from one leg's count to the next is a half-swing. It fires at
/// the
///   4th leg in a row if the three half-swings between took at most 240 ms together (6.25 Hz and up), or
///   6th leg in a row if each half-swing took at most 260 ms (2 Hz and up)
/// where the last half-swing is at least half the first of these: what dies out faster is the end of a
/// bump. So an oscillation of 8 Hz or more is seen within 200 ms of its first full swing, and a press, a
/// bump, a release or a double tap is not one. Tapping faster than that, for longer than that, looks the same
/// as an oscillation and is reported as one. A half-swing below 4 ms is noise between two steps: it starts a
/// new row, and so does a leg after more than 260 ms, which may go either way. The verdict holds until 0.5 s
/// have passed without a leg. Memory O(1); bounded and finite whatever arrives. The rule is ours.
class OscillationObserver {
 public:
  /// One step. @param force  magnitude [N]; not finite counts as 0   @param period  of a step [s] > 0
  /// @returns whether it has fired, or would have again, in this step
  /// Real-time: O(1), no allocation, lock, throw or I/O.
  bool watch(double force, double swing, double period) noexcept;

  [[nodiscard]] bool oscillating() const noexcept { return oscillating_; }
  /// From up to five half-swings of the row [Hz]; 0 while not oscillating.
  [[nodiscard]] double frequency() const noexcept { return oscillating_ ? frequency_ : 0.0; }
  /// The last full swing, from peak to peak [N]; 0 while not oscillating.
  [[nodiscard]] double swing() const noexcept { return oscillating_ ? last_swing_ : 0.0; }
  /// Nothing to remember: watching another 0 changes nothing.
  [[nodiscard]] bool idle() const noexcept {
    return leg_ == Leg::kEither && !oscillating_ && low_ == 0.0 && high_ == 0.0;
  }

 private:
  enum class Leg : std::uint8_t { kEither, kRising, kFalling };

  void forget_row(double force) noexcept;
  bool count(Leg leg, double force) noexcept;

  static constexpr std::size_t kMostHalfSwings = 5;

  std::array<double, kMostHalfSwings> half_swing_{};  ///< [s], the latest first
  std::array<double, kMostHalfSwings> swing_{};       ///< their sizes [N]
  double low_ = 0.0;    ///< falling: so far; rising: where this leg began; either: since the row ended [N]
  double high_ = 0.0;   ///< the same of the highest [N]
  double since_ = 0.0;  ///< time since the last leg was counted, while that matters [s]
  double last_swing_ = 0.0;  ///< [N]
  double frequency_ = 0.0;   ///< [Hz]
  int legs_ = 0;             ///< in the row, at most kMostHalfSwings + 1
  Leg leg_ = Leg::kEither;
  bool oscillating_ = false;
};

/// The factor on the law's force under OscillationReaction::kHalve: halved where an oscillation still swings,
/// at most once in 0.5 s, reached linearly over 200 ms. It stays for the life of the state.
class StiffnessFactor {
 public:
  /// @param swings  a leg was counted in this step for a contact that oscillates. Real-time, O(1).
  void advance(bool swings, double period) noexcept;

  /// 1 / 1024 .. 1
  [[nodiscard]] double value() const noexcept { return value_; }

 private:
  double value_ = 1.0;
  double target_ = 1.0;
  double rate_ = 0.0;     ///< of the ramp [1/s]
  double waiting_ = 0.0;  ///< until it may be halved again [s]
};

}  // namespace phalanx
