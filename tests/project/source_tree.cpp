// SPDX-License-Identifier: Apache-2.0
#include "project/source_tree.h"

#include <algorithm>
#include <fstream>
#include <stdexcept>

namespace phalanx::project {

const std::filesystem::path& root() {
  static const std::filesystem::path path = PHALANX_SOURCE_DIR;
  return path;
}

std::vector<std::filesystem::path> files_below(const std::string& folder,
                                               const std::vector<std::string>& extensions) {
  std::vector<std::filesystem::path> files;
  if (!std::filesystem::exists(root() / folder)) return files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root() / folder)) {
    if (!entry.is_regular_file()) continue;
    const auto& wanted = extensions;
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), entry.path().extension()) != wanted.end()) {
      files.push_back(std::filesystem::relative(entry.path(), root()));
    }
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream in(root() / file);
  if (!in) throw std::runtime_error("cannot read " + (root() / file).string());
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

}  // namespace phalanx::project
