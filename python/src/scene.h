// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string>

#include "binding.h"
#include "phalanx/mesh/triangle_mesh.h"
#include "phalanx/scene/resolved_scene.h"
#include "phalanx/scene/scene.h"
#include "phalanx/scene/scene_file.h"

namespace phalanx::python {

/// A scene as Python holds it: its file's text, the values that were set, and a mesh of the user in place of
/// its objects. Copies share the mesh.
class Scene {
 public:
  /// @throws SceneError as SceneFile::scene()
  Scene(SceneFile file, std::string origin, const py::dict& set);

  [[nodiscard]] const std::string& origin() const noexcept { return origin_; }
  [[nodiscard]] SceneDescription description() const;
  [[nodiscard]] SceneWithValues with_values() const { return file_.with_values(overrides_); }

  /// Sets one key. If the scene is not valid with it, nothing is changed.
  /// @throws SceneError as SceneFile::scene(), py::type_error for a value that no key can have
  void set(const std::string& key, const py::handle& value);
  /// Sets several keys, all or none.
  void set_all(const py::dict& values);
  [[nodiscard]] Scene with_mesh(TriangleMesh mesh, std::optional<double> friction) const;

  /// Reads all files of the scene. Call it without the GIL.
  /// @throws as phalanx::resolve()
  [[nodiscard]] ResolvedScene resolve(const ResolveOptions& options) const;

 private:
  struct Mesh {
    TriangleMesh mesh;
    std::optional<double> friction;
  };

  SceneFile file_;
  std::string origin_;
  Overrides overrides_;
  std::shared_ptr<const Mesh> mesh_;  ///< null: the scene's own objects
};

}  // namespace phalanx::python
