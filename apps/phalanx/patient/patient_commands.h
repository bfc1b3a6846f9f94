// SPDX-License-Identifier: Apache-2.0
// The commands of `phalanx patient`, and what they share.
#pragma once

#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <string>

#include "commands.h"
#include "patient/registry_options.h"
#include "usage.h"

namespace phalanx {

/// Options that every command of `phalanx patient` has.
struct PatientOptions {
  RegistryOptions registry = {};
  std::string code = {};  ///< CODE: the patient
};

/// Adds a command with --data, --keys and --as. Files that it makes are only their owner's.
/// @param work  of the command; refusals of the registry become exit codes
/// @returns the command, for its own options
template <class Options>
CLI::App* add_patient_job(CLI::App& patient, const char* name, const char* help,
                          std::shared_ptr<Options> options, Job& job, int (*work)(const Options&)) {
  CLI::App* command = patient.add_subcommand(name, help);
  add_registry_options(*command, options->registry);
  command->callback([options, command, work, &job] {
    refuse_empty_values(*command);
    job = [options, work] {
      ::umask(S_IRWXG | S_IRWXO);
      return with_registry_errors([&] { return work(*options); });
    };
  });
  return command;
}

/// Adds the argument CODE.
inline CLI::Option* add_code(CLI::App& command, PatientOptions& options) {
  return command.add_option("CODE", options.code, "the patient's code, as P07")->required()->type_name("");
}

void add_patient_edit_commands(CLI::App& patient, Job& job);     ///< add, edit, delete
void add_patient_result_commands(CLI::App& patient, Job& job);   ///< results, trend, test, note
void add_patient_report_commands(CLI::App& patient, Job& job);   ///< report, fhir
void add_patient_store_commands(CLI::App& patient, Job& job);    ///< export, rebuild, backup, restore
void add_patient_control_commands(CLI::App& patient, Job& job);  ///< audit, passphrase

}  // namespace phalanx
