// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "phalanx/scene/scene.h"

namespace phalanx {

/// A mesh that a page has sent, and how it is to be read.
struct UploadedMesh {
  std::string name;  ///< as the person's computer calls it; only its letters, digits, - and _ are used
  std::string bytes;
  double size_mm = 0.0;    ///< largest extent; 0: keeps the file's numbers
  std::string unit = "m";  ///< of these
};

/// From "name=mug.stl&size_mm=90": percent-coded, as browsers write it.
/// @throws std::invalid_argument naming what is wrong
[[nodiscard]] UploadedMesh upload_of(const std::string& query, std::string bytes);

/// What the scene in force states, as HostState::values; none: nobody waits for this mesh any more.
using ValuesInForce = std::function<std::optional<Overrides>()>;

constexpr std::size_t kMostUploadedTriangles = 500'000;  ///< checking more would take minutes

/// Reads and checks the mesh and, if a scene could take it, puts it into the folder, of whose uploads it
/// keeps the newest 50 and those that the scene in force names. Files whose names are not of take_upload()'s
/// own form are somebody else's and stay.
/// @param in_force  asked before each step, so that work that nobody waits for ends with the step
/// @returns a JSON object: ok; error (if not); file: what objects.N.file is to be; report: docs/meshes.md
/// Does not throw for a bad mesh. Forks, takes long.
[[nodiscard]] std::string take_upload(const UploadedMesh& mesh, const std::filesystem::path& folder,
                                      const ValuesInForce& in_force);

}  // namespace phalanx
