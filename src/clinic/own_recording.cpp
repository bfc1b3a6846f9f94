// SPDX-License-Identifier: Apache-2.0
// StationExercises on the owner's thread: back to the station's own recording, without a patient's key.
#include <fmt/format.h>

#include <exception>
#include <utility>

#include "clinic/station_exercises_impl.h"
#include "phalanx/core/error_text.h"

namespace phalanx {

/// Serves a station without an exercise.
void StationExercises::Impl::tick_free() {
  if (leaving_ == nullptr) {
    bool leaves = false;
    {
      const std::lock_guard lock(mutex_);
      leaves = leaves_;
    }
    // A calibration has no station, and refuses another one.
    return leaves && !session_.info()->calibrating() ? ask_own() : void();
  }
  const ChangeReports reports = reports_of(*leaving_);
  if (reports.begun) return conclude_own({});
  if (session_.info()->calibrating()) {  // it has begun meanwhile: ask again after it
    static_cast<void>(recorder_.cancel_recording(leaving_->recording));
    if (!reports_of(*leaving_).begun) leaving_.reset();
    return;
  }
  if (!reports.refused.empty() || !reports.unopened.empty())
    return conclude_own(reports.refused.empty() ? reports.unopened : reports.refused);
  if (reports.file.empty() || leaving_->ordered) return;
  StationOrder order;
  {
    const std::lock_guard lock(mutex_);
    order = own_;
  }
  order.recording = leaving_->recording;
  order_station(leaving_, order);
}

/// Asks for the station's own recording. It is made also if there is little room: the one before ends in any case.
void StationExercises::Impl::ask_own() {
  session_.stop();  // also if the station stays as it is: what it does is then perhaps not recorded
  leaving_ = std::make_shared<StationChange>();
  RecorderSettings settings = settings_.recording;
  settings.least_room = 0;
  settings.quota.reset();
  NextRecording next = reporting(leaving_, std::move(settings));
  next.watch = [change = leaving_](const std::filesystem::path&) {
    const std::lock_guard lock(change->mutex);
    change->begun = true;
    return RecordingWatch{};
  };
  try {
    leaving_->recording = recorder_.next_recording(std::move(next));
  } catch (const std::exception& error) {
    const std::lock_guard lock(leaving_->mutex);
    leaving_->refused = error_text(error);
  }
}

/// Ends the way to the station's own recording. @param why  it cannot begin; empty: it has begun
void StationExercises::Impl::conclude_own(const std::string& why) {
  if (why.empty()) {
    say(fmt::format(
            "the station is as it was before the exercises, or as it was loaded since, stopped; it is "
            "recorded, without a patient's key, in {}",
            reports_of(*leaving_).file.filename().string()),
        false);
  } else {
    static_cast<void>(recorder_.cancel_recording(leaving_->recording));
    recorder_.end_recording();
    say(fmt::format("nothing is recorded until the next exercise: the station's own recording cannot begin: "
                    "{}. Mend that, and start this program again to record without an exercise",
                    why),
        true);
  }
  leaving_.reset();
  control_.reset();  // they know the patient
  live_.reset();
  const std::lock_guard lock(mutex_);
  is_own_ = why.empty();
  leaves_ = false;
  recorded_.clear();
}

}  // namespace phalanx
