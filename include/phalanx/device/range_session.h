// SPDX-License-Identifier: Apache-2.0
// The session that measures a patient's own range of motion, digit by digit, without a terminal. `phalanx device range`
// and the cockpit's dialog are two user interfaces of it.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/device/calibration.h"
#include "phalanx/device/device.h"
#include "phalanx/device/measured_range.h"
#include "phalanx/device/stillness.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Session that measures how far a patient moves each digit. The device is open and calibrated; it is never commanded,
/// so that its torque is zero. A joint's range is that of the positions in which it was held still: each counts with the
/// mean of its angles, so that a single noisy sample does not widen the range. For one thread at a time.
class RangeSession {
 public:
  static constexpr double kHold = 0.5;     ///< least time for which a position is held [s]
  static constexpr double kBand = 0.0524;  ///< largest motion in that time: 3 deg [rad]

  /// One joint of the current digit.
  struct JointView {
    int joint = 0;
    std::optional<double> present{};      ///< none: no sample has come [rad]
    std::optional<AngleRange> reached{};  ///< by positions that were held still [rad]
    AngleRange limit{};                   ///< the hand's or the profile's range of motion [rad]
  };

  /// Present state, for display.
  struct View {
    std::vector<int> digits;        ///< digits that the device measures
    std::vector<bool> done;         ///< for each: its range was accepted
    std::size_t digit = 0;          ///< the current one, as a position in `digits`; digits.size(): the end
    bool measuring = false;         ///< positions are being taken
    std::vector<JointView> joints;  ///< of the current digit; at the end, of all accepted digits
    double still_for = 0.0;         ///< for how long all of them have been still [s]
    JointArray hand{};              ///< the whole hand as far as it is measured, otherwise open [rad]
    bool finished = false;          ///< all digits are done or left out, and one is done: range() has a value
  };

  /// @param device    open; outlives the session
  /// @param channels  its channels with the calibration (apply_calibration())
  /// @throws CalibrationError if the device measures no angle, curl or splay
  RangeSession(Device& device, std::vector<DeviceChannel> channels, const HandParameters& hand);

  /// Takes in the device's new samples. Call it often. @throws DeviceError if the device was lost
  void update(double now);
  void measure(double now);  ///< begins to take positions of the current digit, and forgets its earlier ones
  /// Accepts what the current digit reached, and goes to the next one.
  /// @throws CalibrationError if a joint was held still in no position, or if nothing is being measured
  void accept();
  void skip();  ///< leaves the digit unmeasured: the profile's limits alone hold for it
  void back();
  /// Makes a digit the current one. @throws CalibrationError if there is no such digit
  void go_to(std::size_t digit);

  [[nodiscard]] View view() const;
  [[nodiscard]] bool at_end() const noexcept { return digit_ == digits_.size(); }
  /// @returns the range once finished: device, serial and joints. The caller adds the rest.
  [[nodiscard]] std::optional<MeasuredRange> range() const;

 private:
  struct Joint {
    int joint = 0;
    Stillness still{kBand};
    std::optional<double> present{};
    std::optional<AngleRange> reached{};
  };

  void take(const DeviceSample& sample, double now);
  void leave_digit();
  [[nodiscard]] bool of_digit(const Joint& joint, std::size_t digit) const;
  [[nodiscard]] bool is_accepted(const Joint& joint) const;

  Device& device_;
  std::vector<DeviceChannel> channels_;
  HandParameters hand_;
  std::vector<int> digits_;
  std::vector<bool> done_;
  std::vector<Joint> joints_;
  std::size_t digit_ = 0;
  bool walked_ = false;  ///< the end has been reached once
  bool measuring_ = false;
  JointArray angle_{};  ///< of the newest sample [rad]
};

}  // namespace phalanx
