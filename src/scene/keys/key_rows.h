// SPDX-License-Identifier: Apache-2.0
// The rows of scene_keys(): one function for each type of key, and one for each part of the table. keys_*.cpp
// have the parts, scene_keys.cpp has the table, unknown_keys.h the refusal of keys that it does not have.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "phalanx/core/constants.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_keys.h"

namespace phalanx {

/// Writer of rows of the table. All rows of one instance have the same ChangeKind.
class KeyRows {
 public:
  using Store = std::function<void(const KeyTarget&, const KeyValue&)>;

  KeyRows(std::vector<SceneKey>& keys, ChangeKind change) : keys_(keys), change_(change) {}

  void number(std::string path, std::string unit, NumberRange range, std::optional<double> default_value,
              std::string meaning, Store store) const;
  /// Appends a key of a number, or "off".
  void limit(std::string path, std::string unit, NumberRange range, double default_value, std::string meaning,
             Store store) const;
  void integer(std::string path, NumberRange range, std::optional<std::int64_t> default_value,
               std::string meaning, Store store) const;
  void flag(std::string path, bool default_value, std::string meaning, Store store) const;
  /// @param default_value  one of `choices`
  void choice(std::string path, std::vector<std::string> choices, const std::string& default_value,
              std::string meaning, Store store) const;
  /// @param default_value  of each component
  void vector(std::string path, std::string unit, NumberRange range, double default_value,
              std::string meaning, Store store) const;
  /// @param type  kText, kFile or kName
  void word(KeyType type, std::string path, std::optional<std::string> default_value, std::string meaning,
            Store store) const;

 private:
  /// Appends a row without range and default. @returns the row, valid until the next one is appended
  SceneKey& add(KeyType type, std::string path, std::string meaning, Store store) const;

  std::vector<SceneKey>& keys_;
  ChangeKind change_;
};

/// @returns the range of a number in a key's unit. Its ends are rounded to 12 digits, because the factors of
/// units are not exact in binary.
/// @param unit  size of the unit in SI units: kMm for mm
[[nodiscard]] NumberRange in_unit(NumberRange range, double unit);

/// @returns the rotation by roll, pitch, yaw in degrees:  R = Rz(yaw) Ry(pitch) Rx(roll).
[[nodiscard]] Mat3 rotation_of(const Vec3& roll_pitch_yaw_deg);

void add_general_keys(std::vector<SceneKey>& keys);
void add_object_keys(std::vector<SceneKey>& keys);
void add_force_keys(std::vector<SceneKey>& keys);
void add_motion_keys(std::vector<SceneKey>& keys);
void add_device_keys(std::vector<SceneKey>& keys);

}  // namespace phalanx
