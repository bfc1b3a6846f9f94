// SPDX-License-Identifier: Apache-2.0
// The poses of a calibration, and the session that measures them step by step, without a terminal. `phalanx
// device calibrate` and the cockpit's wizard are two user interfaces of it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "phalanx/device/calibration.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// One pose of a calibration.
struct CalibrationPose {
  std::string name;                          ///< for example "fist" or "index_pip_flexion bent"
  std::string instruction;                   ///< one sentence to the wearer
  std::vector<std::optional<double>> value;  ///< value of each channel, in its unit; none: unknown
                                             ///< in this pose
};

/// Makes the poses: open hand, fist, spread, then the two end stops of each joint or digit that a channel
/// measures. Poses without a known value of any channel are left out.
///   open hand  the hand's open angles
///   fist       largest flexion of the fingers; the thumb has its end stops for that
///   spread     largest abduction; the middle finger stays where it is
///   end stops  the hand's largest and smallest angle (curl 1 and 0, splay 1 and -1)
/// @param hand  the wearer's hand; its range of motion is taken as exact. Set-up only.
[[nodiscard]] std::vector<CalibrationPose> calibration_poses(std::span<const DeviceChannel> channels,
                                                             const HandParameters& hand);

/// Session that measures the poses of an open device. It reads samples and commands nothing. For one thread
/// at a time. After the last pose all channels are fitted. From then on, each pose that is measured again or
/// skipped leads straight back to the end, and to a new fit.
class CalibrationSession {
 public:
  enum class Step : std::uint8_t { kBegin, kMeasure, kSkip, kBack, kGoTo, kAbandon, kWrite };

  /// Present state, for display.
  struct View {
    std::vector<std::string> names;  ///< names of all poses
    std::vector<bool> done;          ///< true: the pose was measured
    std::size_t pose = 0;            ///< the current pose; names.size(): the end
    std::string instruction;         ///< of the current pose; empty at the end
    bool measuring = false;
    double measured = 0.0;          ///< elapsed part of the measurement, 0 .. 1
    std::vector<std::int32_t> raw;  ///< present counts of the channels that this pose concerns; empty until a
                                    ///< sample has come
    std::vector<std::string> problems;  ///< why the last fit refused a channel, one line each
    std::vector<std::string> results;   ///< one line for each channel, once finished
    bool finished = false;  ///< all poses are done and no channel is refused: calibration() has a value
  };

  /// Makes the session for a device.
  /// @param device  open; outlives the session
  /// @param measure_for  duration of each pose's measurement [s]
  /// @throws CalibrationError if poses can calibrate none of its channels; std::invalid_argument if
  /// measure_for is not above 0
  CalibrationSession(Device& device, const HandParameters& hand, double measure_for = 1.0,
                     const CalibrationLimits& limits = {});

  /// Takes in the device's new samples, and ends a measurement whose time is over. Call it often.
  /// @param now  the process's clock [s]
  /// @throws DeviceError if the device was lost, or sent no sample while a pose was measured; the pose then
  /// stays the current one
  void update(double now);

  /// Begins measuring the current pose, without the samples that have come so far. When its time is over, the
  /// next pose becomes the current one. It does nothing at the end, or while a measurement runs.
  /// @throws as update()
  void measure(double now);
  void skip();  ///< leaves the pose unmeasured; does nothing at the end
  void back();  ///< goes back by one, also from the end; drops a running measurement
  /// Makes `pose` the current one.
  /// @throws CalibrationError if there is no such pose
  void go_to(std::size_t pose);

  [[nodiscard]] View view() const;
  [[nodiscard]] bool measuring() const noexcept { return measuring_since_.has_value(); }
  [[nodiscard]] bool at_end() const noexcept { return pose_ == poses_.size(); }
  [[nodiscard]] const std::vector<CalibrationPose>& poses() const noexcept { return poses_; }
  /// @returns the number of samples in the last measurement.
  [[nodiscard]] std::size_t samples() const noexcept { return samples_; }
  /// @returns the calibration once finished: device, serial and channels. The caller adds date and version.
  [[nodiscard]] const std::optional<Calibration>& calibration() const noexcept { return calibration_; }

 private:
  using Averages = std::vector<RawAverage>;  // one for each channel; empty: the pose was skipped

  void fetch(double now);
  void end_measurement();
  void ask_for(std::size_t pose);
  void leave_pose();
  void fit();
  [[nodiscard]] std::vector<PoseReading> readings(std::size_t channel) const;

  Device& device_;
  HandParameters hand_;
  double measure_for_;
  CalibrationLimits limits_;
  std::vector<DeviceChannel> channels_;
  std::vector<CalibrationPose> poses_;
  std::vector<Averages> averages_;
  std::size_t pose_ = 0;  ///< poses_.size(): the end
  bool walked_ = false;   ///< the end has been reached once
  double now_ = 0.0;      ///< time of the last call [s]
  std::optional<DeviceSample> newest_;
  std::optional<double> measuring_since_;  ///< [s]
  Averages measuring_;
  std::size_t samples_ = 0;
  std::vector<std::string> problems_;
  std::optional<Calibration> calibration_;
};

}  // namespace phalanx
