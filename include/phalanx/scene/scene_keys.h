// SPDX-License-Identifier: Apache-2.0
// The table of all keys of a scene file. It serves to read and check scenes and to change a running station.
// `scene keys`, docs/scenes.md and the cockpit list it.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "phalanx/core/math.h"
#include "phalanx/core/number_range.h"

namespace phalanx {

struct ObjectDescription;
struct SceneDescription;

/// Type of a key's value.
enum class KeyType {
  kNumber,
  kNumberOrOff,  ///< a number, or the string "off"
  kInteger,
  kFlag,
  kText,
  kChoice,
  kVector,  ///< three numbers
  kFile,    ///< a path, relative to the scene file
  kName,    ///< a name in one of the program's folders, or a path
};

/// Requirement of a change of a key in a running station, in increasing order.
enum class ChangeKind {
  kInContact,     ///< changes smoothly: stiffness, damping, bounds on the force's change
  kAtZeroTorque,  ///< other parameters, for example the law
  kOtherObject,   ///< another model, at zero torque
  kNewStation,    ///< limits (the controller is told them when its session begins), hand, rate, device,
                  ///< patient, motion
};

/// A checked value; the key's type decides which member holds it.
struct KeyValue {
  double number = 0.0;
  bool off = false;
  std::int64_t integer = 0;  ///< of a choice: its index
  bool flag = false;
  std::string text;
  Vec3 vector = Vec3::Zero();
};

/// Destination of a value.
struct KeyTarget {
  SceneDescription& scene;
  ObjectDescription& object;  ///< the element of objects[] that is being read
};

/// A kind of object that has a key.
struct KindWithKey {
  std::string kind;
  std::optional<KeyValue> own_default;  ///< none: the key's default
};

/// A row of the table.
struct SceneKey {
  std::string path;  ///< "force.law"; "objects[].kind" for the elements of an array
  KeyType type = KeyType::kNumber;
  std::string unit;                             ///< "mm", "N/mm", ...; empty if it has none
  NumberRange range;                            ///< of a number, and of each component of a vector
  std::vector<std::string> choices;             ///< of kChoice
  std::optional<KeyValue> default_value;        ///< none: an absent key stores nothing
  ChangeKind change = ChangeKind::kNewStation;  ///< the largest requirement that a change of the key may have
  std::string meaning;                          ///< one line
  std::vector<KindWithKey> kinds;               ///< of objects[]: the kinds that have this key; empty: all
  std::function<void(const KeyTarget&, const KeyValue&)> store;

  [[nodiscard]] bool is_of_objects() const { return path.starts_with("objects[]."); }
  /// @returns true for a key of the scene itself, and for an object's key if objects of this kind have it
  [[nodiscard]] bool belongs_to(std::string_view kind) const;
  /// @returns the default for objects of this kind
  [[nodiscard]] const std::optional<KeyValue>& default_for(std::string_view kind) const;
  /// @returns true if the value is a path: of kFile always, of kName if `text` has a `/` or ends with .toml
  [[nodiscard]] bool is_path(const std::string& text) const;
};

/// @returns the table, in the order of the documentation. Values are stored in this order too: `rate_hz` comes
/// before the keys that depend on it. The first call makes it.
[[nodiscard]] const std::vector<SceneKey>& scene_keys();

/// @returns the row of a path as in SceneKey::path; null if no key has it. O(number of keys).
[[nodiscard]] const SceneKey* find_scene_key(std::string_view path);

/// Converts "objects.0.size_mm" to "objects[].size_mm".
[[nodiscard]] std::string pattern_of(std::string_view path);

/// @returns the requirement in the table of a path ("objects.0.size_mm"). For a path without a row, such as a
/// whole table or a key of the device's file, it is the largest of the keys in the same table. It is at least
/// kAtZeroTorque.
[[nodiscard]] ChangeKind change_kind(const std::string& path);

/// @returns the requirement in words: "at once", "at zero torque", "another object", "new station".
[[nodiscard]] std::string_view change_text(ChangeKind change);

/// Describes the allowed values: "> 0, <= 15, or \"off\"", or the choices; empty: any.
[[nodiscard]] std::string range_text(const SceneKey& key);

/// @returns a value as written in a file.
[[nodiscard]] std::string value_text(const SceneKey& key, const KeyValue& value);

/// A row as text, for a list of all keys.
struct SceneKeyText {
  std::string type;  ///< number, integer, flag, text, choice, vector, file, name, number or "off"
  std::string range;
  std::string default_value;  ///< as written in a file; empty: no default
  std::string change;         ///< as change_text()
  std::string meaning;        ///< with the kinds of object that have the key, and their own defaults
};
[[nodiscard]] SceneKeyText text_of(const SceneKey& key);

/// @returns all rows as the Markdown table of docs/scenes.md.
[[nodiscard]] std::string scene_keys_markdown();

}  // namespace phalanx
