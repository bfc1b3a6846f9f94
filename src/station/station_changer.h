// SPDX-License-Identifier: Apache-2.0
// How a StationHost's station changes.
#pragma once

#include <string>
#include <vector>

#include "station/calibration_wizard.h"
#include "station/change_queue.h"
#include "station/shared_station.h"

namespace phalanx {

/// One thread at a time: the worker's, and the owner's while there is none. Where something is refused, an
/// exception says why and all is as it was; where that cannot be made again either, there is no station:
/// SharedStation::lose().
class StationChanger {
 public:
  /// @param settings, clock, shared  outlive it
  StationChanger(const StationHostSettings& settings, const Clock& clock, SharedStation& shared);

  void first_station();
  /// All at once; if that is refused, one by one. @returns what became of each
  [[nodiscard]] std::vector<ChangeAnswer> set(std::vector<SetPart> parts);
  void load_scene(const std::string& scene);
  void set_source(HandSource source);
  void try_again();  ///< nothing if there is a station

  void begin_wizard();
  void step_wizard(CalibrationSession::Step step, std::size_t pose);
  void abandon_wizard();
  void write_wizard();
  void serve_wizard();  ///< call it often
  void close_wizard() noexcept { wizard_.end(); }

 private:
  /// build_station(), beside a station that runs. @throws as that
  [[nodiscard]] StationBuild built(const StationPlan& plan) const;
  void lay_over(const Overrides& changes);
  [[nodiscard]] ChangeKind needed(const Overrides& changes) const;
  void blend(Station& station, StationPlan next);
  void exchange(Station& station, StationPlan next, bool moves_object);
  void switch_to(const StationPlan& next);
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
  CalibrationWizard wizard_;
};

}  // namespace phalanx
