// SPDX-License-Identifier: Apache-2.0
// The SQLite database of the registry, through SOCI. It holds sealed texts only, in hexadecimal digits.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace phalanx::registry {

/// Row of a patient: how far the journal has been applied, and the newest state, sealed.
struct PatientRow {
  std::string record = {};
  std::string generation = {};  ///< of the journal's file
  std::uint64_t events = 0;     ///< of the journal that are applied
  std::uint64_t bytes = 0;      ///< their end in the journal's file
  std::string sealed = {};      ///< empty: deleted
};

/// Row of a result or of another entry, sealed.
struct SealedRow {
  std::string place = {};  ///< result: keyed hash of recording and number; entry: its number
  std::string sealed = {};
};

/// Failed sign-ins of an account.
struct SignInFailures {
  int count = 0;
  double last = 0.0;  ///< UTC [s since 1970]
};

/// The database. Write-ahead log, synchronous = FULL, secure_delete. Every function throws RegistryError
/// kDisk or kDamaged.
class Database {
 public:
  /// Opens or creates it. @throws RegistryError kNewer, kDamaged, kDisk
  explicit Database(const std::filesystem::path& file);
  ~Database();
  Database(Database&&) noexcept;
  Database& operator=(Database&&) noexcept;

  /// Calls a function in one transaction.
  template <typename Function>
  void transaction(const Function& function) {
    begin();
    try {
      function();
      commit();
    } catch (...) {
      roll_back();
      throw;
    }
  }

  [[nodiscard]] std::vector<PatientRow> patients();
  [[nodiscard]] std::optional<PatientRow> patient(const std::string& record);
  void put_patient(const PatientRow& row);
  void put_result(const std::string& record, const SealedRow& row);
  [[nodiscard]] bool has_result(const std::string& record, const std::string& place);
  [[nodiscard]] std::vector<SealedRow> results(const std::string& record);
  void put_entry(const std::string& record, std::uint64_t number, const std::string& sealed);
  /// @returns the entries by number
  [[nodiscard]] std::vector<SealedRow> entries(const std::string& record);
  /// Removes all rows of a record but that of the patient.
  void remove_rows(const std::string& record);
  /// Removes all rows of a record, and leaves a row without content.
  void remove_patient(const std::string& record);
  /// Removes all free space, and empties the write-ahead log.
  void compact();
  /// Writes a consistent copy to an empty file.
  void copy_to(const std::filesystem::path& file);

  [[nodiscard]] SignInFailures failures(const std::string& account);
  void put_failures(const std::string& account, const SignInFailures& failures);
  void clear_failures(const std::string& account);

  /// @returns the schema's version of a database file. @throws RegistryError kDamaged if it is none
  [[nodiscard]] static int schema_of(const std::filesystem::path& file);

 private:
  struct Session;
  void begin();
  void commit();
  void roll_back() noexcept;
  std::unique_ptr<Session> session_;
};

}  // namespace phalanx::registry
