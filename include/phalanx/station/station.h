// SPDX-License-Identifier: Apache-2.0
// The station: the real-time loop that turns a device's samples into torques, on a thread of its own.
//
// A step waits for its deadline (pacer.h), fetches the device's samples, and computes torques with
// step/haptic_step.h. The safety gate (safety.h) limits the torques, and the command goes to the device. The
// step then publishes a StationView and appends a StepRecord (station_view.h). Other threads read these, and
// none of them can make the loop wait.
//
// Around the loop: station_model.h makes a scene's model and settings. session.h opens and calibrates a device,
// and changes parameters, model or the whole station as a change needs; it is what programs use.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "phalanx/device/channel_map.h"
#include "phalanx/device/clock.h"
#include "phalanx/device/device.h"
#include "phalanx/device/latest.h"
#include "phalanx/station/history.h"
#include "phalanx/station/realtime.h"
#include "phalanx/station/safety.h"
#include "phalanx/station/station_view.h"
#include "phalanx/step/haptic_step.h"

namespace phalanx {

/// Settings of a Station.
struct StationOptions {
  RealtimeRequest realtime;
  bool ask_for_realtime = true;
  SafetySettings safety;
  std::vector<MotorWitness> witnesses;
};

/// Checks that a station can run at this rate.
/// @throws std::invalid_argument unless 200 .. 2000 Hz
void check_station_rate(double rate_hz);

/// Real-time loop of one device. It runs from start() to shut_down(). The loop's thread reads the device,
/// makes the step, passes the torques through Safety, sends the command, and records the step. No other
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

  /// Starts the loop. Torque comes by itself once the device is ready, over the start ramp.
  void start();
  /// Ramps to zero, ends the loop and closes the device. Returns when all of that is done.
  void shut_down() noexcept;

  void stop_torque() noexcept;    ///< ramps to zero; zero until resume_torque()
  void resume_torque() noexcept;  ///< ends stop_torque(); the later call of the two counts
  void reset() noexcept;          ///< asks to leave a fault; Safety::reset() decides

  /// Changes what may change in contact within 0.2 s: stiffness, damping, the bounds on the force's change,
  /// and the method among `none`, `smoothing` and `rise_only`. All other parameters stay as they are,
  /// whatever `parameters` has. An exchange on its way comes first.
  /// @throws std::invalid_argument if a parameter is out of its range, or the rate differs
  void change_to(const HapticParameters& parameters);
  /// Exchanges the model, or the parameters of the same model: the torque ramps to zero, the exchange
  /// follows, then the start ramp. If an earlier exchange still waits, this one takes its place. It makes the
  /// state beside the loop.
  /// @throws as HapticState, or std::invalid_argument if the rate differs: that needs a new station
  void replace(std::shared_ptr<const HapticModel> model, const HapticParameters& parameters);

  [[nodiscard]] StationView view() const;
  [[nodiscard]] DeadlineStatistics deadlines() const;
  /// @returns the scheduling that the system granted to the loop; empty until the loop has begun.
  [[nodiscard]] std::optional<RealtimeGrant> grant() const;
  /// Fetches the next step's record, in order. @returns true if there was one
  [[nodiscard]] bool next_record(StepRecord& record);
  /// @returns how many records are left for next_record(). Call it after shut_down(), and not
  /// beside that one.
  [[nodiscard]] std::size_t records_waiting() const;
  /// Fetches the report of a fault, once, after the torque has come to rest.
  [[nodiscard]] std::optional<FaultReport> take_fault_report();

 private:
  enum Request : unsigned { kStop = 1, kResume = 2, kReset = 4, kEnd = 8 };
  struct Rendering;
  struct WantedParameters {
    HapticParameters parameters;
    std::uint64_t replacement = 0;  ///< number of their Rendering
  };
  void loop() noexcept;
  void ask(unsigned set, unsigned clear) noexcept;
  void serve_requests(double now) noexcept;
  void reset_now(double now) noexcept;
  void exchange_rendering() noexcept;
  void check_rate(const HapticParameters& parameters) const;
  void one_step(const Wake& wake) noexcept;
  void write_down(const Wake& wake, std::size_t count, double sent_at) noexcept;
  void freeze_history() noexcept;

  Device& device_;
  const ChannelMap channels_;
  const StationOptions options_;
  const Clock& clock_;
  const double period_;

  // The loop's thread only.
  std::unique_ptr<Rendering> rendering_;
  Safety safety_;
  std::vector<DeviceSample> inbox_;
  DeviceSample newest_;
  bool heard_ = false;  ///< a sample has come since the beginning or the last reset
  bool late_ = false;
  bool ending_ = false;
  std::uint64_t resets_refused_ = 0;
  Sample sample_;
  Status status_ = Status::kOk;
  DeviceCommand command_;
  DeadlineStatistics statistics_;
  History<DeviceSample> samples_;
  History<StepRecord> steps_;
  bool reported_ = false;  ///< this fault's history has been frozen
  bool resume_after_exchange_ = false;
  bool wants_parameters_ = false;  ///< wanted_ has a value for which no ramp has begun

  // Shared between threads.
  std::atomic<unsigned> requests_{0};
  std::atomic<bool> finish_{false};
  FaultEvent frozen_event_;          ///< fault of the frozen history
  LinkStatistics frozen_link_;       ///< link statistics at that time
  std::atomic<bool> frozen_{false};  ///< true: the history belongs to take_fault_report(), which clears it
  std::atomic<Rendering*> incoming_{nullptr};
  mutable std::atomic<Rendering*> outgoing_{nullptr};  ///< exchanged; another thread deletes it
  mutable std::mutex readers_;                         ///< excludes the other threads from each other
  std::uint64_t replacements_ = 0;                     ///< calls of replace(); guarded by readers_
  Latest<WantedParameters> wanted_;                    ///< written under readers_
  mutable Latest<StationView> view_;
  mutable Latest<DeadlineStatistics> deadlines_;
  struct Records;  ///< queue for one writer and one reader
  const std::unique_ptr<Records> records_;
  std::uint64_t records_lost_ = 0;  ///< the loop's thread only
  std::optional<RealtimeGrant> grant_;
  std::thread thread_;
};

}  // namespace phalanx
