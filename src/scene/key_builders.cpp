// SPDX-License-Identifier: Apache-2.0
#include "scene/key_builders.h"

namespace phalanx {

KeySpec number(std::string path, std::string unit, NumberRange range, std::string fallback,
               std::string meaning, StoreKey store) {
  return {std::move(path),     KeyType::kNumber,   std::move(unit),  range, {},
          std::move(fallback), std::move(meaning), std::move(store), ""};
}

KeySpec integer(std::string path, NumberRange range, std::string fallback, std::string meaning,
                StoreKey store) {
  return {std::move(path),    KeyType::kInteger, "", range, {}, std::move(fallback),
          std::move(meaning), std::move(store),  ""};
}

KeySpec choice(std::string path, std::vector<std::string> choices, std::string fallback, std::string meaning,
               StoreKey store) {
  return {std::move(path),    KeyType::kChoice, "", {}, std::move(choices), std::move(fallback),
          std::move(meaning), std::move(store), ""};
}

KeySpec vector(std::string path, std::string unit, NumberRange range, std::string fallback,
               std::string meaning, StoreKey store) {
  return {std::move(path),     KeyType::kVector,   std::move(unit),  range, {},
          std::move(fallback), std::move(meaning), std::move(store), ""};
}

KeySpec word(KeyType type, std::string path, std::string fallback, std::string meaning, StoreKey store) {
  return {std::move(path), type, "", {}, {}, std::move(fallback), std::move(meaning), std::move(store), ""};
}

KeySpec flag(std::string path, std::string fallback, std::string meaning, StoreKey store) {
  return word(KeyType::kFlag, std::move(path), std::move(fallback), std::move(meaning), std::move(store));
}

KeySpec limit(std::string path, std::string unit, NumberRange range, std::string fallback,
              std::string meaning, StoreKey store) {
  KeySpec spec = number(std::move(path), std::move(unit), range, std::move(fallback), std::move(meaning),
                        std::move(store));
  spec.type = KeyType::kNumberOrOff;
  return spec;
}

KeySpec for_kinds(std::string kinds, KeySpec spec,
                  std::vector<std::pair<std::string, std::string>> kind_defaults) {
  spec.kinds = std::move(kinds);
  spec.kind_defaults = std::move(kind_defaults);
  return spec;
}

/// Roll, pitch, yaw in degrees:  R = Rz(yaw) Ry(pitch) Rx(roll).
Mat3 rotation_of(const Vec3& roll_pitch_yaw_deg) {
  const Vec3 angle = roll_pitch_yaw_deg * kDeg;
  return rotation_about(Vec3::UnitZ(), angle.z()) * rotation_about(Vec3::UnitY(), angle.y()) *
         rotation_about(Vec3::UnitX(), angle.x());
}

}  // namespace phalanx
