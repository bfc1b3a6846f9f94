// SPDX-License-Identifier: Apache-2.0
// From one recording of a RunRecorder to the next.
#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "phalanx/core/reason.h"
#include "phalanx/record/run_recorder.h"

namespace phalanx {
namespace {

constexpr double kBetweenEnds = 0.5;  ///< tries of a disk that refuses the end of an earlier recording [s]

}  // namespace

// ---- any thread

std::uint64_t RunRecorder::next_recording(NextRecording next) {
  if (session_ == nullptr || !session_->settings().keep_changes)
    throw std::invalid_argument(
        "this session does not keep its changes, so that no recording can begin in it; set "
        "SessionSettings::keep_changes");
  std::optional<Prepared> before;  // freed after the lock is released
  const std::lock_guard lock(mutex_);
  before = std::exchange(asked_, std::nullopt);
  Prepared prepared;
  prepared.number = ++numbers_;
  prepared.order = std::move(next);
  asked_ = std::move(prepared);
  wanted_ = numbers_;
  return numbers_;
}

bool RunRecorder::cancel_recording(std::uint64_t number) {
  std::optional<Prepared> gone;  // freed after the lock is released
  const std::lock_guard lock(mutex_);
  if (number == 0 || wanted_ != number) return false;
  wanted_ = 0;
  gone = std::exchange(asked_, std::nullopt);
  return true;
}

// ---- the recorder's thread

/// Opens the file of the newest order, and removes that of a cancelled one.
void RunRecorder::take_order() noexcept {
  std::optional<Prepared> order;
  std::uint64_t wanted = 0;
  {
    const std::lock_guard lock(mutex_);
    order = std::exchange(asked_, std::nullopt);
    wanted = wanted_;
  }
  if (prepared_ && prepared_->number != wanted) drop_prepared();
  if (!order) return;
  prepared_ = std::move(order);
  try {
    prepared_->file =
        std::make_shared<SessionRecorder>(prepared_->order.settings, *session_, *clock_, changes_);
    if (prepared_->order.on_ready) prepared_->order.on_ready(prepared_->file->status().file);
  } catch (const std::exception& error) {
    try {
      refuse_prepared(reason(error));
    } catch (const std::bad_alloc&) {
      refuse_prepared("no memory");
    }
  }
}

/// Ends the recording before this station if the one that waits was ordered for it.
void RunRecorder::begin_station(std::uint64_t station) noexcept {
  station_ = station;
  take_order();
  if (!prepared_) return;
  try {
    changes_->fetch();
  } catch (const std::exception&) {  // whether this is its station is not known
    return refuse_prepared("no memory");
  }
  const std::uint64_t ordered_for = changes_->station_with(prepared_->number);
  if (ordered_for == station) begin_prepared(station);
  if (ordered_for != 0 && ordered_for < station) refuse_prepared("its station ended before its first step");
}

void RunRecorder::begin_prepared(std::uint64_t station) noexcept {
  if (!still_wanted(prepared_->number)) return drop_prepared();
  watch_last();
  if (recording_) {
    try {
      recording_->end_before(station);
    } catch (const std::exception& error) {
      complain([&] { return "the end of the recording lacks something: " + reason(error); });
    }
  }
  changes_->drop_through(station - 1);
  exchange_recording(prepared_->file);
  const NextRecording order = std::move(prepared_->order);
  prepared_.reset();
  try {
    if (order.watch) watch_ = order.watch(recording_->status().file);
  } catch (const std::exception& error) {
    complain([&] { return "the recording cannot be evaluated: " + reason(error); });
    try {
      if (order.on_refused) order.on_refused(reason(error));
    } catch (const std::exception&) {  // the note above remains
    }
  }
}

/// Ends the present recording. Steps go into `next` from now on. @param next  null: into none
void RunRecorder::exchange_recording(std::shared_ptr<SessionRecorder> next) noexcept {
  std::shared_ptr<SessionRecorder> before;
  {
    const std::lock_guard lock(recording_mutex_);
    before = std::exchange(recording_, std::move(next));
  }
  const RecordingWatch watch_before = std::exchange(watch_, {});
  if (!before) return;
  // Tried below and, if the disk refuses, again later; the steps go on.
  try {
    earlier_.push_back({.file = before, .watch = watch_before, .give_up = clock_->now() + kPatience});
  } catch (const std::exception&) {  // no memory to try again
    const bool whole = before->finish();
    if (!whole) complain_of_end(*before);
    watch_ended(watch_before, {}, whole);
  }
  before.reset();
  end_earlier(false);
}

/// @returns true if the recording that waits has this number; from then on it cannot be cancelled
bool RunRecorder::still_wanted(std::uint64_t number) noexcept {
  const std::lock_guard lock(mutex_);
  if (wanted_ != number) return false;
  wanted_ = 0;
  return true;
}

void RunRecorder::refuse_prepared(std::string_view why) noexcept {
  if (!prepared_) return;
  if (still_wanted(prepared_->number)) {
    complain([&] { return fmt::format("the next recording cannot begin: {}", why); });
    try {
      if (prepared_->order.on_refused) prepared_->order.on_refused(std::string(why));
    } catch (const std::exception&) {  // the note above remains
    }
  }
  drop_prepared();
}

/// Refuses what has not begun. After the thread's end.
void RunRecorder::refuse_orders(std::string_view why) noexcept {
  refuse_prepared(why);
  {
    const std::lock_guard lock(mutex_);
    prepared_ = std::exchange(asked_, std::nullopt);
  }
  refuse_prepared(why);
}

void RunRecorder::drop_prepared() noexcept {
  if (prepared_ && prepared_->file) prepared_->file->discard();
  prepared_.reset();
}

/// Tries to end the recordings before the present one. @param last  no further try follows
void RunRecorder::end_earlier(bool last) noexcept {
  for (auto each = earlier_.begin(); each != earlier_.end();) {
    const double now = clock_->now();
    if (!last && now < each->next_try) {
      ++each;
      continue;
    }
    each->next_try = now + kBetweenEnds;
    const bool whole = each->file->finish();
    if (!whole && !last && now < each->give_up) {
      ++each;
      continue;
    }
    if (!whole) complain_of_end(*each->file);
    std::filesystem::path file;
    try {
      file = each->file->status().file;
    } catch (const std::exception&) {  // no memory for its name
    }
    const RecordingWatch watch = std::move(each->watch);
    each = earlier_.erase(each);  // closes the file
    watch_ended(watch, file, whole);
  }
}

void RunRecorder::watch_ended(const RecordingWatch& watch, const std::filesystem::path& file,
                              bool whole) noexcept {
  try {
    if (watch.on_ended) watch.on_ended(file, whole);
  } catch (const std::exception& error) {
    complain([&] { return "the recording's end could not be reported: " + reason(error); });
  }
}

}  // namespace phalanx
