// SPDX-License-Identifier: Apache-2.0
#include "run/told_openings.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string_view>

namespace phalanx {
namespace {

constexpr double kReadWithin = 1.0;  ///< a line that is younger has not been read [s]

}  // namespace

void ToldOpenings::say() {
  const StationView now = session_.view();
  if (now.state != SafetyState::kRunning) return;
  for (int digit = 0; digit < kDigits; ++digit) {
    const auto d = static_cast<std::size_t>(digit);
    const DigitOpening& opening = now.snapshot.opening[d];
    ToldOpening& told = told_[d];
    const bool waits =
        opening.phase == OpeningPhase::kUnconfirmed || opening.phase == OpeningPhase::kNotFollowed;
    if (opening.phase == told.phase && (!waits || now.running == told.running)) continue;
    const bool was_inside = told.phase != OpeningPhase::kNone;
    told = {.phase = opening.phase, .way = opening.way, .running = now.running, .time = clock_.now()};
    const std::string_view name = digit_name(digit);
    if (waits && !session_.info()->device.renders_torque) {
      console_.say(fmt::format("{} started inside the object and has no force until it has left it", name),
                   Emphasis::kWarning);
    } else if (waits) {
      console_.say(
          fmt::format(
              "{} {}; to where it is shown it is {:.0f} mm. Open the hand or, to push the digit there "
              "with at most 1 N, type: open {}",
              name,
              opening.phase == OpeningPhase::kNotFollowed
                  ? "did not follow for 3 s and has no force"
                  : "started inside the object and has no force until it has left it",
              1e3 * opening.way, name),
          Emphasis::kWarning);
    } else if (opening.phase == OpeningPhase::kNone && was_inside) {
      console_.say(fmt::format("{} has left the object", name));
    }
  }
}

std::string ToldOpenings::open(const std::string& name) {
  int digit = 0;
  while (digit < kDigits && digit_name(digit) != name) ++digit;
  if (digit == kDigits)
    throw std::invalid_argument(
        fmt::format("'{}' is no digit; type open thumb, index, middle, ring or little", name));
  ToldOpening& told = told_[static_cast<std::size_t>(digit)];
  const double way = session_.view().snapshot.opening[static_cast<std::size_t>(digit)].way;
  if (told.phase != OpeningPhase::kNone) {
    // A line may have been typed before the way was told, or be the second of two.
    if (clock_.now() - told.time < kReadWithin)
      throw std::invalid_argument(
          fmt::format("the way of {} has just been told; read it, then type open {} again", name, name));
    if (std::abs(way - told.way) > OpeningState::kSameWay) {
      const double before = told.way;
      told = {};  // it is told again
      throw std::invalid_argument(fmt::format(
          "the way of {} was {:.0f} mm and is {:.0f} mm now; wait for its line, then type open {} again",
          name, 1e3 * before, 1e3 * way, name));
    }
  }
  session_.open_digit(digit, told.way, told.running);
  return fmt::format("asked to open the digit {}, {:.0f} mm", name, 1e3 * told.way);
}

}  // namespace phalanx
