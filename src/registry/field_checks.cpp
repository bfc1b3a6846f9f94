// SPDX-License-Identifier: Apache-2.0
#include "registry/field_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace phalanx::registry {
namespace {

/// @returns the number of two or four digits, or -1
int digits(std::string_view text) noexcept {
  int out = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
  return error == std::errc() && end == text.data() + text.size() && text.front() != '-' ? out : -1;
}

bool is_utf8(const std::string& text) {
  try {
    static_cast<void>(nlohmann::json(text).dump());
    return true;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

std::string lower(std::string text) {
  for (char& each : text)
    if (each >= 'A' && each <= 'Z') each = static_cast<char>(each - 'A' + 'a');
  return text;
}

bool is_date(const std::string& text) noexcept {
  return text.size() == 10 && text[4] == '-' && text[7] == '-' &&
         is_day(digits(std::string_view(text).substr(0, 4)), digits(std::string_view(text).substr(5, 2)),
                digits(std::string_view(text).substr(8, 2)));
}

}  // namespace

void check_text(std::string_view field, const std::string& text, std::size_t longest) {
  if (text.size() > longest)
    throw std::invalid_argument(
        fmt::format("{} has {} bytes; at most {} are possible", field, text.size(), longest));
  if (!is_utf8(text)) throw std::invalid_argument(fmt::format("{} is not UTF-8", field));
  if (std::any_of(text.begin(), text.end(), [](char c) {
        return (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') || c == 0x7f;
      }))
    throw std::invalid_argument(fmt::format("{} has a control character; remove it", field));
}

void check_anonymous(std::string_view field, const std::string& text, std::size_t longest) {
  check_text(field, text, longest);
  if (text.find('@') != std::string::npos)
    throw std::invalid_argument(
        fmt::format("{} has an '@': addresses of a person do not belong here; remove it", field));
  const std::string small = lower(text);
  for (const char* word : {"born", "birth", "dob:", "geboren", "geb.", "geburt"})
    if (small.find(word) != std::string::npos)
      throw std::invalid_argument(fmt::format(
          "{} has \"{}\": a date of birth does not belong here, the clinic's own list has it; remove it",
          field, word));
}

void check_date(std::string_view field, const std::string& text, bool optional) {
  if (optional && text.empty()) return;
  if (!is_date(text))
    throw std::invalid_argument(fmt::format("{} is \"{}\"; write a day as \"2026-05-04\"", field, text));
}

void check_number(std::string_view field, double value, double least, double largest) {
  if (!(value >= least && value <= largest))
    throw std::invalid_argument(
        fmt::format("{} is {}; it must be in {} .. {}", field, value, least, largest));
}

bool is_day(int year, int month, int day) noexcept {
  if (year < 1900 || year > 2200 || month < 1 || month > 12 || day < 1) return false;
  return std::chrono::year_month_day(std::chrono::year(year),
                                     std::chrono::month(static_cast<unsigned>(month)),
                                     std::chrono::day(static_cast<unsigned>(day)))
      .ok();
}

bool has_only(const std::string& text, std::string_view characters, std::size_t longest) noexcept {
  const auto allowed = [&](char c) {
    for (std::size_t i = 0; i < characters.size(); ++i) {
      const bool is_range = i + 2 < characters.size() && characters[i + 1] == '-';
      if (is_range ? c >= characters[i] && c <= characters[i + 2] : c == characters[i]) return true;
      if (is_range) i += 2;
    }
    return false;
  };
  return !text.empty() && text.size() <= longest && std::all_of(text.begin(), text.end(), allowed);
}

std::string utc_text(double utc) {
  using namespace std::chrono;
  const double clamped = std::isfinite(utc) ? std::clamp(utc, 0.0, 7.2e9) : 0.0;
  const sys_seconds time{seconds(static_cast<std::int64_t>(clamped))};
  const sys_days day = floor<days>(time);
  const year_month_day date(day);
  const hh_mm_ss<seconds> clock(time - day);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     clock.hours().count(), clock.minutes().count(), clock.seconds().count());
}

double utc_of_day(const std::string& day) noexcept {
  using namespace std::chrono;
  if (!is_date(day)) return 0.0;
  const std::string_view text(day);
  const sys_days date{year(digits(text.substr(0, 4))) / digits(text.substr(5, 2)) /
                      digits(text.substr(8, 2))};
  return static_cast<double>(duration_cast<seconds>(date.time_since_epoch()).count());
}

}  // namespace phalanx::registry
