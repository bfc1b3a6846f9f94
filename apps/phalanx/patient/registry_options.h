// SPDX-License-Identifier: Apache-2.0
// The options of all commands that use the registry of patients: --data, --keys and --as.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "phalanx/record/recording_keys.h"
#include "phalanx/registry/registry.h"

namespace phalanx {

/// Where the registry is, and who uses it.
struct RegistryOptions {
  std::string data = {};     ///< --data DIR; empty: default_data_folder()
  std::string keys = {};     ///< --keys FILE; empty: default_keys_file()
  std::string account = {};  ///< --as ACCOUNT; empty: the owner of a registry without accounts
};

/// Treatment of a data folder without a registry.
enum class MissingRegistry {
  kRefused,   ///< the message names the folder and how a registry is made
  kMade,      ///< registry and key file are made; standard error states where
  kRestored,  ///< as kMade, for `patient restore`: a lost or damaged file of accounts needs no --as
};

/// A registry with the person who uses it.
struct OpenedRegistry {
  Registry registry;
  Actor actor;
};

/// Adds --data, --keys and --as.
void add_registry_options(CLI::App& command, RegistryOptions& options);

[[nodiscard]] std::filesystem::path data_folder_of(const RegistryOptions& options);
[[nodiscard]] std::filesystem::path keys_file_of(const RegistryOptions& options);

/// Opens the key file. A passphrase comes from PHALANX_PASSPHRASE, or is asked for at the terminal. A file
/// whose master key lies beside it needs none.
/// @throws RegistryError as KeyStore::open(), std::invalid_argument as read_secret()
[[nodiscard]] KeyStore open_key_store(const RegistryOptions& options);

/// Checks the places of a registry and its keys before anything is made.
/// @throws std::invalid_argument if the folder is a file, or if the keys lie in it
void check_places(const std::filesystem::path& folder, const std::filesystem::path& keys);

/// Opens the registry, and checks the password of --as, which comes from PHALANX_PASSWORD or the terminal.
/// @throws std::invalid_argument if accounts exist and --as is missing, if --as is given and there is no
/// account, or if there is no registry; RegistryError as Registry
[[nodiscard]] OpenedRegistry open_registry(const RegistryOptions& options,
                                           MissingRegistry missing = MissingRegistry::kRefused);

/// Makes the finder of recordings' keys. A key file of a registry, and the data folder of one, give keys only
/// through Registry::recording_keys(): a role that sees patients, and a line in the audit log. A key file
/// without a registry gives its keys alone. If --data, --keys or --as was given, all is opened now. Otherwise
/// it is opened when the first encrypted recording is read; standard error then states why there are no keys.
/// @throws as open_registry() and open_key_store(), if one of the options was given
[[nodiscard]] FindRecordingKey recording_keys_of(const RegistryOptions& options);

/// Runs a job, and turns refusals of the registry that are about the input into std::invalid_argument: exit
/// code 2. Those about disks and damaged files stay: exit code 1.
int with_registry_errors(const std::function<int()>& job);

}  // namespace phalanx
