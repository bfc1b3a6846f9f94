// SPDX-License-Identifier: Apache-2.0
// What the shells offer: all that --help names, and the values that the program has a list of.
#include <gmock/gmock.h>

#include <regex>
#include <sstream>
#include <vector>

#include "apps/run_program.h"

namespace phalanx {
namespace {

using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;
using testing::run_program;
using ::testing::StartsWith;
using testing::TemporaryFolder;
using ::testing::UnorderedElementsAre;
using Words = std::vector<std::string>;

Words lines_of(const std::string& text) {
  Words lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

class CliCompletion : public ::testing::Test {
 protected:
  /// @param typed  as a shell reads it, with the word to be completed
  [[nodiscard]] Words offered(const std::string& typed) const {
    const auto result = run_program(folder, "completion words -- " + typed);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    Words words = lines_of(result.out);
    for (std::string& word : words) word.resize(word.find('\t'));
    return words;
  }

  const TemporaryFolder folder;
};

/// The long options that a help text names.
Words options_in(const std::string& help) {
  Words options;
  const std::regex option(R"((?:^|\n)  (?:-\w,)?(--[\w-]+(?:,--[\w-]+)*))");
  for (std::sregex_iterator it(help.begin(), help.end(), option), end; it != end; ++it) {
    std::istringstream names((*it)[1]);
    for (std::string name; std::getline(names, name, ',');) options.push_back(name);
  }
  return options;
}

TEST_F(CliCompletion, OffersEveryCommand) {
  EXPECT_THAT(offered("''"),
              ElementsAre("run", "simulate", "experiment", "study", "grasp", "scene", "hand", "mesh",
                          "device", "session", "replay", "exercise", "patient", "account", "completion"));
  EXPECT_THAT(offered("scene ''"), ElementsAre("list", "check", "keys", "grasps", "pictures"));
}

TEST_F(CliCompletion, OffersEveryOptionThatHelpNames) {
  Words commands = offered("''");
  commands.emplace_back("");
  for (const std::string group :
       {"scene", "hand", "device", "mesh", "exercise", "patient", "account", "session"})
    for (const std::string& command : offered(group + " ''")) commands.push_back(group + " " + command);
  std::size_t options = 0;
  for (const std::string& command : commands) {
    const Words named = options_in(run_program(folder, command + " --help").out);
    EXPECT_THAT(named, Contains("--help")) << command;
    EXPECT_THAT(offered(command + " --"), ::testing::IsSupersetOf(named)) << command;
    options += named.size();
  }
  EXPECT_GT(commands.size(), 20U);
  EXPECT_GT(options, 100U);
}

TEST_F(CliCompletion, OffersWhatBeginsAsTyped) {
  EXPECT_THAT(offered("sim"), ElementsAre("simulate"));
  EXPECT_THAT(offered("simulate --pic"), ElementsAre("--picture"));
  EXPECT_THAT(offered("simulate --quiet --pic"), ElementsAre("--picture"));
  EXPECT_THAT(offered("simulate --out x --pic"), ElementsAre("--picture"));
  EXPECT_THAT(offered("completion ''"), ElementsAre("bash", "zsh"));
  EXPECT_THAT(offered("nonsense --pic"), IsEmpty());
}

TEST_F(CliCompletion, OffersTheValuesThatAreListed) {
  EXPECT_THAT(offered("run grasp_t"), Contains("grasp_teapot"));
  EXPECT_THAT(offered("run grasp_t"), Each(StartsWith("grasp_t")));
  EXPECT_THAT(offered("exercise run range_"), ElementsAre("range_of_motion"));
  EXPECT_THAT(offered("exercise run x --demo mod"), ElementsAre("moderate"));
  EXPECT_THAT(offered("simulate --profile small"), ElementsAre("small-woman"));
  EXPECT_THAT(offered("simulate --profile=small"), ElementsAre("--profile=small-woman"));
  EXPECT_THAT(offered("simulate --profile = small"), ElementsAre("small-woman")) << "as Bash parts words";
  EXPECT_THAT(offered("simulate --profile ="), Contains("small-woman"));
  EXPECT_THAT(offered("run --set force.stiff"), ElementsAre("force.stiffness_n_per_mm="));
  EXPECT_THAT(offered("hand export --format ''"), UnorderedElementsAre("urdf", "mjcf"));
  EXPECT_THAT(offered("hand pictures small"), ElementsAre("small-woman")) << "postures";
  EXPECT_THAT(offered("patient test P07 --kind gr"), ElementsAre("grip"));
  EXPECT_THAT(offered("patient add P07 --symbol su"), ElementsAre("sun"));
  EXPECT_THAT(offered("patient edit P07 --template mo"), ElementsAre("moderate"));
  EXPECT_THAT(offered("account add anna --role t"), ElementsAre("therapist"));
  EXPECT_THAT(offered("scene check a b grasp_t"), Contains("grasp_teapot")) << "one of several arguments";
  EXPECT_THAT(offered("simulate wave grasp_t"), IsEmpty()) << "one argument too many";
  EXPECT_THAT(offered("simulate --out ''"), IsEmpty()) << "file names are the shell's";
}

TEST_F(CliCompletion, WorksInBash) {
  testing::write_file(folder / "ask.sh",
                      "shopt -s failglob\n"
                      "eval \"$(\"$PHALANX\" completion bash)\"\n"
                      "COMP_WORDS=(\"$PHALANX\" \"$@\")\n"
                      "COMP_CWORD=$#\n"
                      "_phalanx 2>/dev/null\n"
                      "printf '%s\\n' \"${COMPREPLY[@]}\"\n"
                      "complete -p phalanx\n"
                      "complete -p ./run 2>/dev/null\n"
                      "exit 0\n");
  const auto reply = [&](const std::string& typed) {
    const auto result =
        run_program(folder, "--version", ".out",
                    "PHALANX_DATA_DIR='" PHALANX_SOURCE_DIR "' PHALANX='" PHALANX_PROGRAM "' bash ask.sh " +
                        typed + " >reply");
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return lines_of(testing::read_file(folder / "reply"));
  };
  const std::string registered = "complete -o bashdefault -o default -F _phalanx phalanx";
  EXPECT_THAT(reply("sim"), ElementsAre("simulate", registered));
  EXPECT_THAT(reply("simulate --profile = small"), ElementsAre("small-woman", registered));
  EXPECT_THAT(reply("simulate --out ''"), ElementsAre("", registered));
  EXPECT_THAT(reply("simulate --plo"), ElementsAre("--plot", registered)) << "[DIR/plot.svg] is no pattern";
}

}  // namespace
}  // namespace phalanx
