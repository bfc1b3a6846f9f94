// SPDX-License-Identifier: Apache-2.0
#include "scene/text_file.h"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <system_error>

#include "phalanx/scene/scene.h"

namespace phalanx {

std::string read_text_file(const std::string& path, const std::string& what) {
  constexpr std::size_t kMostTextBytes = 16U << 20U;
  // Before it is opened: opening a named pipe waits until another program writes to it.
  std::error_code ignored;
  if (std::filesystem::exists(path, ignored) && !std::filesystem::is_regular_file(path, ignored))
    throw SceneError(fmt::format("{} file: {}", what, why_no_file(path)));
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw SceneError(fmt::format("{}: cannot be opened as a {} ({}); check the path and its permissions",
                                 path, what, std::strerror(errno)));
  std::string text;
  std::array<char, 16384> block;
  while (file && text.size() <= kMostTextBytes) {
    file.read(block.data(), block.size());
    text.append(block.data(), static_cast<std::size_t>(file.gcount()));
  }
  if (file.bad()) throw SceneError(fmt::format("{}: cannot be read as a {}; check the disk", path, what));
  if (text.size() > kMostTextBytes) {
    throw SceneError(
        fmt::format("{}: is larger than 16 MB; a {} file is a few kilobytes of TOML", path, what));
  }
  return text;
}

std::string why_no_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored)) return file.string() + " is a folder; name a file in it";
  if (std::filesystem::exists(file, ignored))
    return file.string() + " is not a regular file; copy its contents into a file";
  return fmt::format("there is no file {}; check the path", file.string());
}

}  // namespace phalanx
