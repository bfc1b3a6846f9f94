// SPDX-License-Identifier: Apache-2.0
// The poses of a calibration, and the session that measures them step by step, without a terminal. `phalanx
// device calibrate` and the cockpit's dialog are two user interfaces of it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "phalanx/device/calibration.h"
#include "phalanx/device/device.h"
#include "phalanx/device/stillness.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// One reference of a calibration: a pose of the jig, of the device or of a hand, with known angles.
struct CalibrationPose {
  std::string name;                          ///< for example "fist" or "index_pip_flexion largest"
  std::string instruction;                   ///< one sentence to the person who calibrates
  std::vector<std::optional<double>> value;  ///< known value of each channel, in its unit; none: unknown
  std::vector<bool> concerns;                ///< for each channel: the pose measures it
};

/// Mechanical stops of a device at one joint [rad].
struct JointStops {
  int joint = 0;
  double min = 0.0;
  double max = 0.0;
};

/// Choice of how a device is calibrated, and which of its joints.
struct CalibrationPlan {
  CalibrationMethod method = CalibrationMethod::kJig;
  std::vector<int> joints = {};        ///< only channels with one of these as leading joint; empty: all
  std::vector<JointStops> stops = {};  ///< the device's, for kStops
};

/// Makes the poses of a plan. Poses that concern no channel are left out.
///   jig         open hand, fist and spread, then two angles of each joint. The angles are the hand's: its open angles
///               and the ends of its range. They are the jig's, and can be replaced. In the fist the thumb is free; in
///               the spread hand the middle finger is.
///   stops       both stops of each angle channel whose joint has them
///   goniometer  two positions of each joint, and a third one that may be left out. No angle is known before it is
///               entered.
/// @param hand  the jig's hand; a curl or a splay is a share of its range of motion. Set-up only.
[[nodiscard]] std::vector<CalibrationPose> calibration_poses(std::span<const DeviceChannel> channels,
                                                             const HandParameters& hand,
                                                             const CalibrationPlan& plan = {});

/// Session that measures the poses of an open device. It reads samples and commands nothing. For one thread
/// at a time. After the last pose all channels are fitted. From then on, each pose that is measured again or
/// skipped leads straight back to the end, and to a new fit.
class CalibrationSession {
 public:
  /// One joint of the current pose.
  struct JointView {
    int joint = 0;                    ///< the channel's leading joint
    std::optional<double> target{};   ///< known angle [rad]; none: it is to be entered
    std::optional<double> present{};  ///< estimated angle [rad]; none: no sample has come
    bool may_enter = false;           ///< the target can be entered
  };

  /// Present state, for display.
  struct View {
    CalibrationMethod method = CalibrationMethod::kJig;
    std::vector<std::string> names;  ///< names of all poses
    std::vector<bool> done;          ///< true: the pose was measured
    std::size_t pose = 0;            ///< the current pose; names.size(): the end
    std::string instruction;         ///< of the current pose; empty at the end
    bool measuring = false;
    double measured = 0.0;          ///< elapsed part of the measurement, 0 .. 1
    std::vector<std::int32_t> raw;  ///< present counts of the channels that this pose concerns; empty until a
                                    ///< sample has come
    std::vector<JointView> joints;  ///< of the channels that this pose concerns
    double still_for = 0.0;         ///< for how long all of them have been still [s]
    JointArray hand{};              ///< the whole hand as far as it is measured, otherwise open [rad]
    JointArray target{};            ///< the same with the pose's known angles [rad]
    std::vector<std::string> problems;  ///< why the last fit refused a channel, one line each
    std::vector<std::string> results;   ///< one line for each channel, once finished
    bool finished = false;  ///< all poses are done and no channel is refused: calibration() has a value
  };

  /// Makes the session for a device.
  /// @param device  open; outlives the session
  /// @param measure_for  duration of each pose's measurement [s]
  /// @param earlier  calibration whose channels are kept where the plan measures none
  /// @throws CalibrationError if the plan concerns none of its channels, or if `earlier` is of another device;
  /// std::invalid_argument if measure_for is not above 0
  CalibrationSession(Device& device, const HandParameters& hand, double measure_for = 1.0,
                     const CalibrationLimits& limits = {}, const CalibrationPlan& plan = {},
                     std::optional<Calibration> earlier = {});

  /// Takes in the device's new samples, and ends a measurement whose time is over. Call it often.
  /// @param now  the process's clock [s]
  /// @throws DeviceError if the device was lost, or sent no sample while a pose was measured; CalibrationError if it
  /// moved while a pose was measured. The pose then stays the current one
  void update(double now);

  /// Begins measuring the current pose, without the samples that have come so far. When its time is over, the
  /// next pose becomes the current one. It does nothing at the end, or while a measurement runs.
  /// @throws as update(); CalibrationError if an angle of the pose is to be entered first
  void measure(double now);
  /// Sets the known angle of a joint in a pose, also of one that is measured already; the fit is then repeated.
  /// @throws CalibrationError if the pose does not concern the joint, or if no hand can have the angle
  void enter(std::size_t pose, int joint, double angle);
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
  void fit_channel_of(std::size_t channel, Calibration& calibration);
  void estimate();
  void check_still() const;
  [[nodiscard]] bool concerned(std::size_t channel) const { return poses_[pose_].concerns[channel]; }
  [[nodiscard]] const CalibratedChannel* earlier(std::size_t channel) const;
  [[nodiscard]] std::vector<PoseReading> readings(std::size_t channel) const;
  void view_pose(View& view) const;

  Device& device_;
  HandParameters hand_;
  double measure_for_;
  CalibrationLimits limits_;
  CalibrationMethod method_;
  std::optional<Calibration> earlier_;
  std::vector<DeviceChannel> channels_;
  std::vector<DeviceChannel> estimated_;  ///< the channels with the gains and offsets known so far
  std::vector<CalibrationPose> poses_;
  std::vector<Averages> averages_;
  std::size_t pose_ = 0;  ///< poses_.size(): the end
  bool walked_ = false;   ///< the end has been reached once
  double now_ = 0.0;      ///< time of the last call [s]
  std::optional<DeviceSample> newest_;
  std::vector<Stillness> still_;           ///< one for each channel [counts]
  std::optional<double> measuring_since_;  ///< [s]
  Averages measuring_;
  std::size_t samples_ = 0;
  std::vector<std::string> problems_;
  std::optional<Calibration> calibration_;
};

}  // namespace phalanx
