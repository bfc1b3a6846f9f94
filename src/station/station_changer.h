// SPDX-License-Identifier: Apache-2.0
// The changes of a StationHost's station.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "station/calibration_wizard.h"
#include "station/change_queue.h"
#include "station/shared_station.h"

namespace phalanx {

/// Maker of the changes, for one thread at a time: the worker's, or the owner's while there is no worker. If
/// a change is refused, an exception says why, and everything is as it was. If the old station cannot be made
/// again, there is no station: SharedStation::set_unavailable().
class StationChanger {
 public:
  /// @param settings, clock, shared  outlive the changer
  StationChanger(const StationHostSettings& settings, const Clock& clock, SharedStation& shared);

  void first_station();
  /// Makes all sets at once; if that is refused, one by one. @returns the answer to each
  [[nodiscard]] std::vector<ChangeAnswer> set(std::vector<SetPart> parts);
  void load_scene(const std::string& scene);
  void set_source(HandSource source);
  void try_again();  ///< does nothing if there is a station

  void begin_wizard();
  void step_wizard(CalibrationSession::Step step, std::size_t pose);
  void abandon_wizard();
  void write_wizard();
  void serve_wizard();  ///< call it often while a calibration runs
  void close_wizard() noexcept { wizard_.end(); }

 private:
  /// Calls build_station() beside a station that runs. @throws as that; also as check_watchdog() if one runs
  [[nodiscard]] StationBuild built(const StationPlan& plan, SceneFile file) const;
  /// @returns the file of the plan's scene as it was read last; reads it if there was no station yet. Only
  /// load_scene() and a start after there was no station read it again.
  [[nodiscard]] SceneFile file_of_plan() const;
  void lay_over(const Overrides& changes);
  void set_parameters(Station& station, ChangeKind kind, StationPlan next, SceneDescription scene);
  void exchange_object(Station& station, const StationPlan& next);
  void switch_to(const StationPlan& next, SceneFile file);
  void go_back();
  void take_over(StationBuild& build);
  void refuse_while_calibrating() const;
  void leave_wizard(const StationPlan& next);
  void show_wizard();
  void hide_wizard();

  const StationHostSettings& settings_;
  const Clock& clock_;
  SharedStation& shared_;
  StationPlan plan_;
  std::optional<SceneFile> file_;  ///< the scene's file, as read for the newest station; none before
  SceneDescription scene_;         ///< of the running station, after changes on their way
  std::shared_ptr<const HapticModel> model_;  ///< of the running station, after changes on their way
  std::string patient_;  ///< SafetySettings::patient; once stated, it holds for every later station
  CalibrationWizard wizard_;
};

}  // namespace phalanx
