// SPDX-License-Identifier: Apache-2.0
// The manual page: all that --help names, in a form that troff reads without a warning.
#include <gmock/gmock.h>

#include <regex>
#include <string>
#include <vector>

#include "apps/run_program.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using testing::run_command;
using testing::run_program;
using testing::TemporaryFolder;

/// The names in the list of a help text that begins with `heading`.
std::vector<std::string> names_below(const std::string& help, const std::string& heading) {
  std::vector<std::string> names;
  const std::size_t begin = help.find("\n" + heading + ":\n");
  if (begin == std::string::npos) return names;
  const std::string list = help.substr(begin, help.find("\n\n", begin + 1) - begin);
  const std::regex name(R"(\n  ([a-z-]\S*))");
  for (std::sregex_iterator it(list.begin(), list.end(), name), end; it != end; ++it)
    names.push_back((*it)[1]);
  return names;
}

std::string without_backslashes(std::string text) {
  std::erase(text, '\\');
  return text;
}

class CliManual : public ::testing::Test {
 protected:
  /// Looks for all that the command's help names in the page, and for the commands below it.
  void look_for(const std::string& command) {
    const std::string help = run_program(folder, command + " --help").out;
    const std::string full = command.empty() ? "phalanx" : "phalanx " + command;
    const std::size_t begin = command.empty() ? 0 : page.find(".SS \"" + full + "\"\n");
    ASSERT_NE(begin, std::string::npos) << full;
    const std::string section = page.substr(begin, page.find("\n.SS ", begin + 1) - begin);
    const auto below = names_below(help, "Subcommands");
    if (below.empty()) {
      const auto options_of_it = names_below(help, "Options");
      EXPECT_FALSE(options_of_it.empty()) << full;
      for (const std::string& option : options_of_it)
        if (option != "-h,--help") {
          EXPECT_THAT(section, HasSubstr("fB" + option)) << full;
        }
      options += options_of_it.size();
    }
    for (const std::string& name : below) {
      ++commands;
      look_for(command.empty() ? name : command + " " + name);
    }
  }

  const TemporaryFolder folder;
  const std::string page = without_backslashes(run_program(folder, "man").out);
  std::size_t commands = 0;
  std::size_t options = 0;
};

TEST_F(CliManual, HasEveryCommandAndOptionThatHelpNames) {
  look_for("");
  EXPECT_GT(commands, 50U);
  EXPECT_GT(options, 200U);
}

TEST_F(CliManual, IsReadByTroffWithoutAWarning) {
  const auto read = run_command(folder, "'" PHALANX_PROGRAM "' man | groff -K utf8 -man -ww -z -Tutf8");
  EXPECT_EQ(read.exit_code, 0);
  EXPECT_EQ(read.err, "");
}

TEST_F(CliManual, StatesNameVersionAndExitCodes) {
  EXPECT_THAT(page, HasSubstr(".SH NAME\nphalanx - haptic rendering"));
  EXPECT_THAT(page, ::testing::ContainsRegex("TH PHALANX 1 \"\" \"phalanx [0-9]+.[0-9]+.[0-9]+\""));
  EXPECT_THAT(page, HasSubstr(".SH EXIT STATUS\n.TP\n.B 0\n"));
}

}  // namespace
}  // namespace phalanx
