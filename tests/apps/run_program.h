// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "record/temporary_folder.h"

namespace phalanx::testing {

struct ProgramResult {
  int exit_code;
  std::string out;
  std::string err;
};

/// Runs the built program in a folder; `arguments` as a shell reads them, standard output into `out_file`.
/// @param before  a command of the shell that comes first, such as a limit on what the program may use
inline ProgramResult run_program(const TemporaryFolder& folder, const std::string& arguments,
                                 const std::string& out_file = ".out", const std::string& before = ":") {
  const std::string command = "cd '" + folder.path().string() + "' && (" + before +
                              " && PHALANX_DATA_DIR='" PHALANX_SOURCE_DIR "' '" PHALANX_PROGRAM "' " +
                              arguments + ") >'" + out_file + "' 2>.err </dev/null";
  const int status = std::system(command.c_str());  // NOLINT(cert-env33-c): the shell is the user's side here
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, out_file == ".out" ? read_file(folder / ".out") : "",
          read_file(folder / ".err")};
}

/// Runs a command of the shell in a folder.
inline ProgramResult run_command(const TemporaryFolder& folder, const std::string& command) {
  const std::string whole =
      "cd '" + folder.path().string() + "' && (" + command + ") >.out 2>.err </dev/null";
  const int status = std::system(whole.c_str());  // NOLINT(cert-env33-c): the shell is the user's side here
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(folder / ".out"),
          read_file(folder / ".err")};
}

inline void write_file(const std::filesystem::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

}  // namespace phalanx::testing
