// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/data_paths.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

#include "phalanx/core/nearest_name.h"
#include "phalanx/scene/scene.h"
#include "scene/text_file.h"

namespace phalanx {
namespace fs = std::filesystem;
namespace {

bool holds_data(const fs::path& folder) {
  std::error_code ignored;
  return fs::is_directory(folder / "scenes", ignored) && fs::is_directory(folder / "assets", ignored);
}

}  // namespace

fs::path data_folder() {
  if (const char* given = std::getenv("PHALANX_DATA_DIR"); given != nullptr && *given != '\0') {
    if (holds_data(given)) return given;
    throw SceneError(fmt::format(
        "PHALANX_DATA_DIR = {}: this folder has no scenes/ and assets/; name one that has, or unset it",
        given));
  }
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  std::vector<std::string> tried;
  if (!error) tried.push_back((program.parent_path() / "../share/phalanx").lexically_normal());
  // A shared library has the code of this function: libphalanx.so.0, or a module of Python.
  Dl_info own{};
  if (::dladdr(reinterpret_cast<const void*>(&data_folder), &own) != 0 && own.dli_fname != nullptr)
    if (const fs::path folder = fs::absolute(own.dli_fname, error).parent_path(); !error)
      for (const char* up : {"../share/phalanx", "../../share/phalanx", "../../../../share/phalanx"})
        if (fs::path beside = (folder / up).lexically_normal();
            std::find(tried.begin(), tried.end(), beside.string()) == tried.end())
          tried.push_back(beside);
  for (const char* configured : {PHALANX_SOURCE_TREE, PHALANX_INSTALLED_DATA})
    if (*configured != '\0') tried.emplace_back(configured);
  for (const std::string& folder : tried)
    if (holds_data(folder)) return folder;
  throw SceneError(fmt::format(
      "there is no folder with scenes/ and assets/ at {}; set PHALANX_DATA_DIR to the folder that has them",
      fmt::join(tried, " or ")));
}

fs::path find_data_file(const std::string& what, const std::string& name, const std::string& folder,
                        const std::string& extension, const fs::path& base) {
  if (name.empty())
    throw SceneError(fmt::format("{} \"\": the name is empty; give a name in {} or a path", what, folder));
  if (name.find('\0') != std::string::npos)
    throw SceneError(fmt::format("{}: the name holds a zero byte; remove it", what));
  std::error_code ignored;
  const bool is_path = name.find('/') != std::string::npos || fs::path(name).extension() == extension;
  if (is_path) {
    const fs::path file = base / name;
    if (fs::is_regular_file(file, ignored)) return file;
    throw SceneError(fmt::format("{} \"{}\": {}", what, name, why_no_file(file)));
  }
  const fs::path root = data_folder() / folder;
  const fs::path file = root / (name + extension);
  if (fs::is_regular_file(file, ignored)) return file;
  const auto known = names_in_folder(root, extension);
  throw SceneError(fmt::format("{} \"{}\": there is no {}; {}Known: {}", what, name, file.string(),
                               did_you_mean(name, known), fmt::join(known, ", ")));
}

std::vector<std::string> names_in_folder(const fs::path& folder, const std::string& extension) {
  std::vector<std::string> names;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (it->path().extension() == extension) names.push_back(it->path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace phalanx
