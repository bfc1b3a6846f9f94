// SPDX-License-Identifier: Apache-2.0
// The audit log on the disk, and its head beside the key file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/registry/audit.h"
#include "registry/private_file.h"

namespace phalanx::registry {

/// Head of an audit log, outside the data folder: what the log's end must be.
struct AuditHead {
  std::string folder = {};  ///< data folder
  std::uint64_t lines = 0;
  std::string hash = {};       ///< SHA-256 of the newest line
  std::string line = {};       ///< the newest line itself: it is written here first, then to the log
  std::uint64_t accounts = 0;  ///< number of accounts: their file must not vanish
};

/// Log `audit.jsonl` of a data folder with its head in `<key file>.heads`. Every line is in the head
/// before it is in the log. After a kill between the two, the next use appends it. A log that does not
/// end as its head says is continued from the head, so that the break stays visible. The caller holds the
/// data folder's lock.
class AuditTrail {
 public:
  AuditTrail(std::filesystem::path folder, const std::filesystem::path& keys, std::string id);

  /// Appends one line. @throws RegistryError kDisk
  void append(double utc, const std::string& account, const std::string& action, const std::string& record,
              const std::string& detail = {});
  [[nodiscard]] AuditCheck check();
  /// @returns the newest lines that can be read, oldest first
  [[nodiscard]] std::vector<AuditEntry> newest(std::size_t count) const;

  [[nodiscard]] std::optional<AuditHead> head() const;
  /// Writes the number of accounts into the head.
  void set_accounts(std::uint64_t count);
  /// Takes the log of a backup if this one is its beginning, or empty. @returns true if it did
  bool take_over(const std::string& log);
  /// @returns whether a backup's log is the beginning of this one, or empty
  [[nodiscard]] bool begins_with(const std::string& log) const;
  /// @returns lines of the log
  [[nodiscard]] std::uint64_t lines();
  [[nodiscard]] const std::string& id() const noexcept { return id_; }
  /// Belongs to another id from now on: that of a restored registry.
  void set_id(std::string id);

 private:
  struct Heads;
  void refresh();
  void read_more(const std::optional<AuditHead>& head);

  std::filesystem::path folder_;
  std::filesystem::path log_;
  std::filesystem::path heads_;
  std::string id_;
  std::uint64_t bytes_ = 0;  ///< of the whole lines that were read
  std::uint64_t lines_ = 0;
  std::string hash_;  ///< of the newest line that was read
  bool as_head_says_ = true;
  bool torn_ = false;  ///< the log ends without '\n'
};

}  // namespace phalanx::registry
