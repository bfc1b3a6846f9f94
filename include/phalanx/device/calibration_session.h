// SPDX-License-Identifier: Apache-2.0
// A calibration by poses, step by step, without a terminal: what `phalanx device calibrate` and the cockpit's
// wizard are the two faces of.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "phalanx/device/calibration.h"
#include "phalanx/device/calibration_poses.h"
#include "phalanx/device/device.h"
#include "phalanx/hand/hand_parameters.h"

namespace phalanx {

/// Goes through the poses of an open device. Reads its samples, commands nothing. One thread at a time.
/// After the last pose all channels are fitted. From then on each pose that is gone to and measured again, or
/// skipped, leads straight back to the end and to a new fit.
class CalibrationSession {
 public:
  enum class Step : std::uint8_t { kBegin, kMeasure, kSkip, kBack, kGoTo, kAbandon, kWrite };

  /// As it stands, for whoever shows it.
  struct View {
    std::vector<std::string> names;  ///< of all poses
    std::vector<bool> done;          ///< measured
    std::size_t pose = 0;            ///< the one asked for now; names.size(): the end, none is
    std::string instruction;         ///< of it; empty at the end
    bool measuring = false;
    double measured = 0.0;              ///< share of its time, 0 .. 1
    std::vector<std::int32_t> raw;      ///< of the channels that this pose is about, now [counts]; empty
                                        ///< until a sample has come
    std::vector<std::string> problems;  ///< why channels were refused by the last fit, one each
    std::vector<std::string> results;   ///< a line a channel, once finished
    bool finished = false;              ///< no pose is left, and nothing is refused: calibration() is there
  };

  /// @param device  open; outlives the session
  /// @param measure_for  of each pose [s]
  /// @throws CalibrationError if poses can calibrate nothing of it; std::invalid_argument if measure_for is
  /// not above 0
  CalibrationSession(Device& device, const HandParameters& hand, double measure_for = 1.0,
                     const CalibrationLimits& limits = {});

  /// Takes in what the device has sampled; ends a measurement whose time is over. Call it often.
  /// @param now  the process's clock [s]
  /// @throws DeviceError: the device was lost, or sent nothing while a pose was measured; the pose is then
  /// still the one asked for
  void go_on(double now);

  /// Begins with the pose asked for, without the samples that have come in so far; the next one is asked for
  /// when its time is over. Nothing at the end, or while it is being measured. @throws as go_on()
  void measure(double now);
  void skip();  ///< it stays, or becomes, unmeasured; nothing at the end
  void back();  ///< by one, also from the end; a measurement on its way is dropped
  /// @throws CalibrationError if there is no such pose
  void go_to(std::size_t pose);

  [[nodiscard]] View view() const;
  [[nodiscard]] bool measuring() const noexcept { return measuring_since_.has_value(); }
  [[nodiscard]] bool at_end() const noexcept { return pose_ == poses_.size(); }
  [[nodiscard]] const std::vector<CalibrationPose>& poses() const noexcept { return poses_; }
  /// Samples of the last measurement.
  [[nodiscard]] std::size_t samples() const noexcept { return samples_; }
  /// Once finished: device, serial and channels; date and version are the caller's.
  [[nodiscard]] const std::optional<Calibration>& calibration() const noexcept { return calibration_; }

 private:
  using Averages = std::vector<RawAverage>;  // of each channel; empty: the pose was skipped

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
  std::size_t pose_ = 0;  ///< poses_.size(): all have been asked for
  bool walked_ = false;   ///< the end has been reached once
  double now_ = 0.0;      ///< of the last call [s]
  std::optional<DeviceSample> newest_;
  std::optional<double> measuring_since_;  ///< [s]
  Averages measuring_;
  std::size_t samples_ = 0;
  std::vector<std::string> problems_;
  std::optional<Calibration> calibration_;
};

}  // namespace phalanx
