// SPDX-License-Identifier: Apache-2.0
#include "study/laboratory/fingerprint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>

#include "phalanx/record/made.h"

namespace phalanx {
namespace {

std::string name_and_content(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  Fingerprint content;
  std::array<char, 65536> block;
  while (stream) {
    stream.read(block.data(), block.size());
    content.add({block.data(), static_cast<std::size_t>(stream.gcount())});
  }
  if (!stream.eof()) throw std::runtime_error(fmt::format("{}: cannot be read", file.string()));
  return fmt::format("{} {}\n", file.filename().string(), content.text());
}

template <class T>
void sort_and_unite(std::vector<T>& list) {
  std::sort(list.begin(), list.end());
  list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace

void Fingerprint::add(std::string_view bytes) noexcept {
  for (const char byte : bytes) value_ = (value_ ^ static_cast<unsigned char>(byte)) * 0x100000001b3ULL;
}

std::string Fingerprint::text() const { return fmt::format("{:016x}", value_); }

std::string fingerprint_of_files(std::vector<std::filesystem::path> files) {
  sort_and_unite(files);
  std::vector<std::string> contents;
  for (const auto& file : files) contents.push_back(name_and_content(file));
  sort_and_unite(contents);
  Fingerprint all;
  for (const std::string& content : contents) all.add(content);
  return all.text();
}

std::string libm_text() { return fmt::format("{:016x}", libm_fingerprint()); }

}  // namespace phalanx
