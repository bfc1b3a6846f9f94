// SPDX-License-Identifier: Apache-2.0
// StationExercises on the owner's thread: the end of an exercise, its recording and its result.
#include <fmt/format.h>

#include <exception>
#include <utility>

#include "clinic/station_exercises_impl.h"
#include "phalanx/core/error_text.h"
#include "phalanx/core/nice_thread.h"

namespace phalanx {
namespace {

constexpr double kBetweenCloses = 10.0;  // tries to end the recording of an exercise [s]

}  // namespace

void StationExercises::Impl::begin_closing() {
  say(fmt::format("the exercise {} has ended; its result is being made", live_->start().exercise.name),
      false);
  const std::lock_guard lock(mutex_);
  stage_ = Stage::kClosing;
  inputs_.clear();
}

void StationExercises::Impl::tick_closing() {
  if (!session_.held_stopped()) session_.stop();
  std::optional<EndedRecording> ended;
  {
    const std::lock_guard lock(carried_->mutex);
    ended = carried_->ended;
  }
  if (ended && kept_ == nullptr) keep();
  if (kept_ != nullptr) {
    std::optional<KeptExercise> made;
    {
      const std::lock_guard lock(kept_->mutex);
      made = kept_->made;
    }
    if (!made) return;
    keeper_.join();
    return conclude(std::move(made->result), made->trouble);
  }
  if (closing_ == nullptr) return ask_closing();
  const ChangeReports reports = reports_of(*closing_);
  if (reports.begun) set_recorded();
  if (reports.begun && !unrecorded_.empty()) return conclude(std::nullopt, std::exchange(unrecorded_, {}));
  if (reports.begun) return;
  if (!reports.refused.empty() || !reports.unopened.empty()) return refused_closing(reports);
  if (!reports.file.empty() && !closing_->ordered)
    order_station(closing_, prepared_->station(std::nullopt, closing_->recording));
}

/// Without a station no other recording can follow, and no step comes: the recording ends without a next one. Else it is
/// tried again.
void StationExercises::Impl::refused_closing(const ChangeReports& reports) {
  static_cast<void>(recorder_.cancel_recording(closing_->recording));
  closing_.reset();
  next_close_ = session_.now() + kBetweenCloses;
  if (!session_.info()->running) {
    recorder_.end_recording();
    say("there is no station, and nothing is recorded until the next exercise", true);
    if (!unrecorded_.empty()) conclude(std::nullopt, std::exchange(unrecorded_, {}));
    return;
  }
  const std::string why = fmt::format(
      "the recording of the exercise cannot be ended yet: {}. It is tried again each {} s, and at the "
      "program's end",
      reports.refused.empty() ? reports.unopened : reports.refused, kBetweenCloses);
  say(why, true);
  const std::lock_guard lock(mutex_);
  trouble_ = why;
}

/// Asks for the recording that follows that of the exercise. It is made also if there is little room: without it the
/// exercise's own has no end and no result.
void StationExercises::Impl::ask_closing() {
  if (session_.now() < next_close_) return;
  closing_ = std::make_shared<StationChange>();
  RecorderSettings settings = encrypted();
  settings.least_room = 0;
  settings.quota.reset();
  NextRecording next = reporting(closing_, std::move(settings));
  next.watch = [change = closing_, use = use_of_key()](const std::filesystem::path&) {
    const std::lock_guard lock(change->mutex);
    change->begun = true;
    RecordingWatch watch;
    watch.on_ended = [use](const std::filesystem::path&, bool) {};  // until then the key is in use
    return watch;
  };
  try {
    closing_->recording = recorder_.next_recording(std::move(next));
  } catch (const std::exception& error) {
    const std::lock_guard lock(closing_->mutex);
    closing_->refused = error_text(error);
  }
}

std::optional<UnscoredExercise> StationExercises::Impl::unscored() const {
  if (live_ == nullptr) return std::nullopt;
  return UnscoredExercise{.start = live_->start(), .result = live_->result(), .began = began_utc_};
}

/// States that the result waits for the registry. Any thread. @returns false if the program ends
bool StationExercises::Impl::tries_again(const std::string& why) {
  if (ending_) return false;
  const std::string waits = fmt::format("the result waits for the registry: {}", why);
  bool is_new = false;
  {
    const std::lock_guard lock(mutex_);
    is_new = trouble_ != waits;
    trouble_ = waits;
  }
  if (is_new) say(waits, true);
  return true;
}

/// Starts the thread that makes the result.
void StationExercises::Impl::keep() {
  EndedRecording recording;
  {
    const std::lock_guard lock(carried_->mutex);
    recording = *carried_->ended;
  }
  auto shared = std::make_shared<Kept>();
  const auto work = [kept = shared, self = shared_from_this(), prepared = prepared_, recording,
                     done = unscored()] {
    KeptExercise made;
    try {
      made = keep_exercise(*self->registry_, *prepared, recording, done,
                           [&self](const std::string& why) { return self->tries_again(why); });
    } catch (const std::exception& error) {  // no memory
      made.trouble = error_text(error);
    }
    const std::lock_guard lock(kept->mutex);
    kept->made = std::move(made);
  };
  try {
    keeper_ = start_nice_thread("phalanx-result", work);
    kept_ = std::move(shared);
  } catch (const std::exception&) {  // no thread is left: the next tick tries again
  }
}

void StationExercises::Impl::conclude(std::optional<ExerciseResult> result, const std::string& trouble) {
  if (!trouble.empty()) say(trouble, true);
  if (result) say("the result of the exercise is kept in the registry", false);
  control_.reset();
  opening_.reset();
  closing_.reset();
  kept_.reset();
  std::shared_ptr<const KeyUse> gone;  // closes its file after the lock: the file system may not answer
  const std::lock_guard lock(mutex_);
  stage_ = Stage::kEnded;
  trouble_ = trouble;
  result_ = std::move(result);
  gone.swap(use_);
  forces_off_ = false;
  inputs_.clear();
}

void StationExercises::Impl::end() {
  ending_ = true;
  {
    const std::lock_guard one(begin_mutex_);
    const std::lock_guard lock(mutex_);
    if (std::exchange(ended_, true)) return;
    stops_ = session_.stops();
  }
  if (entry_.joinable()) entry_.join();
  const Stage stage = stage_now();
  if (stage == Stage::kOpening) {
    conclude(std::nullopt, "the program has ended before the exercise began");
  } else if (stage == Stage::kRunning || stage == Stage::kClosing) {
    std::optional<EndedRecording> ended;
    {
      const std::lock_guard lock(carried_->mutex);
      ended = carried_->ended;
    }
    if (!unrecorded_.empty()) {
      conclude(std::nullopt, std::exchange(unrecorded_, {}));
    } else if (kept_ != nullptr) {
      keeper_.join();
      KeptExercise made = kept_->made.value_or(KeptExercise{});
      conclude(std::move(made.result), made.trouble);
    } else if (ended) {
      KeptExercise made = keep_exercise(*registry_, *prepared_, *ended, unscored(), {});
      conclude(std::move(made.result), made.trouble);
    } else {
      conclude(std::nullopt, "the recording of the exercise has no end");
    }
  }
  say_words();
}

}  // namespace phalanx
