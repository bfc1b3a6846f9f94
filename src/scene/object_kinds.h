// SPDX-License-Identifier: Apache-2.0
// The table of the kinds of objects: name, keys and the function that makes the mesh.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/mesh/triangle_mesh.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_keys.h"

namespace phalanx {

class ImportCache;

/// A key of objects[] that not all kinds have.
struct KeyOfKind {
  KeyOfKind(const char* key) : name(key) {}  // NOLINT(google-explicit-constructor): a row names its keys
  KeyOfKind(const char* key, double number) : name(key) { default_value.emplace().number = number; }
  KeyOfKind(const char* key, const Vec3& vector) : name(key) { default_value.emplace().vector = vector; }

  std::string name;                       ///< "diameter_mm"
  std::optional<KeyValue> default_value;  ///< none: the key's own default
};

/// Inputs of an object's mesh besides its description.
struct ObjectInputs {
  std::size_t index = 0;           ///< of the object in its scene, for messages
  ImportCache* imports = nullptr;  ///< for a mesh file; null: none
};

/// A row of the table.
struct ObjectKind {
  std::string name;
  std::vector<KeyOfKind> keys;  ///< besides those that all kinds have
  /// Makes the mesh in the object's frame O [m].
  /// @throws SceneError or std::invalid_argument naming the file or the size and the remedy
  TriangleMesh (*make)(const ObjectDescription& object, const ObjectInputs& inputs);
};

/// @returns the kinds in the order of the documentation.
[[nodiscard]] const std::vector<ObjectKind>& object_kinds();
[[nodiscard]] std::vector<std::string> object_kind_names();

/// Calls make() of the object's kind. @throws as that, and SceneError for an unknown kind. Set-up only.
[[nodiscard]] TriangleMesh make_object(const ObjectDescription& object, const ObjectInputs& inputs);

}  // namespace phalanx
