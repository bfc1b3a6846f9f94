// SPDX-License-Identifier: Apache-2.0
// One observed step of a station: the input of exercises and scores. Plain values, without clock,
// thread or device.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "phalanx/core/math.h"
#include "phalanx/hand/angle_origin.h"
#include "phalanx/hand/joints.h"

namespace phalanx {

/// Why a step cannot be scored.
enum class ObservationFault : std::uint8_t {
  kNone,
  kNoSample,   ///< no new sample of the device has come for longer than HandObserver allows
  kFault,      ///< the station is in a fault, or the device is lost
  kGap,        ///< steps before this one are missing
  kNotFinite,  ///< an angle, force or time is not a finite number
};

/// What an exercise knows of one step. SI units, world frame W.
struct Observation {
  double time = 0.0;  ///< of the station's clock, since the exercise's first step; strictly increasing [s]
  /// Time of the sample that this step used, by the device's clock; equal in steps without a new sample. The
  /// first sample of a station has the `time` of its step. NaN: no sample has come yet [s]
  double sample_time = std::numeric_limits<double>::quiet_NaN();
  std::uint64_t tick = 0;  ///< number of the step in its station
  ObservationFault fault = ObservationFault::kNone;
  bool torque_on = false;  ///< the station is running: forces are sent to the device
  double factor = 0.0;     ///< of the station's ramps on the torques, 0 .. 1 [-]

  std::array<double, kJoints> angle{};  ///< measured hand (HCP), flexion positive [rad]
  AngleOrigins angle_origin{};          ///< only AngleOrigin::kMeasured may be scored
  std::array<Vec3, kDigits> pad = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero(),
                                   Vec3::Zero()};  ///< middle of each digit's pad on the measured hand [m]

  /// Sum of the magnitudes on each digit, as sent to the device: after ramps and all torque limits [N]
  std::array<double, kDigits> force{};
  std::array<double, kDigits>
      measured_force{};                  ///< of a force sensor at each tip; NaN: the device has none [N]
  std::array<bool, kDigits> touching{};  ///< a segment of the digit has a contact
  std::array<bool, kDigits> slips{};     ///< a segment of the digit in contact slips (SegmentSnapshot::slips)
  double stiffness = 0.0;                ///< of the force law, as commanded [N/m]
  /// Force over depth that was really sent, at the digit's deepest contact; NaN without contact or below
  /// 0.3 mm [N/m]
  std::array<double, kDigits> sent_stiffness{};
  /// Depth of that contact in the object [m]; NaN like sent_stiffness
  std::array<double, kDigits> depth{};
};

}  // namespace phalanx
