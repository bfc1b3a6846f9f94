// SPDX-License-Identifier: Apache-2.0
// A therapist's month by script: `phalanx patient`, `phalanx exercise` and `phalanx session` on chosen days,
// and the comparison of the registry with what NumPy makes of the recordings.
#pragma once

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/month/held_programs.h"
#include "apps/patient/registry_program.h"

namespace phalanx::testing {

/// Fixture of the tests of a month. Recordings are in `rec`, the registry in `data` and `keys`; the date is
/// that of `date`.
class MonthProgram : public RegistryProgram {
 protected:
  /// Begins on day 1.
  MonthProgram();

  /// Sets the date of all programs, of running ones, too. @param day  1 .. 31 of March 2026 @param hour  UTC
  void set_date(int day, double hour = 9.0) const;

  /// Runs a command on the present date.
  [[nodiscard]] ProgramResult phalanx(const std::string& command) const;
  /// Runs a command that must succeed. @returns what it writes
  std::string done_today(const std::string& command) const;
  /// Carries out an exercise of the simulated patient under a held clock: minutes of the
  /// station within seconds.
  /// @param before  a command of the shell that comes first, such as a limit on what the program may use
  [[nodiscard]] ProgramResult exercise(const std::string& arguments, const std::string& before = ":") const;
  /// Carries out a whole exercise with a simulated participant. Its result must be kept, and the replay must
  /// give the same one.
  void session(const std::string& name, double skill, int seed) const;
  /// @returns the command line of `phalanx exercise run` for the simulated patient, for HeldPrograms
  [[nodiscard]] std::vector<std::string> exercise_command(const std::string& arguments) const;
  /// @returns the environment of the registry and the date: "NAME=VALUE"
  [[nodiscard]] std::vector<std::string> environment() const;

  /// @returns the paths of the recordings, by name. What a repair has put aside is left out
  [[nodiscard]] std::vector<std::string> recordings() const;
  /// @returns the rows of the registry
  [[nodiscard]] nlohmann::json results() const;
  /// @returns the rows whose recording is this one
  [[nodiscard]] nlohmann::json rows_of(const std::string& recording) const;
  /// Repairs each torn recording, and makes the rows from the recordings, twice. The second time
  /// must change nothing.
  void rebuild() const;

  /// Exports all recordings, and compares the registry's rows with scores that NumPy makes of the tables.
  /// @returns what month.py has counted; empty if something differs, which fails the test
  [[nodiscard]] nlohmann::json compare() const;

  std::string code_ = "SIM1";  ///< of the patient
};

}  // namespace phalanx::testing
