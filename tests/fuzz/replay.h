// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

namespace phalanx::test {

/// A fuzz target. It ends the process where its demand does not hold: the last file named before that is the
/// one.
using FuzzTarget = int (*)(const std::uint8_t*, std::size_t);

/// Every input of the corpus of this name, once.
inline void replay(const std::string& name, FuzzTarget target) {
  const std::filesystem::path corpus = std::filesystem::path(PHALANX_SOURCE_DIR) / "tests/fuzz/corpus" / name;
  int inputs = 0;
  for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
    std::cout << entry.path().filename().string() << std::endl;
    std::ifstream file(entry.path(), std::ios::binary);
    // Exactly as long as the file, so that a read past its end is seen.
    const std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
    ASSERT_EQ(bytes.size(), entry.file_size()) << entry.path();
    EXPECT_EQ(target(bytes.data(), bytes.size()), 0) << entry.path();
    ++inputs;
  }
  EXPECT_GT(inputs, 0) << corpus << " is empty";
}

}  // namespace phalanx::test
