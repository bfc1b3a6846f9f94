// SPDX-License-Identifier: Apache-2.0
// Both ends of the range of every number in a scene.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_keys.h"
#include "scene/expect_error.h"
#include "step/check_parameters.h"

namespace phalanx {
namespace {

/// Numbers next to an end of a range.
struct End {
  double inside;
  double outside;
};

/// @param away  +1 for the upper end, -1 for the lower
End end_of(const SceneKey& key, double end, bool open, double away) {
  // From 2^53 on the next integer that is a double is 2 away.
  if (key.type == KeyType::kInteger) return {end, end + (std::abs(end) < 0x1p53 ? away : 2 * away)};
  if (open) return {end - away * 1e-9 * (key.range.max - key.range.min), end};
  return {end, end == 0.0 ? away * 1e-300 : std::nextafter(end, away * kInfinity)};
}

std::vector<End> ends_of(const SceneKey& key) {
  return {end_of(key, key.range.min, key.range.min_open, -1.0),
          end_of(key, key.range.max, key.range.max_open, 1.0)};
}

bool is_numeric(const SceneKey& key) {
  return key.type == KeyType::kNumber || key.type == KeyType::kNumberOrOff || key.type == KeyType::kInteger ||
         key.type == KeyType::kVector;
}

/// The path of the key, of the first object if it is an object's.
std::string setting_of(const SceneKey& key) {
  return key.is_of_objects() ? "objects.0." + key.path.substr(std::string("objects[].").size()) : key.path;
}

/// What the scene must state besides, so that the ends of the key's range contradict no other key.
Overrides companions_of(const SceneKey& key) {
  Overrides others;
  if (key.path == "objects[].size_mm") {  // a teapot has a size > 0
    others = {{"objects.0.kind", "file"}, {"objects.0.file", "some.obj"}};
  } else if (key.is_of_objects()) {
    const std::string kind = key.kinds.empty() ? "sphere" : key.kinds.front().kind;
    others = {{"objects.0.kind", kind}};
    if (kind == "file") others.emplace_back("objects.0.file", "some.obj");
  }
  // A tube is thinner than its ring.
  if (key.path == "objects[].tube_diameter_mm") others.emplace_back("objects.0.ring_diameter_mm", "2000");
  if (key.path == "objects[].ring_diameter_mm") others.emplace_back("objects.0.tube_diameter_mm", "1e-9");
  // The bounds per tick become the largest bounds per second.
  if (key.path.starts_with("smoothing.m")) others.emplace_back("rate_hz", "4000");
  return others;
}

SceneDescription scene_with(const SceneKey& key, const std::string& value) {
  Overrides overrides = companions_of(key);
  overrides.emplace_back(setting_of(key), value);
  return parse_scene("", "test.toml", ".", overrides);
}

/// @returns the number as a value of the key; of a vector in each component, with 1 in the others.
std::vector<std::string> values_with(const SceneKey& key, double number) {
  if (key.type == KeyType::kInteger) return {std::to_string(static_cast<std::int64_t>(number))};
  const std::string text = shortest_text(number);
  if (key.type != KeyType::kVector) return {text};
  return {"[" + text + ", 1, 1]", "[1, " + text + ", 1]", "[1, 1, " + text + "]"};
}

void expect_key_accepted(const SceneKey& key, const std::string& value) {
  EXPECT_NO_THROW(check_parameters(scene_with(key, value).parameters)) << key.path << " = " << value;
}

void expect_key_refused(const SceneKey& key, const std::string& value) {
  SCOPED_TRACE(key.path + " = " + value);
  expect_scene_error([&] { static_cast<void>(scene_with(key, value)); }, {setting_of(key), "must be"});
}

TEST(KeyRanges, AreThoseOfTheReaderAndOfTheParameters) {
  int numeric = 0;
  for (const SceneKey& key : scene_keys()) {
    if (!is_numeric(key)) continue;
    ++numeric;
    for (const End& end : ends_of(key)) {
      for (const std::string& value : values_with(key, end.inside)) expect_key_accepted(key, value);
      for (const std::string& value : values_with(key, end.outside)) expect_key_refused(key, value);
    }
  }
  EXPECT_GE(numeric, 50);
}

TEST(KeyRanges, EndBelowInfinityUnlessTheySayMinusInfinity) {
  for (const SceneKey& key : scene_keys()) {
    if (key.type != KeyType::kNumber && key.type != KeyType::kNumberOrOff) continue;
    for (const char* value : {"inf", "nan"}) expect_key_refused(key, value);
    if (key.range.allows_minus_infinity)
      expect_key_accepted(key, "-inf");
    else
      expect_key_refused(key, "-inf");
    if (key.type == KeyType::kNumberOrOff) expect_key_accepted(key, "off");
  }
}

// toml++ gives no double for an integer beyond 2^53.
TEST(KeyRanges, RefuseAnIntegerThatNoDoubleHolds) {
  for (const SceneKey& key : scene_keys()) {
    if (!is_numeric(key)) continue;
    for (const char* number : {"9223372036854775807", "-9223372036854775808"}) {
      const std::string text = number;
      expect_key_refused(key, key.type == KeyType::kVector ? "[1, " + text + ", 1]" : text);
    }
  }
}

}  // namespace
}  // namespace phalanx
