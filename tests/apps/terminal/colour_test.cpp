// SPDX-License-Identifier: Apache-2.0
// Colour is for terminals that take it: not for pipes and files, dumb terminals, and users who set NO_COLOR.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "apps/run/running_station.h"

namespace phalanx::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
using Words = std::vector<std::string>;

constexpr double kEndsWithin = 240.0;  // real seconds: only against hangs

/// Runs the program to its end. @param environment  arguments of env(1)
void run(const TemporaryFolder& folder, const Words& environment, const Words& arguments,
         const Descriptors& descriptors) {
  Words command{"/usr/bin/env", "-C", folder.path().string(), "-u", "NO_COLOR", "-u", "TERM"};
  command.insert(command.end(), environment.begin(), environment.end());
  command.insert(command.end(), {"PHALANX_DATA_DIR=" PHALANX_SOURCE_DIR, PHALANX_PROGRAM});
  command.insert(command.end(), arguments.begin(), arguments.end());
  ChildProcess process(command, descriptors);
  ASSERT_TRUE(process.wait(kEndsWithin));
}

std::string on_terminal(const TemporaryFolder& folder, const Words& environment, const Words& arguments) {
  Ends terminal = make_terminal();
  const int theirs = terminal.theirs.number();
  run(folder, environment, arguments, {theirs, theirs, theirs, true});
  return read_waiting(terminal.ours);
}

const Words kError = {"scene", "lst"};

TEST(Colour, AnErrorIsRedOnATerminal) {
  const TemporaryFolder folder;
  const std::string shown = on_terminal(folder, {"TERM=xterm"}, kError);
  EXPECT_THAT(shown, StartsWith("\033[31mphalanx scene: unknown command 'lst'"));
  EXPECT_THAT(shown, ::testing::EndsWith("\033[0m\r\n"));
}

class NoColour : public ::testing::TestWithParam<Words> {};

TEST_P(NoColour, IsSentThere) {
  const TemporaryFolder folder;
  const std::string shown = on_terminal(folder, GetParam(), kError);
  EXPECT_THAT(shown, StartsWith("phalanx scene: unknown command 'lst'"));
  EXPECT_THAT(shown, Not(HasSubstr("\033")));
}

INSTANTIATE_TEST_SUITE_P(All, NoColour,
                         ::testing::Values(Words{"TERM=dumb"}, Words{"TERM="}, Words{},
                                           Words{"TERM=xterm", "NO_COLOR=1"}));

TEST(Colour, AnEmptyNoColorMeansNothing) {
  const TemporaryFolder folder;
  EXPECT_THAT(on_terminal(folder, {"TERM=xterm", "NO_COLOR="}, kError), StartsWith("\033[31m"));
}

TEST(Colour, AVerdictIsBoldAndAWarningYellow) {
  const TemporaryFolder folder;
  std::ofstream(folder / "tetrahedron.obj")
      << "v 0 0 0\nv 0.1 0 0\nv 0 0.1 0\nv 0 0 0.1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
  EXPECT_THAT(on_terminal(folder, {"TERM=xterm"}, {"mesh", "check", "tetrahedron.obj"}),
              ::testing::ContainsRegex("\n  \033\\[1m[^\033]+\033\\[0m\r\n"));
  std::ofstream(folder / "bent.csv") << "time_s,index_mcp_flexion\n0,3\n0.1,3\n";
  EXPECT_THAT(on_terminal(folder, {"TERM=xterm"}, {"simulate", "wave", "--motion", "bent.csv"}),
              HasSubstr("\n\033[33mwarning  "));
}

TEST(Colour, NoneGoesIntoAPipe) {
  const TemporaryFolder folder;
  const Descriptor nothing(::open("/dev/null", O_RDONLY | O_CLOEXEC));
  Ends output = pipe_from_program();
  run(folder, {"TERM=xterm"}, kError, {nothing.number(), output.theirs.number(), output.theirs.number()});
  const std::string written = read_waiting(output.ours);
  EXPECT_THAT(written, StartsWith("phalanx scene: unknown command 'lst'"));
  EXPECT_THAT(written, Not(HasSubstr("\033")));
}

}  // namespace
}  // namespace phalanx::testing
