// SPDX-License-Identifier: Apache-2.0
#include "patient/registry_options.h"

#include <fmt/format.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "patient/secret.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPassphraseVariable = "PHALANX_PASSPHRASE";

bool is_there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored);
}

fs::path master_of(const fs::path& keys) { return fmt::format("{}.master", keys.string()); }

bool has_registry(const fs::path& folder) {
  return is_there(folder / "registry.sqlite") || is_there(folder / "journal");
}

std::string passphrase_of(const fs::path& keys) {
  return read_secret(
      {.what = fmt::format("passphrase of {}", keys.string()), .environment = kPassphraseVariable});
}

/// Makes the key file of a new registry. A passphrase in the environment wraps it; otherwise the master key
/// lies beside it.
KeyStore new_key_store(const fs::path& keys) {
  const char* typed = std::getenv(kPassphraseVariable);
  const std::string passphrase = typed == nullptr ? "" : typed;
  KeyStore store = KeyStore::create(keys, passphrase);
  fmt::print(
      stderr,
      "new key file: {}{}\n  Without it no patient and no encrypted recording can be read. Keep a copy of it "
      "apart from the backups (docs/patients.md).\n",
      keys.string(),
      passphrase.empty() ? fmt::format(", master key: {}", master_of(keys).string())
                         : ", wrapped by the passphrase");
  return store;
}

KeyStore key_store_for(const RegistryOptions& options, bool registry_exists) {
  const fs::path keys = keys_file_of(options);
  if (!registry_exists && !is_there(keys)) return new_key_store(keys);
  return open_key_store(options);
}

std::invalid_argument no_accounts(const RegistryOptions& options, const fs::path& folder) {
  return std::invalid_argument(fmt::format(
      "--as {}: the registry in {} has no accounts; leave --as out, or make one with `phalanx account add`",
      options.account, folder.string()));
}

Actor actor_of(Registry& registry, const RegistryOptions& options) {
  if (!registry.has_accounts()) {
    if (options.account.empty()) return Actor::owner();
    throw no_accounts(options, registry.folder());
  }
  if (options.account.empty())
    throw std::invalid_argument(fmt::format("the registry in {} has accounts: state yours with --as ACCOUNT",
                                            registry.folder().string()));
  return registry.authenticate(options.account,
                               read_secret({.what = fmt::format("password of {}", options.account),
                                            .environment = "PHALANX_PASSWORD"}));
}

/// @returns true if the key file is that of a registry, whose audit log has its head beside it
bool is_of_registry(const fs::path& keys) { return is_there(fmt::format("{}.heads", keys.string())); }

/// Opens the registry, or the key file if there is no registry.
FindRecordingKey opened_keys(const RegistryOptions& options) {
  const bool states_keys = !options.keys.empty();
  const bool states_registry = !options.data.empty() || !options.account.empty();
  const bool of_registry = is_of_registry(keys_file_of(options));
  if (!states_registry && !of_registry && (states_keys || !has_registry(data_folder_of(options))))
    return open_key_store(options).finder();
  OpenedRegistry opened = open_registry(options);
  return opened.registry.recording_keys(opened.actor);
}

/// Keys that are looked for when the first one is asked for.
struct LateKeys {
  std::mutex mutex;
  bool tried = false;
  FindRecordingKey find = {};
};

FindRecordingKey keys_when_asked(const RegistryOptions& options) {
  auto late = std::make_shared<LateKeys>();
  return [late, options](const std::string& id) -> std::optional<RecordingKey> {
    const std::lock_guard lock(late->mutex);
    if (!late->tried) {
      late->tried = true;
      try {
        const bool known = is_there(keys_file_of(options)) || has_registry(data_folder_of(options));
        if (known) late->find = opened_keys(options);
      } catch (
          const std::exception& error) {  // the reader of the recording then states that the key is missing
        fmt::print(stderr, "no keys of recordings: {}\n", error.what());
      }
    }
    return late->find ? late->find(id) : std::nullopt;
  };
}

}  // namespace

void add_registry_options(CLI::App& command, RegistryOptions& options) {
  command
      .add_option("--data", options.data,
                  "data folder of the registry [$PHALANX_PATIENTS_DIR, else ~/.local/share/phalanx]")
      ->type_name("DIR");
  command
      .add_option(
          "--keys", options.keys,
          "file with the keys of patients and their recordings [$PHALANX_KEYS, else ~/.config/phalanx/keys]")
      ->type_name("FILE");
  command
      .add_option("--as", options.account,
                  "your account, where there are accounts; PHALANX_PASSWORD or the terminal has the password")
      ->type_name("ACCOUNT");
}

fs::path data_folder_of(const RegistryOptions& options) {
  return options.data.empty() ? default_data_folder() : fs::path(options.data);
}

fs::path keys_file_of(const RegistryOptions& options) {
  return options.keys.empty() ? default_keys_file() : fs::path(options.keys);
}

KeyStore open_key_store(const RegistryOptions& options) {
  const fs::path keys = keys_file_of(options);
  const bool wrapped = is_there(keys) && KeyStore::needs_passphrase(keys);
  const char* typed = std::getenv(kPassphraseVariable);
  return KeyStore::open(keys, wrapped ? passphrase_of(keys) : typed == nullptr ? "" : typed);
}

void check_places(const fs::path& folder, const fs::path& keys) {
  std::error_code ignored;
  if (is_there(folder) && !fs::is_directory(folder, ignored))
    throw std::invalid_argument(fmt::format("--data {}: this is a file; name a folder", folder.string()));
  const fs::path inside = fs::weakly_canonical(keys).lexically_relative(fs::weakly_canonical(folder));
  if (!inside.empty() && *inside.begin() != "..")
    throw std::invalid_argument(
        fmt::format("--keys {}: it lies in the data folder {}, so that a copy of the folder would hold the "
                    "keys; name another place",
                    keys.string(), folder.string()));
}

OpenedRegistry open_registry(const RegistryOptions& options, MissingRegistry missing) {
  const fs::path folder = data_folder_of(options);
  const bool exists = has_registry(folder);
  if (!exists && missing == MissingRegistry::kRefused)
    throw std::invalid_argument(fmt::format(
        "there is no registry of patients in {}; `phalanx patient add` makes one, and --data names "
        "another folder",
        folder.string()));
  if (!exists && !options.account.empty()) throw no_accounts(options, folder);
  check_places(folder, keys_file_of(options));
  RegistrySettings settings;
  settings.folder = folder;
  Registry registry(settings, key_store_for(options, exists));
  if (!exists) fmt::print(stderr, "new registry of patients: {}\n", folder.string());
  // A lost file of accounts comes back by `patient restore` alone: it must not need an account.
  const bool repairs = missing == MissingRegistry::kRestored && registry.accounts_lost();
  Actor actor = repairs ? Actor::owner() : actor_of(registry, options);
  return {.registry = std::move(registry), .actor = std::move(actor)};
}

FindRecordingKey recording_keys_of(const RegistryOptions& options) {
  const bool stated = !options.data.empty() || !options.keys.empty() || !options.account.empty();
  return stated ? opened_keys(options) : keys_when_asked(options);
}

int with_registry_errors(const std::function<int()>& job) {
  try {
    return job();
  } catch (const RegistryError& error) {
    if (error.fault() == RegistryFault::kDisk || error.fault() == RegistryFault::kDamaged ||
        error.fault() == RegistryFault::kBusy)
      throw;
    throw std::invalid_argument(error.what());
  }
}

}  // namespace phalanx
