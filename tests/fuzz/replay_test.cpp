// SPDX-License-Identifier: Apache-2.0
// Every input of the fuzz targets' corpora, once. A target ends the process where its demand does not hold;
// the last file named before that is the one.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

extern "C" {
int fuzz_device(const std::uint8_t* data, std::size_t size);
int fuzz_link(const std::uint8_t* data, std::size_t size);
int fuzz_mesh(const std::uint8_t* data, std::size_t size);
int fuzz_motion(const std::uint8_t* data, std::size_t size);
int fuzz_opengloves(const std::uint8_t* data, std::size_t size);
int fuzz_scene(const std::uint8_t* data, std::size_t size);
int fuzz_study(const std::uint8_t* data, std::size_t size);
}

namespace {

using Target = int (*)(const std::uint8_t*, std::size_t);

void replay(const std::string& name, Target target) {
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

TEST(FuzzReplay, DeviceFiles) { replay("fuzz_device", fuzz_device); }
TEST(FuzzReplay, LinkFrames) { replay("fuzz_link", fuzz_link); }
TEST(FuzzReplay, MeshFiles) { replay("fuzz_mesh", fuzz_mesh); }
TEST(FuzzReplay, MotionFiles) { replay("fuzz_motion", fuzz_motion); }
TEST(FuzzReplay, GloveMessages) { replay("fuzz_opengloves", fuzz_opengloves); }
TEST(FuzzReplay, SceneFiles) { replay("fuzz_scene", fuzz_scene); }
TEST(FuzzReplay, StudyFiles) { replay("fuzz_study", fuzz_study); }

}  // namespace
