// SPDX-License-Identifier: Apache-2.0
// The station: device -> step -> device at the scene's rate, on a thread of its own.
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
#include "phalanx/station/live_model.h"
#include "phalanx/station/realtime.h"
#include "phalanx/station/safety.h"
#include "phalanx/station/station_view.h"

namespace phalanx {

struct StationOptions {
  RealtimeRequest realtime;
  bool ask_for_realtime = true;
  SafetySettings safety;
  std::vector<MotorWitness> witnesses;
};

/// @throws std::invalid_argument unless 200 .. 2000 Hz
void check_station_rate(double rate_hz);

/// Runs from start() to shut_down() or its end. The loop's thread reads the device, makes the step, passes
/// Safety, sends, and writes down; nobody can make it wait. All other functions are for other threads, any of
/// them.
class Station {
 public:
  /// @param device  open; outlives the station, which closes it at shut_down()
  /// @param clock   of the process; outlives the station
  /// @throws as HapticState, or std::invalid_argument if the rate is not 200 .. 2000 Hz
  Station(std::unique_ptr<HapticModel> model, Device& device, ChannelMap channels, StationOptions options,
          const Clock& clock);
  Station(const Station&) = delete;
  Station& operator=(const Station&) = delete;
  ~Station();

  /// Starts the loop. Torque comes by itself once the device is ready, over the start ramp.
  void start();
  /// Ramps to zero, ends the loop and closes the device. Returns when all of that is done.
  void shut_down() noexcept;

  void stop_torque() noexcept;    ///< ramps to zero and stays there; of stop and resume the last word counts
  void resume_torque() noexcept;  ///< after stop_torque()
  void reset() noexcept;          ///< after a fault; Safety::reset() decides

  /// Goes over to other stiffness and bounds in contact; after an exchange that is on its way.
  void blend_to(const BlendedParameters& parameters);
  /// Goes over to another model: torque to zero at its rate limit, exchange, start ramp. One that is still
  /// waiting is replaced. @throws std::invalid_argument if it has another rate: that needs a new station
  void replace(std::unique_ptr<LiveModel> replacement);

  [[nodiscard]] StationView view() const;
  [[nodiscard]] DeadlineStatistics deadlines() const;
  /// What the system granted to the loop; empty until the loop has begun.
  [[nodiscard]] std::optional<RealtimeGrant> grant() const;
  /// The next step's record, in order. @returns whether there was one
  [[nodiscard]] bool next_record(StepRecord& record);
  /// The report of a fault, once, after the torque has come to rest.
  [[nodiscard]] std::optional<FaultReport> take_fault_report();

  /// Makes every step longer by so much [s]: to see what an overload does. For tests and demonstrations.
  void lengthen_steps(double seconds) noexcept { extra_.store(seconds); }

 private:
  enum Request : unsigned { kStop = 1, kResume = 2, kReset = 4, kEnd = 8 };
  void loop() noexcept;
  void ask(unsigned set, unsigned clear) noexcept;
  void serve_requests(double now) noexcept;
  void reset_now(double now) noexcept;
  void exchange_model() noexcept;
  void one_step(const Wake& wake) noexcept;
  void write_down(const Wake& wake, std::size_t count, double sent_at) noexcept;
  void freeze_history() noexcept;

  Device& device_;
  const ChannelMap channels_;
  const StationOptions options_;
  const Clock& clock_;
  const double period_;

  // The loop's own.
  LiveModel model_;
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

  // Across threads.
  std::atomic<unsigned> requests_{0};
  std::atomic<bool> finish_{false};
  std::atomic<double> extra_{0.0};
  FaultEvent frozen_event_;          ///< whose history it is
  LinkStatistics frozen_link_;       ///< then
  std::atomic<bool> frozen_{false};  ///< the history belongs to take_fault_report() until that clears it
  std::atomic<LiveModel*> incoming_{nullptr};
  mutable std::atomic<LiveModel*> outgoing_{nullptr};  ///< exchanged; deleted by whoever looks next
  mutable std::mutex readers_;                         ///< among those who are not the loop
  Latest<BlendedParameters> blend_;
  mutable Latest<StationView> view_;
  mutable Latest<DeadlineStatistics> deadlines_;
  struct Records;  ///< a queue of one writer and one reader
  const std::unique_ptr<Records> records_;
  std::uint64_t records_lost_ = 0;  ///< the loop's own
  std::optional<RealtimeGrant> grant_;
  std::thread thread_;
};

}  // namespace phalanx
