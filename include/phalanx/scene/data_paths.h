// SPDX-License-Identifier: Apache-2.0
// The folders of the program's own scenes and assets.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace phalanx {

/// Finds the folder that holds scenes/ and assets/. It is the environment's PHALANX_DATA_DIR if set.
/// Otherwise it is the first of these folders that has both: ../share/phalanx beside the running program's
/// folder (an installed program); ../share/phalanx, ../../share/phalanx or ../../../../share/phalanx beside the
/// folder of a shared library that holds this function (libphalanx.so.0, or Python's module); the source tree from which the library was built; share/phalanx of the
/// prefix that CMake was configured with.
/// @throws SceneError naming the places that were tried if none has a scenes/ and an assets/
/// folder. Set-up only.
[[nodiscard]] std::filesystem::path data_folder();

/// Finds a data file by bare name (`folder`/`name``extension` in data_folder()) or by path. `name` is a
/// path if it contains a `/` or ends with `extension`; a relative path is searched in `base`.
/// @param what    kind of file, for messages: "hand", "scene"
/// @param folder  "assets/hands", "scenes", ...
/// @throws SceneError if there is no such file; for a bare name it names the nearest existing
/// one. Set-up only.
[[nodiscard]] std::filesystem::path find_data_file(const std::string& what, const std::string& name,
                                                   const std::string& folder, const std::string& extension,
                                                   const std::filesystem::path& base);

/// @returns the sorted names, without extension, of a folder's files with this extension; none if the
/// folder cannot be read. Set-up only.
[[nodiscard]] std::vector<std::string> names_in_folder(const std::filesystem::path& folder,
                                                       const std::string& extension);

}  // namespace phalanx
