// SPDX-License-Identifier: Apache-2.0
// Where the program's own scenes/ and assets/ are.
#pragma once

#include <filesystem>
#include <string>

namespace phalanx {

/// The folder that holds scenes/ and assets/: the environment's PHALANX_DATA if set; else ../share/phalanx
/// beside the running program's folder if it is there (an installed program); else the source tree that the
/// program was built from.
/// @throws SceneError if none of them has a scenes/ and an assets/ folder, naming the places that were tried.
/// Set-up only.
[[nodiscard]] std::filesystem::path data_folder();

/// A data file by bare name (`folder`/`name``extension` in data_folder()) or by path. `name` is a path if it
/// contains a `/` or ends with `extension`; a relative path is looked for in `base`.
/// @param what    what the file is, for messages: "hand", "scene"
/// @param folder  "assets/hands", "scenes", ...
/// @throws SceneError if there is no such file; a bare name is answered with the nearest one that exists.
/// Set-up only.
[[nodiscard]] std::filesystem::path find_data_file(const std::string& what, const std::string& name,
                                                   const std::string& folder, const std::string& extension,
                                                   const std::filesystem::path& base);

}  // namespace phalanx
