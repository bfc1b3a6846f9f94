// SPDX-License-Identifier: Apache-2.0
// The thread that makes the changes of a Session.
#pragma once

#include <optional>
#include <string>
#include <thread>

#include "station/calibration_wizard.h"
#include "station/command_queue.h"
#include "station/session_state.h"

namespace phalanx {

/// Worker of a Session. One thread takes the commands from the queue, makes them, and hands the answers back.
/// If a change is refused, everything is as it was. If the old station cannot be made again, there is no
/// station: SessionState::set_unavailable(). No failure ends the thread; without memory a change is refused.
class SessionWorker {
 public:
  /// Makes the first station, then starts the thread.
  /// @param settings, clock, state, queue, imports  outlive the worker
  /// @throws as Session
  SessionWorker(const SessionSettings& settings, const Clock& clock, SessionState& state, CommandQueue& queue,
                ImportCache& imports);
  SessionWorker(const SessionWorker&) = delete;
  SessionWorker& operator=(const SessionWorker&) = delete;
  ~SessionWorker();  ///< end()

  /// Ends the queue, waits for the change being made, and closes the device of a calibration.
  void end() noexcept;

 private:
  void run() noexcept;
  /// Publishes the command that is being made. @param command  null: none
  /// @returns false if there is no memory for it
  [[nodiscard]] bool publish_busy(const Command* command) noexcept;
  void make(Command& command) noexcept;
  [[nodiscard]] bool make_together(Command& command) noexcept;

  // Each makes one action. They throw if it is refused.
  void apply(const SetValues& set);
  void apply(const LoadScene& load);
  void apply(const SelectSource& select);
  void apply(const StationOrder& order);
  void apply(const WizardStep& step);
  void apply(const MakeStation& again);

  /// Calls build_station() beside a station that runs. @throws as that; also as check_watchdog() if one runs
  /// @param read  the file's scene with the plan's overrides
  [[nodiscard]] StationBuild built(const StationPlan& plan, SceneFile file, SceneWithValues read) const;
  /// The same; parses the file's text.
  [[nodiscard]] StationBuild built(const StationPlan& plan, SceneFile file) const;
  /// @returns the file of the plan's scene as it was read last; reads it if there was no station yet. Only
  /// LoadScene and a start after there was no station read it again.
  [[nodiscard]] SceneFile file_of_plan() const;
  void exchange_object(Station& station, StationBuild build);
  /// @param recording  StationOrder::recording
  void switch_to(StationBuild build, std::uint64_t recording = 0);
  void go_back();
  /// Opens the device, publishes and starts the station, and keeps its parts.
  /// @throws as make_station() and SessionState::begin(); the plan and the parts of the last station are
  /// then still kept
  void take_over(StationBuild& build, std::uint64_t recording = 0);

  /// Keeps a change for recordings, before it is made. @returns its number
  std::uint64_t keep_change(const std::string& scene, const Overrides& values,
                            std::shared_ptr<const SessionGeometry> geometry);

  void refuse_source(HandSource source) const;
  void refuse_while_calibrating() const;
  void begin_wizard(const WizardStep& step);
  void refuse_range_here() const;
  void write_wizard();
  void drop_range();
  void leave_wizard();
  void update_wizard() noexcept;
  void publish_wizard();

  const SessionSettings& settings_;
  const Clock& clock_;
  SessionState& state_;
  CommandQueue& queue_;
  ImportCache& imports_;
  StationPlan plan_;
  std::optional<SceneFile> file_;  ///< the scene's file, as read for the newest station; none before
  Overrides planned_;              ///< StationBuild::planned of the last build
  SceneDescription scene_;         ///< of the running station, after changes on their way
  std::shared_ptr<const HapticModel> model_;  ///< of the running station, after changes on their way
  std::string patient_;         ///< SafetySettings::patient; once stated, it holds for every later station
  std::uint64_t stations_ = 0;  ///< StationOptions::number of the newest station
  std::uint64_t changes_ = 0;   ///< SessionChange::number of the newest change
  std::uint64_t model_change_ = 0;  ///< number of the change that model_ came with; 0: with the station
  CalibrationWizard wizard_;
  std::thread thread_;
};

}  // namespace phalanx
