// SPDX-License-Identifier: Apache-2.0
#include "serve/people.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <chrono>
#include <ctime>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "phalanx/core/nice_thread.h"
#include "phalanx/serve/reach.h"
#include "record/plain_text.h"
#include "serve/people_accounts.h"
#include "serve/people_exercise.h"
#include "serve/web/request_checks.h"

namespace phalanx {
namespace {

using people::json_response;
using people::words_response;

constexpr std::string_view kStatus = "/people";
constexpr std::string_view kSignIn = "/people/sign_in";
constexpr std::string_view kSignOut = "/people/sign_out";
constexpr std::string_view kLock = "/people/lock";
constexpr std::string_view kUnlock = "/people/unlock";
constexpr std::string_view kAlive = "/people/alive";

double system_utc() {
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

/// @returns "2026-05-04"
std::string utc_date(double utc) {
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(static_cast<std::time_t>(utc)));
}

RegistryError signed_out() {
  return {RegistryFault::kSignIn, "no account is signed in on this page, or the session is locked; sign in"};
}

}  // namespace

People::People(std::shared_ptr<Registry> registry, people::ListExercises exercises,
               std::function<double()> utc, std::shared_ptr<ExerciseHost> host)
    : registry_(std::move(registry)),
      exercises_(std::move(exercises)),
      utc_(utc ? std::move(utc) : system_utc),
      host_(std::move(host)),
      owner_secret_(registry_ ? random_token() : "") {
  if (registry_)
    read_accounts();
  else
    has_accounts_ = false;
}

std::size_t People::body_limit(const WebRequest& head) const noexcept {
  return registry_ && head.client.may_operate && head.method == "POST" ? kBodyLimit : 0;
}

void People::request(const WebRequest& request, Respond respond) {
  if (!request.client.may_operate)
    return respond(
        words_response(403,
                       "patients are for those who may operate: use the operator's address, not the "
                       "viewers' one"));
  if (!registry_)
    return respond(words_response(404,
                                  "this station keeps no patients; start it with --data FOLDER to give it a "
                                  "folder for them"));
  if (host_) people::stop_at_once(*host_, request);
  std::unique_lock lock(mutex_);
  if (requests_.size() >= kMostWaiting) {
    lock.unlock();
    return respond(words_response(503, "too many requests wait for the patients' data; ask again"));
  }
  requests_.push_back({request, std::move(respond)});
  if (working_ || start_thread()) return;
  const Request refused = std::move(requests_.back());
  requests_.pop_back();
  lock.unlock();
  refused.respond(words_response(503, "there is no thread to read the patients' data; ask again"));
}

std::vector<People::SignIn> People::take_sign_ins() {
  const std::scoped_lock lock(mutex_);
  return std::exchange(sign_ins_, {});
}

/// Reads whether accounts exist. If that cannot be read, there are some, since a patient's screen then needs one.
/// While another program holds the registry, the answer stays as it was.
void People::read_accounts() noexcept {
  try {
    has_accounts_ = registry_->has_accounts();
  } catch (const RegistryError& refused) {
    if (refused.fault() != RegistryFault::kBusy) has_accounts_ = true;  // else as before
  } catch (const std::exception&) {
    has_accounts_ = true;
  }
}

void People::check_sessions(bool accounts) {
  const std::scoped_lock lock(mutex_);
  if (!registry_ || (named_.empty() && !accounts) || checks_) return;
  checks_ = working_ || start_thread();
}

bool People::start_thread() {
  try {
    start_nice_thread("phalanx-people", [self = shared_from_this()] { self->work(); }).detach();
    working_ = true;
  } catch (const std::system_error&) {
    return false;
  }
  return true;
}

void People::report_ended_sessions() {
  std::unique_lock lock(mutex_);
  const std::map<std::string, SignIn> named = named_;
  lock.unlock();
  for (const auto& [session, sign_in] : named) {
    if (registry_->signed_in(session, false).state == SignInState::kActive) continue;
    lock.lock();
    end_name(session);
    lock.unlock();
  }
}

void People::work() {
  std::unique_lock lock(mutex_);
  while (!requests_.empty() || checks_) {
    if (requests_.empty() &&
        std::exchange(checks_, false)) {  // a person waits for an answer, not for a check
      lock.unlock();
      read_accounts();
      try {
        report_ended_sessions();
      } catch (const std::exception&) {  // the disk: the next check asks again
      }
      lock.lock();
      continue;
    }
    const Request next = std::move(requests_.front());
    requests_.pop_front();
    lock.unlock();
    try {
      next.respond(response_to(next.request));
    } catch (const std::exception&) {  // no memory: without an answer, the server gives 500
    }
    lock.lock();
  }
  working_ = false;
  ended_.notify_all();
}

bool People::finish(std::chrono::milliseconds timeout) {
  std::unique_lock lock(mutex_);
  return ended_.wait_for(lock, timeout, [this] { return !working_; });
}

WebResponse People::response_to(const WebRequest& request) {
  try {
    return answer(request);
  } catch (const RegistryError& refused) {
    return people::refusal_response(refused);
  } catch (const std::invalid_argument& refused) {
    return words_response(400, refused.what());
  } catch (const std::system_error& error) {
    return words_response(507, fmt::format("the disk refuses ({})", error.code().message()));
  }
}

WebResponse People::answer(const WebRequest& request) {
  const bool changes = request.method == "POST";
  if (request.path == kStatus) {
    if (changes) return words_response(405, "this address does not allow this method");
    nlohmann::json status = people::status_json(registry_->has_accounts());
    status["exercises"] = host_ != nullptr;
    return json_response(status);
  }
  for (const std::string_view path : {kSignIn, kSignOut, kLock, kUnlock, kAlive})
    if (request.path == path && !changes)
      return words_response(405, "this address does not allow this method");
  if (request.path == kSignIn) return sign_in(request);
  if (request.path == kSignOut) return end_session(request, false);
  if (request.path == kLock) return end_session(request, true);
  if (request.path == kUnlock) return unlock(request);
  // A page asks for the exercise's state by itself, several times a second: that is no sign of a person.
  const bool watches = request.path == people::kWatchedExercise;
  const Actor actor = actor_of(request, !watches && (changes || request.path != people::kExercise), watches);
  if (request.path == kAlive) return json_response(nlohmann::json::object());
  if (!actor.may_see_patients())
    return words_response(403, fmt::format("the role of this account, {}, sees no patients; sign in as a "
                                           "therapist",
                                           role_name(actor.role)));
  if (watches) return people::watched_exercise_response(host_.get(), actor, request);
  if (people::is_of_accounts(request.path)) {
    WebResponse response = people::accounts_response(*registry_, actor, request);
    if (changes) read_accounts();
    return response;
  }
  return people::route(
      {.registry = *registry_, .exercises = exercises_, .today = utc_date(utc_()), .host = host_.get()},
      actor, request);
}

// ---- sessions ----

bool People::is_owner(const WebRequest& request) const {
  return !request.session.empty() && web::equal_secrets(request.session, owner_secret_);
}

Actor People::actor_of(const WebRequest& request, bool touch, bool locked) {
  if (request.session.empty()) throw signed_out();
  if (is_owner(request)) {
    // Accounts may have been added since: then the registry refuses the owner.
    if (!is_loopback(request.client.address)) throw signed_out();
    return Actor::owner();
  }
  const SignedIn known = registry_->signed_in(request.session, touch);
  if (known.state != SignInState::kActive && !(locked && known.state == SignInState::kLocked))
    throw signed_out();
  return known.actor;
}

WebResponse People::sign_in(const WebRequest& request) {
  const nlohmann::json given = people::read_object(request.body);
  nlohmann::json session;
  if (registry_->has_accounts()) {
    const std::string account = people::text_of(given, "account", kLongestName);
    const std::string token =
        registry_->sign_in(account, people::text_of(given, "password", kLongestPassword));
    const SignedIn known = registry_->signed_in(token);
    if (!known.actor.may_see_patients() && known.actor.role != Role::kPatientScreen) {
      registry_->sign_out(token);
      return words_response(403, fmt::format("the role of this account, {}, sees no patients; sign in as a "
                                             "therapist",
                                             role_name(known.actor.role)));
    }
    session = {{"session", token},
               {"account", known.actor.account},
               {"role", role_name(known.actor.role)},
               {"idle_s", known.idle_left_s}};
    begin_name(token, {.page_secret = request.page_secret,
                       .account = known.actor.account,
                       .in = true,
                       .role = known.actor.role});
  } else {
    if (!is_loopback(request.client.address))
      return words_response(403,
                            "this station has no accounts, so that only its own computer sees patients; add "
                            "one there with `phalanx account add`");
    session = {{"session", owner_secret_}, {"account", ""}, {"role", "owner"}};
  }
  return json_response(session);
}

WebResponse People::end_session(const WebRequest& request, bool only_lock) {
  if (!request.session.empty() && !is_owner(request)) {
    if (only_lock) {
      registry_->lock(request.session);
    } else {
      registry_->sign_out(request.session);
    }
    const std::scoped_lock lock(mutex_);
    end_name(request.session);
  }
  return json_response(nlohmann::json::object());
}

WebResponse People::unlock(const WebRequest& request) {
  if (request.session.empty()) throw signed_out();
  if (is_owner(request)) return json_response(nlohmann::json::object());
  registry_->unlock(request.session,
                    people::text_of(people::read_object(request.body), "password", kLongestPassword));
  const Actor actor = registry_->signed_in(request.session).actor;
  begin_name(request.session,
             {.page_secret = request.page_secret, .account = actor.account, .in = true, .role = actor.role});
  return json_response(nlohmann::json::object());
}

void People::begin_name(const std::string& session, const SignIn& sign_in) {
  const std::scoped_lock lock(mutex_);
  if (sign_ins_.size() < kMostSignIns) sign_ins_.push_back(sign_in);
  if (named_.size() < kMostNamed) named_[session] = sign_in;
}

void People::end_name(const std::string& session) {
  const auto found = named_.find(session);
  if (found == named_.end()) return;
  found->second.in = false;
  if (sign_ins_.size() < kMostSignIns) sign_ins_.push_back(found->second);
  named_.erase(found);
}

// ---- keys of recordings

RecordingAccess People::recording_access(const WebRequest& request) {
  if (!registry_) return {};
  try {
    Actor actor = Actor::owner();
    std::string session;  // empty: the owner
    if (registry_->has_accounts()) {
      const SignedIn known = registry_->signed_in(request.session, false);
      if (known.state != SignInState::kActive || !known.actor.may_see_patients())
        return {.keys = {}, .refusal = "sign in on the page of patients, and keep it open"};
      actor = known.actor;
      session = request.session;
    } else if (!is_loopback(request.client.address)) {
      return {.keys = {},
              .refusal =
                  "this station has no accounts, so that only its own computer reads patients' "
                  "recordings; add one there with `phalanx account add`"};
    }
    return {.keys = [self = shared_from_this(), actor,
                     session](const std::string& id) { return self->recording_key(actor, session, id); },
            .refusal = {}};
  } catch (const RegistryError& refused) {
    return {.keys = {}, .refusal = refused.what()};
  }
}

std::optional<RecordingKey> People::recording_key(const Actor& actor, const std::string& session,
                                                  const std::string& id) {
  const std::scoped_lock lock(keys_mutex_);
  auto found = keys_.find(session);
  if (found == keys_.end()) {
    std::erase_if(keys_, [&](const auto& each) {
      return !each.first.empty() && registry_->signed_in(each.first, false).state == SignInState::kNone;
    });
    try {
      found = keys_.emplace(session, registry_->recording_keys(actor)).first;
    } catch (const std::exception&) {  // without a line in the registry's audit log there is no key
      return std::nullopt;
    }
  }
  return found->second(id);
}

}  // namespace phalanx
