// SPDX-License-Identifier: Apache-2.0
#include "serve/participants.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "record/plain_text.h"

namespace phalanx {

std::string Participant::label() const {
  return fmt::format("page {} ({}{}{}){}{}", number, client.address, account.empty() ? "" : ", account ",
                     account, name.empty() ? "" : ", ", name);
}

const Participant& Participants::join(PageId page, const ClientInfo& client, std::string secret, double now) {
  forget(now);
  Participant& participant = page_[page];
  participant = {.number = ++last_number_, .secret = std::move(secret), .name = {}, .client = client};
  return participant;
}

Participants::Reconnection Participants::reconnect(PageId page, const std::string& secret, double now,
                                                   bool patient_screen) {
  forget(now);
  Reconnection result;
  const auto here = page_.find(page);
  if (here == page_.end()) return result;
  here->second.greeted = true;
  const PageId same = page_with(secret);
  if (same != 0 && same != page) {
    result.replaced = same;
    leave(same, now);
  }
  const auto away = away_.find(secret);
  if (away != away_.end()) {
    const ClientInfo client = here->second.client;  // the role belongs to the connection
    here->second = away->second.participant;
    here->second.client = client;
    away_.erase(away);
    if (operates(here->second) && !client.may_operate) operator_number_ = 0;
  }
  here->second.patient_screen = patient_screen;
  if (patient_screen && operates(here->second)) operator_number_ = 0;
  result.became_operator = operate_if_free(here->second, now);
  return result;
}

void Participants::leave(PageId page, double now) {
  const auto here = page_.find(page);
  if (here == page_.end()) return;
  away_[here->second.secret] = {.participant = here->second, .since = now};
  page_.erase(here);
  forget(now);
}

std::string Participants::take_control(PageId page, double now) {
  const Participant* participant = find(page);
  if (participant == nullptr || !participant->client.may_operate)
    throw std::invalid_argument(
        "this page has the viewers' link and may only view and stop; open the operator's link to take "
        "control");
  if (participant->patient_screen)
    throw std::invalid_argument(
        "this is the patient's screen, which never operates; open the cockpit's page");
  const Participant* other = current_operator(now);
  std::string before = other != nullptr ? other->label() : "";
  operator_number_ = participant->number;
  return before;
}

bool Participants::release_control(PageId page) {
  if (!operates(page)) return false;
  operator_number_ = 0;
  page_.at(page).released_control = true;
  return true;
}

const Participant* Participants::give_to_only_page(double now) {
  const Participant* only = nullptr;
  for (const auto& [id, participant] : page_) {
    if (!participant.greeted || !participant.client.may_operate || participant.patient_screen) continue;
    if (only != nullptr) return nullptr;
    only = &participant;
  }
  return only != nullptr && !only->released_control && operate_if_free(*only, now) ? only : nullptr;
}

void Participants::name(PageId page, const std::string& name) {
  if (const auto here = page_.find(page); here != page_.end())
    here->second.name = shortened(one_line(name), kNameLength);
}

void Participants::sign_in(const std::string& secret, const std::string& account, Role role) {
  Participant* participant = nullptr;
  if (const auto here = page_.find(page_with(secret)); here != page_.end()) participant = &here->second;
  if (const auto away = away_.find(secret); away != away_.end()) participant = &away->second.participant;
  if (participant == nullptr) return;
  participant->account = account;
  participant->role = role;
}

bool Participants::any_patient_screen() const noexcept {
  return std::any_of(page_.begin(), page_.end(),
                     [](const auto& entry) { return entry.second.patient_screen; });
}

const Participant* Participants::find(PageId page) const {
  const auto here = page_.find(page);
  return here == page_.end() ? nullptr : &here->second;
}

PageId Participants::page_with(const std::string& secret) const {
  if (secret.empty()) return 0;
  const auto here = std::find_if(page_.begin(), page_.end(),
                                 [&](const auto& entry) { return entry.second.secret == secret; });
  return here == page_.end() ? 0 : here->first;
}

const Participant* Participants::with_secret(const std::string& secret) const {
  return find(page_with(secret));
}

bool Participants::operates(PageId page) const {
  const Participant* participant = find(page);
  return participant != nullptr && operates(*participant);
}

bool Participants::operates(const Participant& participant) const {
  return operator_number_ != 0 && participant.number == operator_number_;
}

const Participant* Participants::current_operator(double now) const {
  for (const auto& [id, participant] : page_)
    if (operates(participant)) return &participant;
  for (const auto& [secret, away] : away_)
    if (operates(away.participant) && now - away.since < kGrace) return &away.participant;
  return nullptr;
}

bool Participants::operate_if_free(const Participant& participant, double now) {
  if (!participant.client.may_operate || participant.patient_screen || current_operator(now) != nullptr)
    return false;
  operator_number_ = participant.number;
  return true;
}

void Participants::forget(double now) {
  std::erase_if(away_, [&](const auto& entry) { return now - entry.second.since > kRemember; });
  while (away_.size() > kRemembered) {
    away_.erase(std::min_element(away_.begin(), away_.end(), [](const auto& a, const auto& b) {
      return a.second.since < b.second.since;
    }));
  }
  if (operator_number_ != 0 && current_operator(now) == nullptr) operator_number_ = 0;
}

}  // namespace phalanx
