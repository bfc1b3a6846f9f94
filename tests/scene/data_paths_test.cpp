// SPDX-License-Identifier: Apache-2.0
#include "phalanx/scene/data_paths.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "scene/expect_error.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

/// Sets PHALANX_DATA_DIR for one test.
class DataPaths : public ::testing::Test {
 protected:
  void SetUp() override {
    if (const char* before = std::getenv("PHALANX_DATA_DIR")) before_ = before;
    unsetenv("PHALANX_DATA_DIR");
    folder_ = fs::temp_directory_path() / ("phalanx_data_paths_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override {
    fs::remove_all(folder_);
    if (before_.empty()) {
      unsetenv("PHALANX_DATA_DIR");
    } else {
      setenv("PHALANX_DATA_DIR", before_.c_str(), 1);
    }
  }
  fs::path folder_;
  std::string before_;
};

TEST_F(DataPaths, AreTheSourceTreesIfNothingElseIsSaid) {
  EXPECT_TRUE(fs::equivalent(data_folder(), PHALANX_SOURCE_DIR));
}

TEST_F(DataPaths, AreTheEnvironmentsIfItNamesThem) {
  fs::create_directories(folder_ / "scenes");
  fs::create_directories(folder_ / "assets/hands");
  setenv("PHALANX_DATA_DIR", folder_.c_str(), 1);
  EXPECT_EQ(data_folder(), folder_);
  std::ofstream(folder_ / "assets/hands/mine.toml") << "x";
  EXPECT_EQ(find_data_file("hand", "mine", "assets/hands", ".toml", "."), folder_ / "assets/hands/mine.toml");
}

TEST_F(DataPaths, RefuseAnEnvironmentWithoutData) {
  setenv("PHALANX_DATA_DIR", folder_.c_str(), 1);
  expect_scene_error([] { static_cast<void>(data_folder()); },
                     {"PHALANX_DATA_DIR", folder_.string(), "unset it"});
}

TEST_F(DataPaths, TakeAPathAsAPath) {
  std::ofstream(folder_ / "mine.toml") << "x";
  EXPECT_EQ(find_data_file("hand", "mine.toml", "assets/hands", ".toml", folder_), folder_ / "mine.toml");
  EXPECT_EQ(find_data_file("hand", (folder_ / "mine.toml").string(), "assets/hands", ".toml", "/"),
            folder_ / "mine.toml");
}

TEST_F(DataPaths, RefuseAnEmptyName) {
  expect_scene_error([] { static_cast<void>(find_data_file("hand", "", "assets/hands", ".toml", ".")); },
                     {"is empty"});
}

}  // namespace
}  // namespace phalanx
