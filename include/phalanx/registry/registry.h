// SPDX-License-Identifier: Apache-2.0
// The registry: patients, results, entered tests, notes and accounts in the data folder.
//
// Files of the data folder (mode 0700, files 0600):
//   registry.sqlite   the database; a copy of what the journal states, with indexes
//   journal/RECORD    the events of one patient, sealed with the patient's key (AES-256-GCM), append-only
//   accounts          the accounts, sealed
//   deleted           record ids of deleted patients
//   id                random id of this registry
//   in_use/RECORD     locked while a program records with the patient's key; empty
//   audit.jsonl       audit.h
// An event is synchronised to the disk in the journal before the database gets it. open() completes what a
// killed program left. So the database can be made from journal and recordings at any time.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "phalanx/registry/accounts.h"
#include "phalanx/registry/audit.h"
#include "phalanx/registry/backup.h"
#include "phalanx/registry/key_store.h"
#include "phalanx/registry/patient.h"
#include "phalanx/registry/registry_error.h"
#include "phalanx/registry/result.h"
#include "phalanx/registry/trends.h"

namespace phalanx {

/// Version of the database's schema (PRAGMA user_version). A newer one is refused.
inline constexpr int kRegistrySchema = 1;

/// Settings of a registry.
struct RegistrySettings {
  std::filesystem::path folder;         ///< data folder; created if it does not exist
  Argon2Cost password_cost = {};        ///< of new passwords
  double idle_lock_s = 600.0;           ///< a signed-in account without a request for so long is locked [s]
  double longest_sign_in_s = 43200.0;   ///< after which a password is needed in any case [s]
  std::function<double()> utc = {};     ///< UTC [s since 1970]; empty: the system's clock
  std::function<double()> steady = {};  ///< for idle times [s]; empty: the system's steady clock
};

/// @returns the data folder: $PHALANX_PATIENTS_DIR, else $XDG_DATA_HOME/phalanx, else ~/.local/share/phalanx.
/// PHALANX_DATA_DIR is another folder: that of scenes and assets
[[nodiscard]] std::filesystem::path default_data_folder();

/// Use of a patient's key by a program that records with it: while it lives, no program can delete the patient. The
/// system ends it with the process.
class KeyUse {
 public:
  KeyUse() = default;
  KeyUse(const KeyUse&) = delete;
  KeyUse& operator=(const KeyUse&) = delete;
  virtual ~KeyUse() = default;
};

/// The store of patients. Several programs may use one folder at once: a lock file makes each operation
/// whole. Any thread, one operation at a time. Every function that takes an Actor throws RegistryError
/// kSignIn or kDenied if the actor may not, kDisk if the disk fails, kBusy if another program holds the lock for more than
/// 10 s, std::invalid_argument for an input out of range. An entry in the audit log precedes each read and change. Not
/// real-time.
class Registry {
 public:
  /// Opens or creates the registry, completes interrupted changes and deletions. Makes a missing database
  /// from the journal.
  /// @throws RegistryError kNewer, kDamaged (the text names the remedy), kDisk; std::invalid_argument if the
  /// key file lies in the data folder
  Registry(const RegistrySettings& settings, KeyStore keys);
  ~Registry();
  Registry(Registry&&) noexcept;
  Registry& operator=(Registry&&) noexcept;

  // --- patients ---
  /// @returns the living patients whose key is here, by code. Audit: "list"
  [[nodiscard]] std::vector<Patient> patients(const Actor& actor);
  /// @returns a patient by code, or by record id. Audit: "show". @throws RegistryError kUnknown
  [[nodiscard]] Patient patient(const Actor& actor, const std::string& code_or_record);
  /// Adds a patient with a new record id and key. @returns it. @throws RegistryError kConflict: the code
  /// is in use
  Patient add_patient(const Actor& actor, Patient patient);
  /// Replaces all fields of the patient with this record id.
  /// @param base  patient_revision() of the fields that the change was made from; empty: not checked
  /// @throws RegistryError kUnknown; kConflict: the code is in use, or the fields are no longer
  /// those of `base`
  Patient edit_patient(const Actor& actor, const Patient& patient, const std::string& base = {});
  /// Erases the patient's key, journal, rows and exports. Only the record id remains. Needs neither the key
  /// nor a readable row: what they would name is then left out of the report. @throws RegistryError kUnknown; kConflict if
  /// a program uses the key (KeyUse): it is named, with what to do
  DeleteReport delete_patient(const Actor& actor, const std::string& record);
  /// @returns record ids that have data but no key here (another key file), sorted
  [[nodiscard]] std::vector<std::string> patients_without_key(const Actor& actor);

  /// @returns record ids whose key is here, but whose patient can be read neither in the database nor in the
  /// journal, sorted. restore() brings them back from a backup
  [[nodiscard]] std::vector<std::string> damaged_patients(const Actor& actor);

  // --- results, tests, notes ---
  /// States that a recording belongs to a patient, before it is written. A plain recording needs
  /// it for rebuild().
  void add_recording(const Actor& actor, const std::string& record, const std::string& file_name);
  /// @returns file names of recordings that add_recording() has stated and no result names, sorted: those of programs that were
  /// killed before they could add a result, and those in which no exercise began. Audit: "recordings"
  [[nodiscard]] std::vector<std::string> recordings_without_result(const Actor& actor,
                                                                   const std::string& record);
  /// Adds a result. One with the same recording and number changes nothing. @returns false if it existed
  bool add_result(const Actor& actor, const std::string& record, const ResultRow& row);
  /// @returns the results by date. Audit: "results"
  [[nodiscard]] std::vector<ResultRow> results(const Actor& actor, const std::string& record);
  void add_test(const Actor& actor, const std::string& record, const EnteredTest& test);
  /// @returns the tests in the order of their entry. Audit: "tests"
  [[nodiscard]] std::vector<EnteredTest> tests(const Actor& actor, const std::string& record);
  void add_note(const Actor& actor, const std::string& record, const std::string& text);
  [[nodiscard]] std::vector<PatientNote> notes(const Actor& actor, const std::string& record);
  /// @returns make_trends() of the patient's results and tests. Audit: "trend"
  [[nodiscard]] std::vector<Trend> trends(const Actor& actor, const std::string& record);
  /// @returns key of the patient's recordings: RecorderSettings::encryption. Audit: "record"
  [[nodiscard]] RecordingEncryption recording_key(const Actor& actor, const std::string& record);
  /// States that this program records with the patient's key. @returns what ends it when it is destroyed. Audit: none.
  /// @throws RegistryError kUnknown
  [[nodiscard]] std::shared_ptr<const KeyUse> use_key(const Actor& actor, const std::string& record);
  /// @returns finder of the keys of all recordings; the roles that see patients only. Audit: "keys"
  [[nodiscard]] FindRecordingKey recording_keys(const Actor& actor);

  // --- files ---
  /// Writes patient.json, results.csv and tests.csv to a new or empty folder, and remembers them:
  /// delete_patient() removes them. They are plain. @param folder  outside the data folder. @throws
  /// std::invalid_argument if it is empty or inside
  ExportReport export_patient(const Actor& actor, const std::string& record,
                              const std::filesystem::path& folder = {});
  /// Makes the same files in memory, for a page that saves them elsewhere: nothing is written, and
  /// delete_patient() does not know of them. Audit: "export". @throws RegistryError kUnknown
  [[nodiscard]] std::vector<ExportText> export_texts(const Actor& actor, const std::string& record);
  /// Makes the rows again from the journal and the recordings. Rows whose recording is missing are kept.
  /// An encrypted recording adds rows only to the patient whose key opens it. A plain one adds rows only
  /// if the registry knows its file name. @param recordings  files or folders; a folder stands for its
  /// *.mcap and *.mcap.enc
  RebuildReport rebuild(const Actor& actor, const std::vector<std::filesystem::path>& recordings,
                        const RecordedResultsOf& reader);
  /// Writes a backup as a new folder. @throws RegistryError kConflict if it exists
  BackupReport backup(const Actor& actor, const std::filesystem::path& folder);
  /// Brings back what a backup holds. Events that are newer than the backup stay. Deleted patients stay
  /// deleted. Damaged files of the backup are left out and named. If accounts_lost(), any actor may restore.
  /// @throws RegistryError kUnknown, kNewer, kDamaged (the manifest); nothing is changed then
  RestoreReport restore(const Actor& actor, const std::filesystem::path& backup);

  // --- audit ---
  /// Checks the chain and compares it with the head beside the keys. Role: administrator
  [[nodiscard]] AuditCheck check_audit(const Actor& actor);
  /// @returns the newest lines, oldest first. Role: administrator
  [[nodiscard]] std::vector<AuditEntry> audit(const Actor& actor, std::size_t newest = 1000);

  // --- accounts ---
  [[nodiscard]] bool has_accounts();
  /// @returns whether accounts existed whose file is missing or damaged. Then only restore() is permitted,
  /// to any actor
  [[nodiscard]] bool accounts_lost();
  /// Role: administrator
  [[nodiscard]] std::vector<Account> accounts(const Actor& actor);
  /// Adds an account. The first one must be an administrator, and ends the owner mode.
  /// @throws RegistryError kConflict
  void add_account(const Actor& actor, const Account& account, const std::string& password);
  /// Changes the role. The last administrator stays one. @throws RegistryError kUnknown, kConflict
  void edit_account(const Actor& actor, const Account& account);
  /// Removes an account. The last administrator can be removed only as the last account.
  void delete_account(const Actor& actor, const std::string& name);
  /// Changes a password: an administrator any, others their own.
  void set_password(const Actor& actor, const std::string& name, const std::string& password);
  /// Checks a password once, for a command. @throws RegistryError kSignIn, kDelayed
  Actor authenticate(const std::string& name, const std::string& password);
  /// Signs in. @returns a token of 64 hexadecimal digits, kept in memory only. @throws
  /// RegistryError kSignIn, kDelayed
  std::string sign_in(const std::string& name, const std::string& password);
  /// @returns the state of a token. A request of an active one restarts its idle time if `touch`.
  SignedIn signed_in(const std::string& token, bool touch = true);
  /// Ends the lock of a token. @throws RegistryError kSignIn, kDelayed
  void unlock(const std::string& token, const std::string& password);
  void lock(const std::string& token);
  void sign_out(const std::string& token);

  [[nodiscard]] const std::filesystem::path& folder() const noexcept;
  [[nodiscard]] const KeyStore& keys() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Changes a patient by a function of the stored fields. If the patient is changed by another one meanwhile, the function is
/// applied once more, to the new fields: nothing of either change is lost.
/// @param change  @returns false if it changes nothing; then nothing is stored
/// @returns what `change` returned
/// @throws RegistryError as patient() and edit_patient(); kConflict only at the second time
bool update_patient(Registry& registry, const Actor& actor, const std::string& record,
                    const std::function<bool(Patient&)>& change);

}  // namespace phalanx
