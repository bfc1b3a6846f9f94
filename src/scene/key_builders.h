// SPDX-License-Identifier: Apache-2.0
// How the key table is written down: one function for each type of key, and one for each part of the table.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "phalanx/core/constants.h"
#include "scene/key_table.h"

namespace phalanx {

[[nodiscard]] constexpr NumberRange between(double min, double max) { return {.min = min, .max = max}; }
[[nodiscard]] constexpr NumberRange above(double min, double max) {
  return {.min = min, .max = max, .min_open = true};
}

/// Puts one checked value into the description.
using StoreKey = std::function<void(const KeyTarget&, const KeyValue&)>;

[[nodiscard]] KeySpec number(std::string path, std::string unit, NumberRange range, std::string fallback,
                             std::string meaning, StoreKey store);
[[nodiscard]] KeySpec integer(std::string path, NumberRange range, std::string fallback, std::string meaning,
                              StoreKey store);
[[nodiscard]] KeySpec choice(std::string path, std::vector<std::string> choices, std::string fallback,
                             std::string meaning, StoreKey store);
[[nodiscard]] KeySpec vector(std::string path, std::string unit, NumberRange range, std::string fallback,
                             std::string meaning, StoreKey store);
/// A text, a file or a name.
[[nodiscard]] KeySpec word(KeyType type, std::string path, std::string fallback, std::string meaning,
                           StoreKey store);
[[nodiscard]] KeySpec flag(std::string path, std::string fallback, std::string meaning, StoreKey store);
/// A number, or "off".
[[nodiscard]] KeySpec limit(std::string path, std::string unit, NumberRange range, std::string fallback,
                            std::string meaning, StoreKey store);
/// The key for these kinds of object only, each with its own default where one is given.
[[nodiscard]] KeySpec for_kinds(std::string kinds, KeySpec spec,
                                std::vector<std::pair<std::string, std::string>> kind_defaults = {});

/// Roll, pitch, yaw in degrees:  R = Rz(yaw) Ry(pitch) Rx(roll).
[[nodiscard]] Mat3 rotation_of(const Vec3& roll_pitch_yaw_deg);

void add_general_keys(std::vector<KeySpec>& keys);
void add_object_keys(std::vector<KeySpec>& keys);
void add_force_keys(std::vector<KeySpec>& keys);
void add_motion_keys(std::vector<KeySpec>& keys);
void add_device_keys(std::vector<KeySpec>& keys);

}  // namespace phalanx
