// SPDX-License-Identifier: Apache-2.0
// The station: the real-time loop that turns a device's samples into torques, on a thread of its own.
//
// A step waits for its deadline, fetches the device's samples, and computes torques with step/haptic_step.h.
// The safety gate (safety_settings.h) limits the torques, and the command goes to the device. The step then
// publishes a StationView and appends a StepRecord (station_view.h). Other threads read these, and none of
// them can make the loop wait.
//
// Around the loop: station_model.h makes a scene's model and settings. session.h opens and calibrates a device,
// and changes parameters, model or the whole station as a change needs; it is what programs use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "phalanx/device/channel_map.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/station/realtime.h"
#include "phalanx/station/safety_settings.h"
#include "phalanx/station/station_view.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// Settings of a Station.
struct StationOptions {
  RealtimeRequest realtime;             ///< for the loop's thread
  bool ask_for_realtime = true;         ///< false: the loop is an ordinary thread
  SafetySettings safety;                ///< of the safety gate
  std::vector<MotorWitness> witnesses;  ///< motors of the device; empty: no sensor is compared with a motor
  std::uint64_t number = 0;             ///< repeated in each StepRecord
};

/// Checks that a station can run at this rate.
/// @throws std::invalid_argument unless 200 .. 2000 Hz
void check_station_rate(double rate_hz);

/// Real-time loop of one device. It runs from start() to shut_down(). The loop's thread reads the device,
/// makes the step, passes the torques through the safety gate, sends the command, and records the step. No other
/// thread can make it wait. All public functions are for other threads, any of them.
class Station {
 public:
  /// Makes a station; the loop does not run yet.
  /// @param device  open; outlives the station, which closes it at shut_down()
  /// @param clock   the process's clock; outlives the station
  /// @throws as HapticState or check_watchdog(), or std::invalid_argument if the rate is not 200 .. 2000 Hz
  Station(std::shared_ptr<const HapticModel> model, const HapticParameters& parameters, Device& device,
          ChannelMap channels, StationOptions options, const Clock& clock);
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;
  ~Station();

  /// Starts the loop. Call it once: a second call ends the program. Torque comes by itself once the device is
  /// ready, over the start ramp.
  /// @throws std::system_error if no thread can be made. Not real-time.
  void start();
  /// Ramps to zero, ends the loop and closes the device. Returns when all of that is done.
  void shut_down() noexcept;

  void stop_torque() noexcept;    ///< ramps to zero; zero until resume_torque()
  void resume_torque() noexcept;  ///< ends stop_torque(); the later call of the two counts
  void reset() noexcept;          ///< asks to leave a fault; the safety gate decides
  /// Opens a digit that started inside the object, after a person's confirmation: HapticState::confirm_opening().
  /// @param running  StationView::running that the person saw. In any other period of SafetyState::kRunning the
  /// confirmation has no effect, and at the end of this one it is withdrawn
  void open_digit(int digit, std::uint64_t running) noexcept;

  /// Changes what may change in contact within 0.2 s: stiffness, damping, the bounds on the force's change,
  /// and the method among `none`, `smoothing` and `rise_only`. All other parameters stay as they are,
  /// whatever `parameters` has. An exchange on its way comes first.
  /// @throws std::invalid_argument if a parameter is out of its range, or the rate differs
  /// @param change  number for StepInput::changed
  void change_to(const HapticParameters& parameters, std::uint64_t change = 0);
  /// Exchanges the model, or the parameters of the same model: the torque ramps to zero, the exchange
  /// follows, then the start ramp. If an earlier exchange still waits, this one takes its place. It makes the
  /// state beside the loop.
  /// @throws as HapticState, or std::invalid_argument if the rate differs: that needs a new station
  /// @param change  number for StepInput::exchanged
  void replace(std::shared_ptr<const HapticModel> model, const HapticParameters& parameters,
               std::uint64_t change = 0);

  [[nodiscard]] StationView view() const;
  [[nodiscard]] DeadlineStatistics deadlines() const;
  /// @returns the scheduling that the system granted to the loop; empty until the loop has begun.
  [[nodiscard]] std::optional<RealtimeGrant> grant() const;
  /// Fetches the next step's record, in order. @returns true if there was one
  /// @param samples  receives the samples of the step
  [[nodiscard]] bool next_record(StepRecord& record, std::vector<DeviceSample>& samples);
  /// @returns how many records are left for next_record(). Call it after shut_down(), and not
  /// beside that one.
  [[nodiscard]] std::size_t records_waiting() const;
  /// Fetches the report of a fault, once, after the torque has come to rest.
  [[nodiscard]] std::optional<FaultReport> take_fault_report();

 private:
  struct Loop;  ///< the loop, and the data that it shares with other threads
  const std::unique_ptr<Loop> loop_;
};

}  // namespace phalanx
