// SPDX-License-Identifier: Apache-2.0
// The program itself: what is typed at its terminal stands in the log of changes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using ::testing::Pair;

TEST(Typed, EveryWordIsLoggedAsTheTerminals) {
  const testing::TemporaryFolder folder;
  const std::string command =
      "cd '" + folder.path().string() +
      "' && printf 'stop\\nslow 1\\nnonsense\\nslow 1e9\\nresume\\nreset\\nquit\\n' | "
      "PHALANX_DATA='" PHALANX_SOURCE_DIR "' '" PHALANX_PROGRAM
      "' run --device sliders --port 0 --no-realtime --quiet --slow-motion 4 "
      "--audit changes.jsonl >out 2>err";
  ASSERT_EQ(std::system(command.c_str()), 0)  // NOLINT(cert-env33-c): the shell is the user's side here
      << testing::read_file(folder / "err");
  std::istringstream text(testing::read_file(folder / "changes.jsonl"));
  std::vector<std::pair<std::string, std::string>> told;
  for (std::string line; std::getline(text, line);) {
    const auto change = nlohmann::json::parse(line);
    EXPECT_EQ(change["who"], "the terminal");
    told.emplace_back(change["code"], change["text"]);
  }
  EXPECT_THAT(told, ElementsAre(Pair("stopped", "stopped"), Pair("slow", "makes every step 1 ms longer"),
                                Pair("resumed", "resumed"), Pair("reset", "asked for a reset"),
                                Pair("quit", "ends the station")));
}

}  // namespace
}  // namespace phalanx
