// SPDX-License-Identifier: Apache-2.0
// `phalanx session`, `replay` and `simulate --motion` with an encrypted recording, with its key
// file and without.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "apps/run_program.h"
#include "phalanx/registry/key_store.h"
#include "record/mcap/encrypted_file.h"
#include "record/temporary_folder.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using testing::TemporaryFolder;

constexpr const char* kId = "00112233445566778899aabbccddeeff";

/// A folder with one encrypted recording of a second, and a key file that has its key.
class CliSessionKeys : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(run_program(folder, "run index_ball --headless --no-realtime --quiet --seconds 1").exit_code,
              0);
    for (const auto& entry : fs::directory_iterator(folder / "out/recordings")) file = entry.path();
    KeyStore store = KeyStore::create(folder / "keys");
    const std::string plain = testing::read_file(file);
    fs::remove(file);
    file += ".enc";
    mcap::DiskFile disk(file);
    mcap::EncryptedFile encrypted(disk, {.id = kId, .key = store.add(kId)});
    // In the writes of a recorder: the beginning, a chunk, the end.
    encrypted.write(0, plain.substr(0, 1000));
    encrypted.write(1000, plain.substr(1000));
  }
  /// @returns what a command says, with its exit code before it; without --keys there is no key
  std::string said(const std::string& command) {
    const auto result = run_program(folder, command, ".out", "export PHALANX_KEYS=$PWD/none");
    return std::to_string(result.exit_code) + " " + result.out + result.err;
  }

  const TemporaryFolder folder;
  fs::path file;
};

TEST_F(CliSessionKeys, WithTheKeysEveryCommandReadsIt) {
  const std::string name = file.filename().string();
  EXPECT_THAT(said("session list --keys keys"), AllOf(HasSubstr(name), HasSubstr("index_ball       whole")));
  const std::string shown = said("session show last --quiet --keys keys");
  EXPECT_THAT(shown, AllOf(StartsWith("0 "), HasSubstr("scene index_ball"), HasSubstr("is not encrypted")));
  const fs::path page = folder / "out/recordings" / (file.stem().stem().string() + ".html");
  ASSERT_TRUE(fs::exists(page)) << "beside the recording, without both of its endings";
  EXPECT_EQ(fs::status(page).permissions(), fs::perms::owner_read | fs::perms::owner_write);
  EXPECT_THAT(said("replay " + name + " --quiet --keys keys"),
              HasSubstr("every force, angle and command has the same bits"));
  EXPECT_THAT(said("session export last --quiet --keys keys --out tables"), StartsWith("0 "));
  EXPECT_EQ(fs::status(folder / "tables").permissions(), fs::perms::owner_all);
  EXPECT_THAT(said("simulate pinch_ball --quiet --seconds 0.2 --keys keys --motion out/recordings/" + name +
                   " --out played"),
              StartsWith("0 "));
  EXPECT_TRUE(fs::exists(folder / "played/ticks.csv"));
}

TEST_F(CliSessionKeys, WithoutTheKeysItIsRefusedInWordsAndStillListedAndDeleted) {
  const std::string name = file.filename().string();
  EXPECT_THAT(said("session list"), AllOf(HasSubstr(name), HasSubstr("encrypted, no key")));
  const std::vector<std::string> commands = {"session show last", "session export last", "replay last",
                                             "simulate pinch_ball --motion out/recordings/" + name};
  for (const std::string& command : commands)
    EXPECT_THAT(said(command), AllOf(Not(StartsWith("0 ")), HasSubstr(kId), HasSubstr("--keys FILE")))
        << command;
  EXPECT_THAT(said("session list --keys nowhere"), AllOf(StartsWith("2 "), HasSubstr("nowhere")));
  EXPECT_THAT(said("session delete last --yes"), HasSubstr("deleted out/recordings/" + name));
}

TEST_F(CliSessionKeys, ARepairKeepsFramesWithoutTheKeysAndMakesTheEndWithThem) {
  fs::resize_file(file, fs::file_size(file) - 30);
  EXPECT_THAT(said("session repair last"),
              AllOf(StartsWith("0 "), HasSubstr("1 frames are whole and kept"), HasSubstr("--keys FILE")));
  EXPECT_THAT(said("session list"), HasSubstr("encrypted, no key, no end: repair"));
  EXPECT_THAT(said("session repair last --keys keys"),
              AllOf(StartsWith("0 "), HasSubstr("it is whole again")));
  EXPECT_THAT(said("session list --keys keys"), HasSubstr("whole"));
}

}  // namespace
}  // namespace phalanx
