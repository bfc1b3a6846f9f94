// SPDX-License-Identifier: Apache-2.0
// An unknown key is refused by name in every table of the shipped files.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "phalanx/scene/device_file.h"
#include "phalanx/scene/hand_file.h"
#include "phalanx/scene/mapping_file.h"
#include "phalanx/scene/patient_file.h"
#include "phalanx/scene/profile_file.h"
#include "phalanx/scene/scene.h"

namespace phalanx {
namespace {

/// The text with a key added to the table that begins at the file's top, below a line `[table]`, or after the
/// brace of an inline table: one text for each.
std::vector<std::string> with_an_unknown_key(const std::string& text) {
  std::vector<std::string> result = {"nobody_knows = 1\n" + text};
  for (std::size_t line = 0; line < text.size();) {
    const std::size_t end = std::min(text.find('\n', line), text.size());
    const std::string words = text.substr(line, end - line);
    const std::size_t brace = words.find("{ ");
    if (words.starts_with('[')) {
      result.push_back(std::string(text).insert(end, "\nnobody_knows = 1"));
    } else if (!words.starts_with('#') && brace != std::string::npos) {
      result.push_back(std::string(text).insert(line + brace + 2, "nobody_knows = 1, "));
    }
    line = end + 1;
  }
  return result;
}

/// @returns how many tables the files of the folder have
template <typename Read>
int refuses_in_each_table(const std::string& folder, Read read) {
  int tables = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PHALANX_SOURCE_DIR "/" + folder)) {
    if (entry.path().extension() != ".toml") continue;
    std::ifstream file(entry.path());
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    EXPECT_NO_THROW(read(text, entry.path())) << entry.path();
    for (const std::string& spoilt : with_an_unknown_key(text)) {
      ++tables;
      try {
        read(spoilt, entry.path());
        ADD_FAILURE() << entry.path() << ": accepted: " << spoilt;
      } catch (const SceneError& error) {
        EXPECT_THAT(std::string(error.what()), ::testing::HasSubstr("nobody_knows"));
      }
    }
  }
  return tables;
}

TEST(UnknownKeys, OfHands) {
  EXPECT_GT(
      refuses_in_each_table("assets/hands",
                            [](const std::string& text, const std::filesystem::path& file) {
                              static_cast<void>(parse_hand_file(text, file.string(), file.parent_path()));
                            }),
      40);  // four joints and three segments a digit
}
TEST(UnknownKeys, OfDevices) {
  EXPECT_GT(refuses_in_each_table("assets/devices",
                                  [](const std::string& text, const std::filesystem::path& file) {
                                    static_cast<void>(parse_device(text, file.string(), file.parent_path()));
                                  }),
            10);
}
TEST(UnknownKeys, OfPatients) {
  EXPECT_GT(refuses_in_each_table("assets/patients",
                                  [](const std::string& text, const std::filesystem::path& file) {
                                    static_cast<void>(parse_patient(text, file.string(), file.parent_path()));
                                  }),
            2);
}
TEST(UnknownKeys, OfProfiles) {
  EXPECT_GT(refuses_in_each_table("assets/profiles",
                                  [](const std::string& text, const std::filesystem::path& file) {
                                    static_cast<void>(parse_profile(text, file.string(), file.parent_path()));
                                  }),
            3);
}
TEST(UnknownKeys, OfMappings) {
  EXPECT_GT(refuses_in_each_table("assets/mappings",
                                  [](const std::string& text, const std::filesystem::path& file) {
                                    static_cast<void>(parse_mapping(text, file.string()));
                                  }),
            3);
}
TEST(UnknownKeys, OfScenes) {
  EXPECT_GT(refuses_in_each_table("scenes",
                                  [](const std::string& text, const std::filesystem::path& file) {
                                    static_cast<void>(parse_scene(text, file.string(), file.parent_path()));
                                  }),
            20);
}

}  // namespace
}  // namespace phalanx
