// SPDX-License-Identifier: Apache-2.0
// StationExercises: what any thread may ask. exercise_stages.cpp has the owner's thread.
#include "phalanx/clinic/station_exercises.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <thread>
#include <utility>

#include "clinic/station_exercises_impl.h"
#include "phalanx/clinic/exercise_patient.h"
#include "phalanx/core/index.h"

namespace phalanx {
namespace {

constexpr std::size_t kMostInputs = 64;                        // that wait for the owner's thread
constexpr std::size_t kMostMessages = 64;                      // likewise
constexpr std::chrono::seconds kLongestRelease{15};            // of release_key()
constexpr std::chrono::milliseconds kBetweenReleaseLooks{20};  // of its thread
constexpr const char* kNoneRuns = "no exercise runs; begin one on the page of a patient";

double system_utc() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

StationExercisesSettings with_clock(StationExercisesSettings settings) {
  if (!settings.utc) settings.utc = system_utc;
  return settings;
}

/// @returns the share of each digit's flexion between open (0) and closed hand (1), over the joints with an angle;
/// NaN: it has none
std::array<double, kDigits> flexion_share(const HandParameters& hand, const JointArray& angle) {
  std::array<double, kDigits> share{};
  for (int d = 0; d < kDigits; ++d) {
    double way = 0.0;
    double whole = 0.0;
    for (int k = 0; k < kJointsPerDigit; ++k) {
      const std::size_t j = idx(joint_index(d, k));
      const double range = hand.closed_angle[j].value_or(hand.max_angle[j]) - hand.open_angle[j];
      if (k == kAbductionJoint || !std::isfinite(angle[j]) || !(range > 0.0)) continue;
      way += angle[j] - hand.open_angle[j];
      whole += range;
    }
    share[idx(d)] =
        whole > 0.0 ? std::clamp(way / whole, 0.0, 1.0) : std::numeric_limits<double>::quiet_NaN();
  }
  return share;
}

/// @returns why the station cannot carry out an exercise now; empty: it can
std::string hindrance(const SessionInfo& info, const StationExercisesSettings& settings) {
  if (info.calibrating()) return "the device is being calibrated; finish or leave that first";
  if (!info.running) return fmt::format("there is no station ({}); mend that and reset first", info.trouble);
  if (!settings.plain_log.empty())
    return fmt::format(
        "the station writes its steps in plain text (--log {}); start it without --log for patients",
        settings.plain_log);
  return {};
}

/// @returns the order of a station as it is now, stopped
StationOrder own_station(const SessionInfo& info) {
  StationOrder order;
  order.scene = info.scene;
  order.overrides = info.overrides;
  if (info.source != HandSource::kDevice) order.source = info.source;
  order.calibration = info.calibration;
  order.range = info.range;
  order.stopped = true;
  return order;
}

}  // namespace

void CarriedExercise::step(const StepRecord& record) {
  if (const auto exercise = this->exercise()) exercise->step(record);
}

void CarriedExercise::finish() {
  if (const auto exercise = this->exercise()) exercise->finish();
}

std::shared_ptr<LiveExercise> CarriedExercise::exercise() {
  const std::lock_guard lock(mutex);
  return live;
}

StationExercises::Impl::Impl(Session& session, RunRecorder& recorder, std::shared_ptr<Registry> registry,
                             StationExercisesSettings settings)
    : session_(session),
      recorder_(recorder),
      registry_(std::move(registry)),
      settings_(with_clock(std::move(settings))) {}

std::uint32_t StationExercises::Impl::begin(const Actor& actor, const ExerciseOrder& order) {
  const std::lock_guard one(begin_mutex_);
  {
    const std::lock_guard lock(mutex_);
    if (ended_) throw std::runtime_error("the program ends; no exercise begins");
    if (stage_ == Stage::kOpening || stage_ == Stage::kRunning)
      throw std::runtime_error("another exercise runs; end it first");
    if (leaves_)
      throw std::runtime_error("the station's own recording is being begun; begin the exercise in a moment");
    if (stage_ == Stage::kClosing)
      throw std::runtime_error(
          fmt::format("the result of the exercise before is being made; begin in a moment{}",
                      trouble_.empty() ? "" : fmt::format(" ({})", trouble_)));
  }
  const auto info = session_.info();
  if (const std::string why = hindrance(*info, settings_); !why.empty()) throw std::runtime_error(why);
  ExercisePlace place;
  place.station = {.device = info->device_spec,
                   .simulated = info->device.simulated,
                   .sliders = info->device_spec == "sliders",
                   .overrides = settings_.overrides,
                   .clinician = settings_.clinician,
                   .stable_stiffness = settings_.stable_stiffness};
  place.recordings = settings_.recording.folder;
  place.today = utc_date(settings_.utc());
  auto prepared = std::make_shared<const PreparedExercise>(prepare_exercise(
      *registry_, actor, order, std::move(place), [this](const std::string& text) { say(text, false); },
      [this] { return ending_.load(); }));
  std::shared_ptr<const KeyUse> use = registry_->use_key(actor, order.record);
  say(fmt::format("{} orders the exercise {}", actor.account, order.exercise), false);
  const std::lock_guard lock(mutex_);
  if (is_own_) own_ = own_station(*info);
  std::erase_if(uses_, [](const auto& each) { return each.second.expired(); });
  uses_.emplace_back(order.record, use);
  use_.swap(use);  // one before closes its file after the lock
  stops_ = session_.stops();
  stage_ = Stage::kOpening;
  keeps_private_ = true;
  prepared_ = std::move(prepared);
  carried_ = std::make_shared<CarriedExercise>();
  inputs_.clear();
  trouble_.clear();
  refusal_.clear();
  result_.reset();
  last_success_ = false;
  forces_off_ = false;
  return ++number_;
}

void StationExercises::Impl::input(const ExerciseInput& input, const InputOrigin& origin) {
  const std::lock_guard lock(mutex_);
  const bool waits = stage_ == Stage::kOpening;
  if (!waits && stage_ != Stage::kRunning) throw std::invalid_argument(kNoneRuns);
  const bool stops = input.kind == ExerciseInput::Kind::kPause ||
                     ExerciseControl::stops_forces(input, prepared_->plan.start.exercise.ratings);
  if (inputs_.size() >= kMostInputs) {
    session_.stop();  // what is left out may have been a pause
    throw std::invalid_argument("too many inputs wait; forces are off until resume");
  }
  if (stops) session_.stop();
  // Forces must not follow from an input that came before the station: a stop meanwhile would not be noticed.
  if (waits && !stops)
    throw std::invalid_argument("the station of the exercise is being made; try again in a moment");
  const std::uint64_t now = session_.stops();
  if (input.kind == ExerciseInput::Kind::kResume && origin.stops.value_or(now) != now)
    throw std::runtime_error("another stop has come since; look at the patient, then resume again");
  inputs_.push_back({.input = input, .stops = now, .stopped = stops, .account = origin.account});
}

void StationExercises::Impl::reset() {
  const std::lock_guard lock(mutex_);
  if (stage_ != Stage::kOpening && stage_ != Stage::kRunning && stage_ != Stage::kClosing)
    throw std::invalid_argument(kNoneRuns);
  reset_asked_ = true;
}

bool StationExercises::Impl::uses(const std::string& record) {
  return std::any_of(uses_.begin(), uses_.end(),
                     [&](const auto& each) { return each.first == record && !each.second.expired(); });
}

/// Forgets the newest exercise if it is of this patient and over.
void StationExercises::Impl::forget(const std::string& record) {
  if (prepared_ == nullptr || prepared_->known.patient.record != record) return;
  stage_ = Stage::kNone;
  prepared_.reset();
  carried_.reset();
  trouble_.clear();
  refusal_.clear();
  result_.reset();
  last_success_ = false;
}

/// Keeps for the station's own recording the scene and the calibration that were loaded since the exercise.
void StationExercises::Impl::keep_loaded(const SessionInfo& info) {
  if (info.scene != exercised_.scene) {
    own_.scene = info.scene;
    own_.overrides = info.overrides;
    own_.source = own_station(info).source;
  }
  // A range is a patient's and holds for one calibration.
  if (info.calibration != exercised_.calibration || info.range != exercised_.range) own_.range.clear();
  if (info.calibration != exercised_.calibration) own_.calibration = info.calibration;
}

void StationExercises::Impl::release_key(const std::string& record) {
  const std::lock_guard one(begin_mutex_);
  const auto give_up = std::chrono::steady_clock::now() + kLongestRelease;
  std::unique_lock lock(mutex_);
  for (;;) {
    const bool busy = stage_ == Stage::kOpening || stage_ == Stage::kRunning || stage_ == Stage::kClosing;
    if (busy && prepared_->known.patient.record == record)
      throw std::runtime_error("an exercise of this patient runs; end it first, then delete the patient");
    if (!uses(record)) return forget(record);
    if (ending_) throw std::runtime_error("the program ends; delete the patient when it has ended");
    const auto info = session_.info();
    if (!busy && info->calibrating())
      throw std::runtime_error(
          "the device is being calibrated; finish or leave that first, then delete the patient");
    if (std::chrono::steady_clock::now() >= give_up) break;
    // Another patient's exercise ends this recording by itself.
    if (!busy && recorded_ == record && !std::exchange(leaves_, true)) keep_loaded(*info);
    lock.unlock();
    std::this_thread::sleep_for(kBetweenReleaseLooks);
    lock.lock();
  }
  throw std::runtime_error(fmt::format(
      "the recording with the key of this patient is not closed after {} s: the disk or the device does not "
      "answer; mend that, or end this program, then delete the patient",
      kLongestRelease.count()));
}

ExerciseStatus StationExercises::Impl::status() const {
  ExerciseStatus out;
  std::shared_ptr<CarriedExercise> carried;
  std::string refusal;
  std::shared_ptr<const SessionInfo> info;
  {
    const std::lock_guard lock(mutex_);
    // After end() the session may be gone.
    if (!ended_) {
      info = session_.info();
      out.fault = session_.view().fault.fault;
    }
    out.stops = ended_ ? stops_ : session_.stops();
    out.stage = stage_;
    if (prepared_ == nullptr) return out;
    out.number = number_;
    const Patient& patient = prepared_->known.patient;
    out.record = patient.record;
    out.code = patient.code;
    out.symbol = patient.symbol;
    out.side = side_name(patient.side);
    out.exercise = prepared_->plan.start.exercise;
    out.simulated = prepared_->plan.start.simulated;
    out.demo = prepared_->plan.skill.has_value();
    out.trouble = trouble_;
    out.trouble_without_code = without_code(trouble_, patient.code);
    out.result = result_;
    out.last_success = last_success_;
    out.forces_off = forces_off_;
    carried = carried_;
    refusal = refusal_;
  }
  std::shared_ptr<LiveExercise> live;
  {
    const std::lock_guard lock(carried->mutex);
    out.recording = carried->file.filename().string();
    live = carried->live;
  }
  if (live == nullptr) return out;
  out.simulated = live->start().simulated;
  out.view = live->view();
  if (!refusal.empty()) out.view.note = refusal;
  out.newest = live->newest();
  if (info == nullptr || info->geometry == nullptr) return out;
  if (out.newest) out.flexion = flexion_share(info->geometry->hand, out.newest->angle);
  JointArray target{};
  target.fill(std::numeric_limits<double>::quiet_NaN());
  if (out.view.target.kind == ExerciseTarget::Kind::kAngle) target = out.view.target.angle;
  out.target_flexion = flexion_share(info->geometry->hand, target);
  return out;
}

bool StationExercises::Impl::busy() const {
  const std::lock_guard lock(mutex_);
  return leaves_ || stage_ == Stage::kOpening || stage_ == Stage::kRunning || stage_ == Stage::kClosing;
}

void StationExercises::Impl::say(const std::string& text, bool warning) {
  const std::lock_guard lock(mutex_);
  if (words_.size() >= kMostMessages) return;
  // The words go to a log in plain text and to all pages.
  const std::string code = prepared_ == nullptr ? std::string() : prepared_->known.patient.code;
  words_.push_back({.text = without_code(text, code), .warning = warning});
}

// ---- the public class

StationExercises::StationExercises(Session& session, RunRecorder& recorder,
                                   std::shared_ptr<Registry> registry, StationExercisesSettings settings)
    : impl_(std::make_shared<Impl>(session, recorder, std::move(registry), std::move(settings))) {}

StationExercises::~StationExercises() { impl_->end(); }

std::uint32_t StationExercises::begin(const Actor& actor, const ExerciseOrder& order) {
  return impl_->begin(actor, order);
}
void StationExercises::input(const ExerciseInput& input, const InputOrigin& origin) {
  impl_->input(input, origin);
}
void StationExercises::reset() { impl_->reset(); }
void StationExercises::release_key(const std::string& record) { impl_->release_key(record); }
ExerciseStatus StationExercises::status() const { return impl_->status(); }
bool StationExercises::busy() const { return impl_->busy(); }
bool StationExercises::keeps_private() const {
  const std::lock_guard lock(impl_->mutex_);
  return impl_->keeps_private_;
}
void StationExercises::tick() { impl_->tick(); }
double StationExercises::between_ticks() const {
  return impl_->control_ ? impl_->control_->between_ticks() : ExerciseControl::kBetweenLooks;
}
void StationExercises::end() { impl_->end(); }

}  // namespace phalanx
