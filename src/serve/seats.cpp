// SPDX-License-Identifier: Apache-2.0
#include "serve/seats.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "serve/plain_text.h"

namespace phalanx {

std::string Seat::label() const {
  return fmt::format("page {} ({}){}{}", number, visitor.address, name.empty() ? "" : ", ", name);
}

const Seat& Seats::join(PageId page, const Visitor& visitor, std::string secret, double now) {
  forget(now);
  Seat& seat = page_[page];
  seat = {.number = ++last_number_, .secret = std::move(secret), .name = {}, .visitor = visitor};
  return seat;
}

Seats::Return Seats::come_back(PageId page, const std::string& secret, double now) {
  forget(now);
  Return result;
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
    const Visitor visitor = here->second.visitor;  // rights belong to the connection
    here->second = away->second.seat;
    here->second.visitor = visitor;
    away_.erase(away);
    if (operates(here->second) && !visitor.may_operate) operator_number_ = 0;
  }
  result.sat_down = sit_if_free(here->second, now);
  return result;
}

void Seats::leave(PageId page, double now) {
  const auto here = page_.find(page);
  if (here == page_.end()) return;
  away_[here->second.secret] = {.seat = here->second, .since = now};
  page_.erase(here);
  forget(now);
}

std::string Seats::take(PageId page, double now) {
  const Seat* seat = find(page);
  if (seat == nullptr || !seat->visitor.may_operate)
    throw std::invalid_argument(
        "this page came with the viewers' link and may only look and stop; open the "
        "operator's link to take control");
  const Seat* other = operating(now);
  std::string before = other != nullptr ? other->label() : "";
  operator_number_ = seat->number;
  return before;
}

bool Seats::release(PageId page) {
  if (!operates(page)) return false;
  operator_number_ = 0;
  page_.at(page).gave_back = true;
  return true;
}

const Seat* Seats::give_to_only_page(double now) {
  const Seat* only = nullptr;
  for (const auto& [id, seat] : page_) {
    if (!seat.greeted || !seat.visitor.may_operate) continue;
    if (only != nullptr) return nullptr;
    only = &seat;
  }
  return only != nullptr && !only->gave_back && sit_if_free(*only, now) ? only : nullptr;
}

void Seats::name(PageId page, const std::string& name) {
  if (const auto here = page_.find(page); here != page_.end())
    here->second.name = shortened(one_line(name), kNameLength);
}

const Seat* Seats::find(PageId page) const {
  const auto here = page_.find(page);
  return here == page_.end() ? nullptr : &here->second;
}

PageId Seats::page_with(const std::string& secret) const {
  if (secret.empty()) return 0;
  const auto here = std::find_if(page_.begin(), page_.end(),
                                 [&](const auto& entry) { return entry.second.secret == secret; });
  return here == page_.end() ? 0 : here->first;
}

const Seat* Seats::with_secret(const std::string& secret) const { return find(page_with(secret)); }

bool Seats::operates(PageId page) const {
  const Seat* seat = find(page);
  return seat != nullptr && operates(*seat);
}

bool Seats::operates(const Seat& seat) const {
  return operator_number_ != 0 && seat.number == operator_number_;
}

const Seat* Seats::operating(double now) const {
  for (const auto& [id, seat] : page_)
    if (operates(seat)) return &seat;
  for (const auto& [secret, away] : away_)
    if (operates(away.seat) && now - away.since < kGrace) return &away.seat;
  return nullptr;
}

bool Seats::sit_if_free(const Seat& seat, double now) {
  if (!seat.visitor.may_operate || operating(now) != nullptr) return false;
  operator_number_ = seat.number;
  return true;
}

void Seats::forget(double now) {
  std::erase_if(away_, [&](const auto& entry) { return now - entry.second.since > kRemember; });
  while (away_.size() > kRemembered) {
    away_.erase(std::min_element(away_.begin(), away_.end(), [](const auto& a, const auto& b) {
      return a.second.since < b.second.since;
    }));
  }
  if (operator_number_ != 0 && operating(now) == nullptr) operator_number_ = 0;
}

}  // namespace phalanx
