// SPDX-License-Identifier: Apache-2.0
// `phalanx exercise` under a held clock, with a registry of its own.
#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "apps/patient/registry_program.h"

namespace phalanx::testing {

/// Fixture of the tests of `phalanx exercise`.
class ExerciseProgram : public RegistryProgram {
 protected:
  /// Runs `phalanx exercise run` in a held clock, for minutes of the station within seconds; recordings
  /// are in `rec`.
  ProgramResult exercise(const std::string& arguments) const {
    return run_command(folder,
                       "unset PHALANX_PASSPHRASE PHALANX_PASSWORD && export HOME=\"$PWD/home\" "
                       "PHALANX_PATIENTS_DIR=data PHALANX_KEYS=keys/patients PHALANX_DATA_DIR='" +
                           scenes_and_assets +
                           "' && '" PHALANX_HELD_CLOCK_PROGRAM "' -- '" PHALANX_PROGRAM
                           "' exercise run --no-realtime --no-foxglove --rate-hz 200 --record rec " +
                           arguments);
  }
  /// @returns the recordings, by name
  [[nodiscard]] std::vector<std::string> recordings() const {
    std::vector<std::string> found;
    if (!std::filesystem::exists(folder / "rec")) return found;
    for (const auto& entry : std::filesystem::directory_iterator(folder / "rec"))
      found.push_back("rec/" + entry.path().filename().string());
    std::sort(found.begin(), found.end());
    return found;
  }
  /// Writes a range of motion of two short trials, without rests, as `short.toml`.
  void write_short() const {
    write_file(folder / "short.toml",
               "format = 1\ntitle = \"Short\"\nkind = \"assessment\"\nmeasure = \"range_of_motion\"\nscene = "
               "\"wave\"\n"
               "instruction = \"Open, then close.\"\ntrials = 2\ntrial_s = 6\nrest_s = 0\n");
  }

  std::string scenes_and_assets = PHALANX_SOURCE_DIR;  ///< folder
};

}  // namespace phalanx::testing
