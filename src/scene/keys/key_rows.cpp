// SPDX-License-Identifier: Apache-2.0
#include "scene/keys/key_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

namespace phalanx {

SceneKey& KeyRows::add(KeyType type, std::string path, std::string meaning, Store store) const {
  SceneKey& key = keys_.emplace_back();
  key.path = std::move(path);
  key.type = type;
  key.change = change_;
  key.meaning = std::move(meaning);
  key.store = std::move(store);
  return key;
}

void KeyRows::number(std::string path, std::string unit, NumberRange range,
                     std::optional<double> default_value, std::string meaning, Store store) const {
  SceneKey& key = add(KeyType::kNumber, std::move(path), std::move(meaning), std::move(store));
  key.unit = std::move(unit);
  key.range = range;
  if (default_value) key.default_value.emplace().number = *default_value;
}

void KeyRows::limit(std::string path, std::string unit, NumberRange range, double default_value,
                    std::string meaning, Store store) const {
  number(std::move(path), std::move(unit), range, default_value, std::move(meaning), std::move(store));
  keys_.back().type = KeyType::kNumberOrOff;
}

void KeyRows::integer(std::string path, NumberRange range, std::optional<std::int64_t> default_value,
                      std::string meaning, Store store) const {
  SceneKey& key = add(KeyType::kInteger, std::move(path), std::move(meaning), std::move(store));
  key.range = range;
  if (default_value) key.default_value.emplace().integer = *default_value;
}

void KeyRows::flag(std::string path, bool default_value, std::string meaning, Store store) const {
  SceneKey& key = add(KeyType::kFlag, std::move(path), std::move(meaning), std::move(store));
  key.default_value.emplace().flag = default_value;
}

void KeyRows::choice(std::string path, std::vector<std::string> choices, const std::string& default_value,
                     std::string meaning, Store store) const {
  SceneKey& key = add(KeyType::kChoice, std::move(path), std::move(meaning), std::move(store));
  key.choices = std::move(choices);
  KeyValue& value = key.default_value.emplace();
  value.text = default_value;
  value.integer = std::find(key.choices.begin(), key.choices.end(), default_value) - key.choices.begin();
}

void KeyRows::vector(std::string path, std::string unit, NumberRange range, double default_value,
                     std::string meaning, Store store) const {
  SceneKey& key = add(KeyType::kVector, std::move(path), std::move(meaning), std::move(store));
  key.unit = std::move(unit);
  key.range = range;
  key.default_value.emplace().vector = Vec3::Constant(default_value);
}

void KeyRows::word(KeyType type, std::string path, std::optional<std::string> default_value,
                   std::string meaning, Store store) const {
  SceneKey& key = add(type, std::move(path), std::move(meaning), std::move(store));
  if (default_value) key.default_value.emplace().text = *std::move(default_value);
}

NumberRange in_unit(NumberRange range, double unit) {
  const auto rounded = [](double value) { return std::stod(fmt::format("{:.12g}", value)); };
  range.min = rounded(range.min / unit);
  range.max = rounded(range.max / unit);
  return range;
}

Mat3 rotation_of(const Vec3& roll_pitch_yaw_deg) {
  const Vec3 angle = roll_pitch_yaw_deg * kDeg;
  return rotation_about(Vec3::UnitZ(), angle.z()) * rotation_about(Vec3::UnitY(), angle.y()) *
         rotation_about(Vec3::UnitX(), angle.x());
}

}  // namespace phalanx
