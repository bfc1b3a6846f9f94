// SPDX-License-Identifier: Apache-2.0
// The program with a registry of its own: data folder `data` and key file `keys/patients` in
// a temporary folder.
#pragma once

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apps/run_program.h"
#include "record/temporary_folder.h"

namespace phalanx::testing {

/// Fixture of the tests of `phalanx patient` and `phalanx account`.
class RegistryProgram : public ::testing::Test {
 protected:
  /// Runs a command. @param set  further variables of the environment: "PHALANX_PASSWORD=secret"
  ProgramResult run(const std::string& command, const std::string& set = "") const {
    return run_program(
        folder, command, ".out",
        "unset PHALANX_PASSPHRASE PHALANX_PASSWORD PHALANX_NEW_PASSWORD && export HOME=\"$PWD/home\" "
        "PHALANX_PATIENTS_DIR=data PHALANX_KEYS=keys/patients " +
            set);
  }
  /// @returns what a command says, with its exit code before it
  std::string said(const std::string& command, const std::string& set = "") const {
    const ProgramResult result = run(command, set);
    return std::to_string(result.exit_code) + " " + result.out + result.err;
  }
  /// Runs a command that must succeed.
  void done(const std::string& command, const std::string& set = "") const {
    const ProgramResult result = run(command, set);
    EXPECT_EQ(result.exit_code, 0) << command << ": " << result.err;
  }
  /// Types answers at a terminal of the program's own, one after each question.
  /// @returns exit code, and all that the terminal showed
  std::string typed(const std::string& command,
                    const std::vector<std::pair<std::string, std::string>>& answers) const {
    write_file(folder / "type.py",
               "import os, pty, sys\n"
               "answers = [a.split('|') for a in sys.argv[1].split(';')]\n"
               "pid, terminal = pty.fork()\n"
               "if pid == 0: os.execvp(sys.argv[2], sys.argv[2:])\n"
               "seen, begin = b'', 0\n"
               "while True:\n"
               "  try: part = os.read(terminal, 1000)\n"
               "  except OSError: break\n"
               "  if not part: break\n"
               "  seen += part\n"
               "  if answers and answers[0][0].encode() in seen[begin:]:\n"
               "    begin = len(seen)\n"
               "    os.write(terminal, answers.pop(0)[1].encode() + b'\\n')\n"
               "code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])\n"
               "print(code, seen.decode(), end='')\n");
    std::string dialogue;
    for (const auto& [question, answer] : answers)
      dialogue += fmt::format("{}{}|{}", dialogue.empty() ? "" : ";", question, answer);
    const auto result = run_command(
        folder, "export PHALANX_DATA_DIR='" PHALANX_SOURCE_DIR
                "' PHALANX_PATIENTS_DIR=data PHALANX_KEYS=keys/patients TERM=dumb && unset PHALANX_PASSWORD "
                "PHALANX_NEW_PASSWORD PHALANX_PASSPHRASE && /usr/bin/python3 type.py '" +
                    dialogue + "' '" PHALANX_PROGRAM "' " + command);
    return result.out + result.err;
  }

  /// @returns the files below the temporary folder whose bytes hold a text, but for what the
  /// last command printed
  [[nodiscard]] std::vector<std::string> files_with(const std::string& text) const {
    std::vector<std::string> found;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder.path())) {
      const std::string name = entry.path().lexically_relative(folder.path()).string();
      if (name == ".out" || name == ".err") continue;
      const bool in_name = name.find(text) != std::string::npos;
      const bool in_bytes =
          entry.is_regular_file() && read_file(entry.path()).find(text) != std::string::npos;
      if (in_name || in_bytes) found.push_back(name);
    }
    return found;
  }

  const TemporaryFolder folder;
};

}  // namespace phalanx::testing
