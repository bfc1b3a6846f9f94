// SPDX-License-Identifier: Apache-2.0
// The program itself: changes that are typed at its terminal are in the log of changes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "record/temporary_folder.h"

namespace phalanx {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

/// @returns the lines of the log of changes
std::vector<nlohmann::json> changes_in(const testing::TemporaryFolder& folder) {
  std::istringstream text(testing::read_file(folder / "changes.jsonl"));
  std::vector<nlohmann::json> changes;
  for (std::string line; std::getline(text, line);) changes.push_back(nlohmann::json::parse(line));
  return changes;
}

/// Runs the station with lines typed at its terminal. @returns the shell's exit status
int run_with(const testing::TemporaryFolder& folder, const std::string& lines) {
  const std::string command = "cd '" + folder.path().string() + "' && printf '" + lines +
                              "' | "
                              "PHALANX_DATA_DIR='" PHALANX_SOURCE_DIR "' '" PHALANX_PROGRAM
                              "' run --device sliders --port 0 --no-realtime --quiet --slow-motion 4 "
                              "--record recordings --audit changes.jsonl >out 2>err";
  return std::system(command.c_str());  // NOLINT(cert-env33-c): the shell is the user's side here
}

TEST(Typed, EveryCommandIsLoggedAsTheTerminals) {
  const testing::TemporaryFolder folder;
  ASSERT_EQ(run_with(folder, "stop\\nnonsense\\nresume\\nreset\\nquit\\n"), 0)
      << testing::read_file(folder / "err");
  std::vector<std::pair<std::string, std::string>> told;
  for (const nlohmann::json& change : changes_in(folder)) {
    EXPECT_EQ(change["who"], "the terminal");
    told.emplace_back(change["code"], change["text"]);
  }
  EXPECT_THAT(told, ElementsAre(Pair("stopped", "stopped"), Pair("resumed", "resumed"),
                                Pair("reset", "asked for a reset"), Pair("quit", "ends the station")));
}

TEST(Typed, AnOpeningOfADigitThatNeedsNoneIsRefusedWithTheReason) {
  const testing::TemporaryFolder folder;
  ASSERT_EQ(run_with(folder, "open finger\\nopen index\\nquit\\n"), 0) << testing::read_file(folder / "err");
  const std::string err = testing::read_file(folder / "err");
  EXPECT_THAT(err, HasSubstr("'finger' is no digit; type open thumb, index, middle, ring or little"));
  EXPECT_THAT(err, HasSubstr("index: ")) << "forces are not on yet, or nothing is inside";
  ASSERT_EQ(changes_in(folder).size(), 1U);
  EXPECT_EQ(changes_in(folder)[0]["code"], "quit");
}

// A busy terminal passes typed words on late. They refer to what the person had seen when typing them.
TEST(Typed, AResumeDoesNotUndoAStopThatThePersonHadNotSeen) {
  const testing::TemporaryFolder folder;
  const std::string script = R"(
    until_there() { echo "waits for $1 in $2" >&2; grep -qm1 -- "$1" <(tail --pid=$$ -n +1 -F "$2" 2>/dev/null); }
    mkfifo typed
    "$PROGRAM" run --device sliders --port 0 --no-realtime --quiet --record recordings --audit changes.jsonl <typed >out 2>err &
    station=$!
    exec 4>typed
    until_there http: out
    port=$(sed -n 's|.*http://127.0.0.1:\([0-9]*\)/.*|\1|p' out | head -n 1)
    echo stop >&4
    until_there stopped changes.jsonl
    exec 3<>"/dev/tcp/127.0.0.1/$port"
    printf 'POST /stop HTTP/1.1\r\nHost: 127.0.0.1:%s\r\nOrigin: http://127.0.0.1:%s\r\nContent-Length: 0\r\n\r\n' "$port" "$port" >&3
    until_there page changes.jsonl
    echo resume >&4
    until_there 'another stop' err
    echo resume >&4
    until_there resumed changes.jsonl
    echo quit >&4
    wait $station
  )";
  std::ofstream(folder / "story.sh") << script;
  const std::string command = "cd '" + folder.path().string() +
                              "' && PROGRAM='" PHALANX_PROGRAM "' PHALANX_DATA_DIR='" PHALANX_SOURCE_DIR
                              "' timeout 300 bash story.sh 2>trouble";
  ASSERT_EQ(std::system(command.c_str()), 0)  // NOLINT(cert-env33-c)
      << testing::read_file(folder / "trouble") << testing::read_file(folder / "err");
  std::vector<std::pair<std::string, std::string>> told;
  for (const nlohmann::json& change : changes_in(folder))
    told.emplace_back(change["who"] == "the terminal" ? "terminal" : "page", change["code"]);
  EXPECT_THAT(told, ElementsAre(Pair("terminal", "stopped"), Pair("page", "stopped"),
                                Pair("terminal", "resumed"), Pair("terminal", "quit")));
}

}  // namespace
}  // namespace phalanx
