// SPDX-License-Identifier: Apache-2.0
#include "scene/toml/toml_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "phalanx/core/constants.h"
#include "phalanx/core/nearest_name.h"
#include "phalanx/scene/scene.h"
#include "scene/toml/toml_bounds.h"

namespace phalanx {

toml::table parse_bounded_toml(const std::string& text, const std::string& origin) {
  check_toml_bounds(text, origin);
  return toml::parse(text);  // without the origin, which toml++ 3.3 would copy in a noexcept function
}

toml::table parse_toml(const std::string& text, const std::string& origin) {
  try {
    return parse_bounded_toml(text, origin);
  } catch (const toml::parse_error& error) {
    throw SceneError(fmt::format("{}:{}: not valid TOML: {}; correct this line", origin,
                                 error.source().begin.line, error.description()));
  }
}

namespace {

/// Writes a node on one line; the library breaks long arrays and every table.
std::string one_line(const toml::node& node) {
  std::string text;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& element : *array) text += (text.empty() ? "" : ", ") + one_line(element);
    return "[" + text + "]";
  }
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table)
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key.str(), one_line(value));
    return "{" + text + "}";
  }
  // The shortest digits that read back the same; the library prints all seventeen.
  if (const auto* number = node.as_floating_point()) return fmt::format("{}", number->get());
  std::ostringstream out;
  node.visit([&](const auto& value) { out << value; });
  text = out.str();
  std::replace_if(text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 32; }, ' ');
  return text;
}

}  // namespace

std::string toml_text(const toml::node& node) {
  if (const auto number = node.value_exact<double>(); number && std::isfinite(*number)) {
    const std::string text = fmt::format("{}", *number);
    return text.find_first_of(".e") == std::string::npos ? text + ".0" : text;
  }
  if (const toml::array* array = node.as_array()) {
    std::string text;
    for (const toml::node& element : *array) text += (text.empty() ? "" : ", ") + toml_text(element);
    return "[" + text + "]";
  }
  std::ostringstream text;
  constexpr auto kFlags = toml::toml_formatter::default_flags & ~toml::format_flags::allow_literal_strings;
  text << toml::toml_formatter{node, kFlags};  // "file", not 'file'
  return text.str();
}

std::string show(const toml::node& node) {
  std::string text = one_line(node);
  if (text.size() > 80) text = text.substr(0, 77) + "...";
  return text;
}

double number_of(const toml::node& node) { return node.value<double>().value_or(kInfinity); }

std::string_view type_name(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a string";
    case toml::node_type::integer:
      return "an integer";
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

std::string TomlTable::full(std::string_view key) const {
  return path_.empty() ? std::string(key) : fmt::format("{}.{}", path_, key);
}

std::string TomlTable::place_of(const toml::node* found, const std::string& path) const {
  if (place_of_) {
    const ValuePlace value = place_of_(path);
    return fmt::format("{}: {}{}", value.place, value.prefix, path);
  }
  const toml::node& nearest = found == nullptr ? *table_ : *found;
  return fmt::format("{}:{}: {}", origin_, nearest.source().begin.line, path);
}

std::string TomlTable::place() const { return place_of(table_, path_); }

void TomlTable::fail(std::string_view key, const std::string& problem) const {
  const toml::node* found = table_->get(key);
  const std::string place = place_of(found, full(key));
  if (found == nullptr) throw SceneError(fmt::format("{}: {}", place, problem));
  throw SceneError(fmt::format("{} = {}: {}", place, show(*found), problem));
}

std::vector<std::string> TomlTable::keys() const {
  std::vector<std::string> keys;
  for (const auto& [key, value] : *table_) keys.emplace_back(key.str());
  return keys;
}

bool TomlTable::has(std::string_view key) {
  known_.emplace_back(key);
  return table_->contains(key);
}

const toml::node& TomlTable::node(std::string_view key) {
  if (!has(key)) fail(key, "is missing; add it");
  return *table_->get(key);
}

double TomlTable::number(std::string_view key, const NumberRange& range) {
  const toml::node& found = node(key);
  if (!found.is_number()) fail(key, fmt::format("is {}; write a number, {}", type_name(found), range.text()));
  const double value = number_of(found);
  if (!range.contains(value)) fail(key, fmt::format("must be {}; change the value", range.text()));
  return value;
}

double TomlTable::number_or(std::string_view key, const NumberRange& range, double fallback) {
  return has(key) ? number(key, range) : fallback;
}

bool TomlTable::flag(std::string_view key) {
  const toml::node& found = node(key);
  if (!found.is_boolean()) fail(key, fmt::format("is {}; write true or false", type_name(found)));
  return *found.value<bool>();
}

std::string TomlTable::text(std::string_view key) {
  const toml::node& found = node(key);
  if (!found.is_string()) fail(key, fmt::format("is {}; write a string in quotes", type_name(found)));
  return *found.value<std::string>();
}

std::vector<double> TomlTable::numbers(std::string_view key, const NumberRange& range, std::size_t size) {
  const toml::node& found = node(key);
  const toml::array* array = found.as_array();
  if (array == nullptr || array->size() != size)
    fail(key, fmt::format("write {} numbers in square brackets", size));
  std::vector<double> result;
  for (std::size_t i = 0; i < size; ++i) {
    result.push_back(element(key, std::to_string(i), (*array)[i], range));
  }
  return result;
}

double TomlTable::element(std::string_view key, const std::string& name, const toml::node& node,
                          const NumberRange& range) const {
  if (!node.is_number()) fail(key, fmt::format("element {} is {}; write a number", name, type_name(node)));
  const double value = number_of(node);
  if (!range.contains(value))
    fail(key, fmt::format("element {} must be {}; change the value", name, range.text()));
  return value;
}

std::vector<double> TomlTable::list(std::string_view key, const NumberRange& range) {
  const toml::array* array = node(key).as_array();
  if (array == nullptr || array->empty()) fail(key, "write numbers in square brackets");
  return numbers(key, range, array->size());
}

std::vector<std::pair<double, double>> TomlTable::pairs(std::string_view key, const NumberRange& first,
                                                        const NumberRange& second) {
  const toml::array* array = node(key).as_array();
  if (array == nullptr || array->empty()) fail(key, "write pairs of numbers: [[a, b], [c, d]]");
  std::vector<std::pair<double, double>> result;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::array* pair = (*array)[i].as_array();
    if (pair == nullptr || pair->size() != 2)
      fail(key, fmt::format("element {} is no pair of numbers; write [a, b]", i));
    result.emplace_back(element(key, fmt::format("{}, first", i), (*pair)[0], first),
                        element(key, fmt::format("{}, second", i), (*pair)[1], second));
  }
  return result;
}

Vec3 TomlTable::vector(std::string_view key, const NumberRange& range) {
  const auto v = numbers(key, range, 3);
  return {v[0], v[1], v[2]};
}

std::pair<double, double> TomlTable::pair(std::string_view key, const NumberRange& range) {
  const auto v = numbers(key, range, 2);
  return {v[0], v[1]};
}

TomlTable TomlTable::table(std::string_view key) {
  const toml::node& found = node(key);
  if (!found.is_table()) fail(key, fmt::format("is {}; write a table: [{}]", type_name(found), full(key)));
  return {*found.as_table(), origin_, full(key), place_of_};
}

std::vector<TomlTable> TomlTable::tables(std::string_view key, int size) {
  const toml::node& found = node(key);
  const toml::array* array = found.as_array();
  if (array == nullptr)
    fail(key, fmt::format("is {}; write an array of tables: [{{ ... }}, ...]", type_name(found)));
  if (size >= 0 && array->size() != static_cast<std::size_t>(size)) {
    fail(key, fmt::format("has {} elements; write exactly {}", array->size(), size));
  }
  std::vector<TomlTable> result;
  for (std::size_t i = 0; i < array->size(); ++i) {
    const toml::node& element = (*array)[i];
    if (!element.is_table()) fail(key, fmt::format("element {} is {}; write a table", i, type_name(element)));
    result.emplace_back(*element.as_table(), origin_, fmt::format("{}.{}", full(key), i), place_of_);
  }
  return result;
}

void TomlTable::finish() const {
  for (const auto& [key, value] : *table_) {
    const std::string_view name = key.str();
    if (std::find(known_.begin(), known_.end(), name) != known_.end()) continue;
    const std::string prefix = place_of_ ? place_of_(full(name)).prefix : "";
    fail(name, fmt::format("is not a known key; the nearest known one is {}{}", prefix,
                           full(nearest_name(name, known_))));
  }
}

}  // namespace phalanx
