// SPDX-License-Identifier: Apache-2.0
// Exercises and the patient's screen in the cockpit.
#include <fmt/format.h>

#include <stdexcept>

#include "phalanx/serve/reach.h"
#include "serve/cockpit_impl.h"
#include "serve/exercise_message.h"

namespace phalanx {
namespace {

constexpr std::uint32_t kLargestRating = 10;
constexpr std::uint64_t kFramesBetweenExercises = 2;  ///< 30 a second

/// @returns the input of a rating
/// @throws std::invalid_argument
ExerciseInput rating_of(const wire::Feel& feel) {
  const bool pain = feel.kind() == wire::Feel::PAIN;
  if (!pain && feel.kind() != wire::Feel::TIRED)
    throw std::invalid_argument(
        fmt::format("Feel.kind {}: it is PAUSE, PAIN or TIRED", static_cast<int>(feel.kind())));
  if (feel.value() > kLargestRating)
    throw std::invalid_argument(
        fmt::format("{} {}: a rating is 0 to {}", pain ? "pain" : "fatigue", feel.value(), kLargestRating));
  return {.kind = pain ? ExerciseInput::Kind::kPain : ExerciseInput::Kind::kFatigue,
          .value = static_cast<double>(feel.value())};
}

}  // namespace

void Cockpit::Impl::feel(PageId page, const wire::Feel& feel) {
  const Participant& participant = *participants.find(page);
  const bool pause = feel.kind() == wire::Feel::PAUSE;
  // First, and without a condition: every page may stop.
  if (pause) stop(participant);
  refuse_unless_may_feel(participant);
  if (!settings.exercises_host)
    throw std::invalid_argument("this station carries out no exercises of patients");
  settings.exercises_host->input(pause ? ExerciseInput{.kind = ExerciseInput::Kind::kPause}
                                       : rating_of(feel));
  request_state();
}

/// @throws std::invalid_argument naming the remedy
void Cockpit::Impl::refuse_unless_may_feel(const Participant& participant) const {
  const ClientInfo& client = participant.client;
  if (!participant.patient_screen) {
    if (!client.may_operate)
      throw std::invalid_argument("this page has the viewers' link and may only view and stop");
    return;
  }
  if (people->has_accounts()) {
    if (participant.account.empty() || participant.role == Role::kLookOn)
      throw std::invalid_argument("sign in at this screen first; a stop needs no account");
  } else if (!client.may_operate && !is_loopback(client.address)) {
    throw std::invalid_argument("open the patient's screen with the operator's link; a stop needs none");
  }
}

/// Refuses a change of the station while an exercise has it. @throws std::invalid_argument
void Cockpit::Impl::refuse_during_exercise(const wire::ToHost& message) const {
  if (!settings.exercises_host) return;
  switch (message.what_case()) {
    case wire::ToHost::kSet:
    case wire::ToHost::kScene:
    case wire::ToHost::kSource:
    case wire::ToHost::kSliders:
    case wire::ToHost::kCalibrate:
    case wire::ToHost::kResume:
      break;
    default:
      return;
  }
  const ExerciseStatus status = settings.exercises_host->status();
  if (!exercise_runs(status)) return;
  if (message.has_sliders() && !status.demo) return;
  throw std::invalid_argument(message.has_resume()
                                  ? "an exercise runs; resume it on the page of patients, or end it first"
                                  : "an exercise runs; end it first");
}

Bytes Cockpit::Impl::encoded_exercise(const ExerciseStatus& status) const {
  wire::ToPage message;
  write_exercise(status, *message.mutable_exercise());
  message.mutable_exercise()->set_trouble(for_pages(message.exercise().trouble()));
  return std::make_shared<const std::string>(message.SerializeAsString());
}

void Cockpit::Impl::look_at_exercise() {
  if (!settings.exercises_host) return;
  const ExerciseStatus status = settings.exercises_host->status();
  exercise_has_station = exercise_runs(status);
  hides_scene = exercise_has_station && status.view.hides_scene;
}

void Cockpit::Impl::send_present_exercise(PageId page) {
  if (!settings.exercises_host) return;
  server->send(page, encoded_exercise(settings.exercises_host->status()));
}

// A change of stage or phase reaches each page. Between them only the newest message matters.
void Cockpit::Impl::send_exercise_if_due() {
  if (!settings.exercises_host || ++frames % kFramesBetweenExercises != 0) return;
  const ExerciseStatus status = settings.exercises_host->status();
  const bool runs = exercise_runs(status);
  if (runs != exercise_has_station || (runs && status.view.hides_scene) != hides_scene) request_state();
  exercise_has_station = runs;
  hides_scene = runs && status.view.hides_scene;
  const SentExercise now_shown{.number = status.number,
                               .stage = status.stage,
                               .phase = status.view.phase,
                               .trouble = status.trouble_without_code};
  const bool changed = now_shown != sent_exercise;
  if (!changed && !runs) return;
  const Bytes bytes = encoded_exercise(status);
  for (const auto& [page, window] : greeted) {
    if (changed) server->send(page, bytes);
    // After a change, too: an older message may wait, which would come after the newer one.
    server->send_newest(page, bytes, kExerciseMessages);
  }
  if (changed) sent_exercise = now_shown;
  if (changed) request_state();
}

}  // namespace phalanx
