// SPDX-License-Identifier: Apache-2.0
// Inside of Registry: one operation at a time under the folder's lock, events to the journal first, then
// to the database.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "phalanx/registry/registry.h"
#include "registry/audit_trail.h"
#include "registry/crypto.h"
#include "registry/database.h"
#include "registry/journal.h"
#include "registry/private_file.h"

namespace phalanx {

/// One account as in the sealed file.
struct StoredAccount {
  Account account = {};
  std::string hash = {};  ///< of the password
};

/// A token's account.
struct SignInToken {
  std::string account = {};
  double since = 0.0;  ///< steady clock [s]
  double last = 0.0;   ///< likewise, of the newest request
  bool locked = false;
};

/// A living patient, as an operation needs it.
struct OpenRecord {
  registry::Key key = {};  ///< of rows and journal, derived from the patient's key
  registry::PatientRow row = {};
  registry::Journal journal;
  Patient patient = {};
};

struct Registry::Impl {
  Impl(const RegistrySettings& given, KeyStore store);

  /// Holds mutex and folder lock while it lives. It applies first what other programs wrote, or a
  /// killed one left.
  class Operation {
   public:
    explicit Operation(Impl& registry);

   private:
    std::lock_guard<std::mutex> guard_;
    registry::FileLock lock_;
  };
  enum class Permission { kPatients, kAdministration };

  // registry.cpp
  void require(const Actor& actor, Permission permission);
  void log(const Actor& actor, const std::string& action, const std::string& record,
           const std::string& detail = {});
  /// Calls a function. Writes an audit line for all records ("*") before it passes a RegistryError on.
  template <typename Function>
  void logged_if_it_fails(const Actor& actor, const char* action, const Function& function) {
    try {
      function();
    } catch (const RegistryError&) {
      log(actor, action, "*");
      throw;
    }
  }
  [[nodiscard]] OpenRecord open_record(const std::string& record);
  /// @returns the patients that can be read, by code. @param damaged  gets the record ids of the others
  [[nodiscard]] std::vector<Patient> all_patients(std::set<std::string>* damaged = nullptr);
  /// Appends an event to the journal, then applies it to the database.
  void add_event(OpenRecord& open, const std::string& event);

  // registry_events.cpp
  [[nodiscard]] std::filesystem::path journal_file(const std::string& record) const;
  [[nodiscard]] registry::Journal journal_of(const std::string& record, const registry::Key& key) const;
  [[nodiscard]] std::optional<registry::Key> row_key(const std::string& record) const;
  [[nodiscard]] std::vector<std::string> journal_records() const;
  void catch_up();
  void catch_up(const std::string& record);
  /// Makes all rows of a record from its journal. Rows that the journal lacks are added to it.
  /// @returns damaged events
  std::uint64_t apply_all(const std::string& record, const registry::Key& key);
  void apply_event(const std::string& record, const registry::Key& key, std::uint64_t number,
                   const std::string& event, registry::PatientRow& row);
  [[nodiscard]] std::string result_place(const registry::Key& key, const ResultRow& row) const;
  /// @returns none: the row is damaged
  [[nodiscard]] std::optional<std::string> open_row(const registry::Key& key, const std::string& context,
                                                    const std::string& sealed) const;
  /// @param damaged  counts the damaged rows, which are left out; null: the first one is refused
  [[nodiscard]] std::vector<ResultRow> results_of(const OpenRecord& open, std::uint64_t* damaged = nullptr);
  /// @returns entries of one kind as JSON: "test", "note", "recording", "export"
  /// @param damaged  as in results_of()
  [[nodiscard]] std::vector<nlohmann::json> entries_of(const OpenRecord& open, const std::string& kind,
                                                       std::uint64_t* damaged = nullptr);

  // registry_delete.cpp
  [[nodiscard]] std::set<std::string> deleted_records(const std::filesystem::path& file) const;
  void mark_deleted(const std::string& record);
  /// @returns the file that is locked while a program uses the key of a record
  [[nodiscard]] std::filesystem::path use_file(const std::string& record) const;
  /// @throws RegistryError kConflict if a program uses the key of a record
  void refuse_in_use(const std::string& record) const;
  /// Removes all that is left of a record whose key is erased.
  void finish_deletion(const std::string& record);
  void remove_exports(const OpenRecord& open, DeleteReport& report);
  /// Reports the recordings and removes the exports that the readable rows name.
  void delete_named_files(const OpenRecord& open, DeleteReport& report);

  // registry_accounts.cpp
  [[nodiscard]] const std::vector<StoredAccount>& accounts();
  /// @returns the accounts of a file's text; none: it is damaged, or was sealed with another key store
  [[nodiscard]] std::optional<std::vector<StoredAccount>> opened_accounts(const std::string& text) const;
  [[nodiscard]] bool opens_accounts(const std::string& text) const {
    return opened_accounts(text).has_value();
  }
  [[nodiscard]] const StoredAccount* find_account(const std::string& name);
  void write_accounts(std::vector<StoredAccount> next);
  [[nodiscard]] bool accounts_file_is_missing();
  /// @returns whether accounts existed whose file is missing or damaged
  [[nodiscard]] bool accounts_are_lost();
  /// @returns name of the counter of failed sign-ins: a keyed hash, as a typing error may be a password
  [[nodiscard]] std::string failure_bucket(const std::string& name) const;
  /// Checks a password. Not under an Operation: it takes two.
  Actor check_password(const std::string& name, const std::string& password, const std::string& action);
  [[nodiscard]] double utc() const;
  [[nodiscard]] double steady() const;

  RegistrySettings settings;
  KeyStore keys;
  std::filesystem::path folder;
  std::unique_ptr<registry::Database> db;
  std::unique_ptr<registry::AuditTrail> audit;
  std::mutex mutex;
  std::map<std::string, registry::FileStamp> seen;  ///< journals that are applied
  std::map<std::string, SignInToken> tokens;        ///< by SHA-256 of the token
  std::optional<registry::FileStamp> accounts_stamp;
  std::vector<StoredAccount> known_accounts;
  std::string decoy_hash;  ///< is checked for unknown names, so that they take as long
};

}  // namespace phalanx
