// SPDX-License-Identifier: Apache-2.0
// The file of the patients' keys. It lies outside the data folder, the database and the backups.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/record/recording_keys.h"

namespace phalanx {

/// Cost of Argon2id (RFC 9106). The defaults are the second recommended option of its section 4.
struct Argon2Cost {
  std::uint32_t passes = 3;
  std::uint32_t memory_kib = 65536;  ///< [KiB]
  std::uint32_t lanes = 4;

  /// Returns the cheapest cost that the algorithm takes, for tests.
  [[nodiscard]] static constexpr Argon2Cost least() noexcept {
    return {.passes = 1, .memory_kib = 8, .lanes = 1};
  }
};

/// File with one random 256-bit key for each record id. Each key is sealed (AES-256-GCM, the record id as
/// associated data) with a master key. The master key is a random one in the file `<file>.master` beside it,
/// or derived from a passphrase (Argon2id). Both files have mode 0600. All changes are atomic, synchronised
/// and locked against other programs. A file that another program changed is read again. Copies share one
/// state. Any thread. Not real-time.
class KeyStore {
 public:
  /// Opens the file. @param passphrase  empty: the master key is in `<file>.master`
  /// @throws RegistryError kUnknown if there is no such file, kDamaged if it is damaged or the passphrase is
  /// wrong, kNewer, kDisk
  [[nodiscard]] static KeyStore open(const std::filesystem::path& file, const std::string& passphrase = {});
  /// Makes a new file without keys. @throws RegistryError kConflict if it exists, kDisk
  static KeyStore create(const std::filesystem::path& file, const std::string& passphrase = {},
                         const Argon2Cost& cost = {});

  /// Adds a random key for a new record id. @throws RegistryError kConflict if the id exists or was erased,
  /// kDisk; std::invalid_argument for an id that is not 32 hexadecimal digits
  RecordingKey add(const std::string& id);
  /// @returns the key of an id; none: it is unknown or was erased, or the file can no longer be read
  [[nodiscard]] std::optional<RecordingKey> find(const std::string& id) const;
  /// Reads the file again if it changed. find() cannot tell a key that is missing from a file that is.
  /// @throws RegistryError as open()
  void check() const;
  /// Erases the key of an id, and remembers the id as erased. At every change, the old file's bytes are
  /// overwritten after the new file is on the disk. Erasing an erased or unknown id changes nothing else.
  /// @throws RegistryError kDisk
  void erase(const std::string& id);
  /// @returns true if the id was erased: a backup that holds it must not bring it back
  [[nodiscard]] bool erased(const std::string& id) const;
  /// @returns the ids with a key, sorted
  [[nodiscard]] std::vector<std::string> ids() const;
  /// @returns the erased ids, sorted
  [[nodiscard]] std::vector<std::string> erased_ids() const;
  /// Seals all keys with another master key: random in `<file>.master` if `passphrase` is empty, which
  /// else is removed.
  void change_passphrase(const std::string& passphrase, const Argon2Cost& cost = {});

  /// @returns whether a key file is wrapped by a passphrase, as it states itself; false if there is
  /// no such file
  /// @throws RegistryError kDamaged, kNewer, kDisk
  [[nodiscard]] static bool needs_passphrase(const std::filesystem::path& file);
  /// @returns a keyed hash of a text, with a secret of this store. For the registry alone.
  [[nodiscard]] std::string keyed_hash(const std::string& text) const;
  /// Seals a text of the registry with a secret of this store. For the registry alone.
  [[nodiscard]] std::string seal(const std::string& context, const std::string& text) const;
  /// @returns none: it was sealed with another store, or is changed
  [[nodiscard]] std::optional<std::string> open_sealed(const std::string& context,
                                                       const std::string& sealed) const;

  /// @returns a function that calls find(); it outlives this object
  [[nodiscard]] FindRecordingKey finder() const;
  [[nodiscard]] const std::filesystem::path& file() const noexcept;

 private:
  struct State;
  explicit KeyStore(std::shared_ptr<State> state) : state_(std::move(state)) {}
  std::shared_ptr<State> state_;
};

/// @returns the file of the keys: $PHALANX_KEYS, else
/// $XDG_CONFIG_HOME/phalanx/keys, else ~/.config/phalanx/keys
[[nodiscard]] std::filesystem::path default_keys_file();

/// @returns true for 32 hexadecimal digits in lower case
[[nodiscard]] bool is_record_id(const std::string& id) noexcept;

}  // namespace phalanx
