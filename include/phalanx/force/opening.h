// SPDX-License-Identifier: Apache-2.0
// What a digit that started inside an object may do: stay without force, or be opened slowly once a person has
// confirmed it. See docs/safety.md "A finger that started inside".
#pragma once

#include <cstdint>
#include <optional>

namespace phalanx {

/// Phase of a digit's opening.
enum class OpeningPhase : std::uint8_t {
  kNone,         ///< the digit did not start inside an object, or has been clear since
  kUnconfirmed,  ///< it has no force
  kConfirmed,    ///< a small force pushes it to where it is shown
  kNotFollowed,  ///< the finger did not follow that force; it has none until it is confirmed again
};

/// A digit's way out of the object in which it started.
struct DigitOpening {
  OpeningPhase phase = OpeningPhase::kNone;
  /// Greatest distance of a contact's point between the measured and the shown digit, while there is a contact [m].
  double way = 0.0;
  double force =
      0.0;  ///< upper bound of each of the digit's forces and of their sum; 0 unless kConfirmed [N]
};

/// State machine of one digit's opening. In phase kConfirmed the bound of the force is kForceRate times the tick's
/// period above the force of the last tick, and at most kMostForce. The phase becomes kNotFollowed if the way has not
/// become shorter by kLeastProgress, or by half of the confirmed way if that is less, for kPatience. It becomes
/// kUnconfirmed if the way exceeds the confirmed one by kSameWay. Real-time: O(1), no allocation, lock, throw or I/O.
class OpeningState {
 public:
  static constexpr double kMostForce = 1.0;         ///< [N]
  static constexpr double kForceRate = 1.0;         ///< [N/s]
  static constexpr double kPatience = 3.0;          ///< [s]
  static constexpr double kLeastProgress = 1.0e-3;  ///< [m]
  static constexpr double kSameWay = 5.0e-3;  ///< change of the way that a confirmation still covers [m]

  /// Advances by one tick.
  /// @param inside  the digit started inside and has not been clear since
  /// @param way     see DigitOpening [m]; empty: no contact at this tick
  /// @param sent    greatest of the digit's forces and their sum at the last tick [N]
  /// @param period  of the tick [s]
  void advance(bool inside, std::optional<double> way, double sent, double period) noexcept;
  /// Begins the opening. @returns false, with no effect, unless the phase is kUnconfirmed or kNotFollowed and the
  /// digit has had a contact
  bool confirm() noexcept;
  /// Takes a confirmation back.
  void withdraw() noexcept;
  [[nodiscard]] const DigitOpening& now() const noexcept { return now_; }

 private:
  DigitOpening now_;
  double confirmed_ = 0.0;  ///< way at the confirmation [m]
  double shortest_ = 0.0;   ///< way at the last progress [m]
  double waited_ = 0.0;     ///< since then [s]
};

}  // namespace phalanx
