// SPDX-License-Identifier: Apache-2.0
// Completion in a shell when Tab is pressed, from the program's own table of commands and options.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace phalanx {

/// A word that may come next on a command line, and its explanation; `meaning` may be empty.
struct Candidate {
  std::string word;
  std::string meaning;
};

/// Finds commands, options, and values from lists: choices, scenes, scene keys, and the files of assets/. If
/// there are none, the shell offers file names.
/// @param typed  the words after the program's name up to the cursor. The last one is to be completed, and
/// may be empty. Bash treats the '=' of --option=value as a word
/// @throws as list_scenes() and data_folder()
[[nodiscard]] std::vector<Candidate> completions(const CLI::App& program,
                                                 const std::vector<std::string>& typed);

}  // namespace phalanx
