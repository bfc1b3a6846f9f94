// SPDX-License-Identifier: Apache-2.0
#include "registry/database.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <soci/soci.h>
#include <soci/sqlite3/soci-sqlite3.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "phalanx/registry/registry.h"
#include "phalanx/registry/registry_error.h"
#include "registry/private_file.h"

namespace phalanx::registry {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPatients = R"(CREATE TABLE patients (record TEXT PRIMARY KEY, generation TEXT NOT NULL,
  events INTEGER NOT NULL, bytes INTEGER NOT NULL, sealed TEXT NOT NULL) WITHOUT ROWID)";
constexpr const char* kResults = R"(CREATE TABLE results (record TEXT NOT NULL, place TEXT NOT NULL,
  sealed TEXT NOT NULL, PRIMARY KEY (record, place)) WITHOUT ROWID)";
constexpr const char* kEntries = R"(CREATE TABLE entries (record TEXT NOT NULL, number INTEGER NOT NULL,
  sealed TEXT NOT NULL, PRIMARY KEY (record, number)) WITHOUT ROWID)";
constexpr const char* kFailures = R"(CREATE TABLE failures (account TEXT PRIMARY KEY, count INTEGER NOT NULL,
  last REAL NOT NULL) WITHOUT ROWID)";

/// Calls a function, and turns a failure of the database into a RegistryError.
template <typename Function>
auto guarded(const fs::path& file, const Function& function) {
  try {
    return function();
  } catch (const soci::soci_error& error) {
    const std::string reason = error.get_error_message();
    const bool damaged = reason.find("malformed") != std::string::npos ||
                         reason.find("not a database") != std::string::npos ||
                         reason.find("no such") != std::string::npos;
    throw RegistryError(damaged ? RegistryFault::kDamaged : RegistryFault::kDisk,
                        damaged
                            ? fmt::format("{} is damaged ({}); move it away: the journal makes it again",
                                          file.string(), reason)
                            : fmt::format("{} cannot be read or written ({}); check the disk and its rights",
                                          file.string(), reason));
  }
}

/// Makes the file with its mode before SQLite does; the write-ahead log gets the same.
void make_file(const fs::path& file) {
  if (file.string().find('"') != std::string::npos)
    throw RegistryError(
        RegistryFault::kDisk,
        fmt::format("the path {} has a quotation mark; choose another folder", file.string()));
  const Descriptor made(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0600));
  if (!made.valid())
    throw RegistryError(RegistryFault::kDisk,
                        fmt::format("{} cannot be opened: {}; check the disk and its rights", file.string(),
                                    std::generic_category().message(errno)));
}

long long signed_of(std::uint64_t number) noexcept { return static_cast<long long>(number); }
std::uint64_t unsigned_of(long long number) noexcept { return static_cast<std::uint64_t>(number); }

int user_version(soci::session& sql) {
  int version = 0;
  sql << "PRAGMA user_version", soci::into(version);
  return version;
}

}  // namespace

struct Database::Session {
  fs::path file;
  soci::session sql;

  explicit Session(const fs::path& name) : file(name) {
    sql.open(soci::sqlite3, fmt::format("dbname=\"{}\" timeout=30", name.string()));
  }
};

Database::Database(const fs::path& file) {
  make_file(file);
  guarded(file, [&] {
    session_ = std::make_unique<Session>(file);
    soci::session& sql = session_->sql;
    const int version = user_version(sql);
    if (version > kRegistrySchema)
      throw RegistryError(RegistryFault::kNewer,
                          fmt::format("{} has schema {}; this program knows {}: install a newer one",
                                      file.string(), version, kRegistrySchema));
    std::string mode;
    sql << "PRAGMA journal_mode = WAL", soci::into(mode);
    sql << "PRAGMA synchronous = FULL";
    int secure = 0;
    sql << "PRAGMA secure_delete = ON", soci::into(secure);
    sql << "PRAGMA temp_store = MEMORY";
    std::string state;
    sql << "PRAGMA quick_check(1)", soci::into(state);
    if (state != "ok")
      throw RegistryError(
          RegistryFault::kDamaged,
          fmt::format("{} is damaged ({}); move it away: the journal makes it again", file.string(), state));
    if (version == kRegistrySchema) return;
    int tables = 0;
    sql << "SELECT count(*) FROM sqlite_master", soci::into(tables);
    if (tables != 0)
      throw RegistryError(
          RegistryFault::kDamaged,
          fmt::format("{} is another program's database; choose another folder", file.string()));
    transaction([&] {
      for (const char* table : {kPatients, kResults, kEntries, kFailures}) sql << table;
      sql << fmt::format("PRAGMA user_version = {}", kRegistrySchema);
    });
  });
}

Database::~Database() = default;
Database::Database(Database&&) noexcept = default;
Database& Database::operator=(Database&&) noexcept = default;

void Database::begin() {
  guarded(session_->file, [&] { session_->sql << "BEGIN IMMEDIATE"; });
}
void Database::commit() {
  guarded(session_->file, [&] { session_->sql << "COMMIT"; });
}
void Database::roll_back() noexcept {
  try {
    session_->sql << "ROLLBACK";
  } catch (...) {  // there is no transaction any more
  }
}

std::vector<PatientRow> Database::patients() {
  return guarded(session_->file, [&] {
    std::vector<PatientRow> out;
    const soci::rowset<soci::row> rows =
        (session_->sql.prepare
         << "SELECT record, generation, CAST(events AS TEXT), CAST(bytes AS TEXT), sealed FROM "
            "patients ORDER BY record");
    for (const soci::row& row : rows)
      out.push_back({.record = row.get<std::string>(0),
                     .generation = row.get<std::string>(1),
                     .events = std::stoull(row.get<std::string>(2)),
                     .bytes = std::stoull(row.get<std::string>(3)),
                     .sealed = row.get<std::string>(4)});
    return out;
  });
}

std::optional<PatientRow> Database::patient(const std::string& record) {
  return guarded(session_->file, [&]() -> std::optional<PatientRow> {
    PatientRow out{.record = record};
    long long events = 0;
    long long bytes = 0;
    session_->sql << "SELECT generation, events, bytes, sealed FROM patients WHERE record = :record",
        soci::into(out.generation), soci::into(events), soci::into(bytes), soci::into(out.sealed),
        soci::use(record);
    if (!session_->sql.got_data()) return std::nullopt;
    out.events = unsigned_of(events);
    out.bytes = unsigned_of(bytes);
    return out;
  });
}

void Database::put_patient(const PatientRow& row) {
  guarded(session_->file, [&] {
    const long long events = signed_of(row.events);
    const long long bytes = signed_of(row.bytes);
    session_->sql
        << "INSERT OR REPLACE INTO patients (record, generation, events, bytes, sealed) VALUES (:record, "
           ":generation, :events, :bytes, :sealed)",
        soci::use(row.record), soci::use(row.generation), soci::use(events), soci::use(bytes),
        soci::use(row.sealed);
  });
}

void Database::put_result(const std::string& record, const SealedRow& row) {
  guarded(session_->file, [&] {
    session_->sql
        << "INSERT OR REPLACE INTO results (record, place, sealed) VALUES (:record, :place, :sealed)",
        soci::use(record), soci::use(row.place), soci::use(row.sealed);
  });
}

bool Database::has_result(const std::string& record, const std::string& place) {
  return guarded(session_->file, [&] {
    int count = 0;
    session_->sql << "SELECT count(*) FROM results WHERE record = :record AND place = :place",
        soci::into(count), soci::use(record), soci::use(place);
    return count > 0;
  });
}

std::vector<SealedRow> Database::results(const std::string& record) {
  return guarded(session_->file, [&] {
    std::vector<SealedRow> out;
    const soci::rowset<soci::row> rows =
        (session_->sql.prepare << "SELECT place, sealed FROM results WHERE record = :record ORDER BY place",
         soci::use(record));
    for (const soci::row& row : rows)
      out.push_back({.place = row.get<std::string>(0), .sealed = row.get<std::string>(1)});
    return out;
  });
}

void Database::put_entry(const std::string& record, std::uint64_t number, const std::string& sealed) {
  guarded(session_->file, [&] {
    const long long of_entry = signed_of(number);
    session_->sql
        << "INSERT OR REPLACE INTO entries (record, number, sealed) VALUES (:record, :number, :sealed)",
        soci::use(record), soci::use(of_entry), soci::use(sealed);
  });
}

std::vector<SealedRow> Database::entries(const std::string& record) {
  return guarded(session_->file, [&] {
    std::vector<SealedRow> out;
    const soci::rowset<soci::row> rows =
        (session_->sql.prepare
             << "SELECT CAST(number AS TEXT), sealed FROM entries WHERE record = :record ORDER BY number",
         soci::use(record));
    for (const soci::row& row : rows)
      out.push_back({.place = row.get<std::string>(0), .sealed = row.get<std::string>(1)});
    return out;
  });
}

void Database::remove_rows(const std::string& record) {
  guarded(session_->file, [&] {
    session_->sql << "DELETE FROM results WHERE record = :record", soci::use(record);
    session_->sql << "DELETE FROM entries WHERE record = :record", soci::use(record);
  });
}

void Database::remove_patient(const std::string& record) {
  remove_rows(record);
  put_patient({.record = record});
}

void Database::compact() {
  guarded(session_->file, [&] {
    session_->sql << "VACUUM";
    int busy = 0;
    session_->sql << "PRAGMA wal_checkpoint(TRUNCATE)", soci::into(busy);
  });
}

void Database::copy_to(const fs::path& file) {
  make_file(file);
  guarded(file, [&] {
    const std::string name = file.string();
    session_->sql << "VACUUM INTO :name", soci::use(name);
  });
  synchronise_file(file);  // SQLite does not
}

SignInFailures Database::failures(const std::string& account) {
  return guarded(session_->file, [&] {
    SignInFailures out;
    session_->sql << "SELECT count, last FROM failures WHERE account = :account", soci::into(out.count),
        soci::into(out.last), soci::use(account);
    return session_->sql.got_data() ? out : SignInFailures{};
  });
}

void Database::put_failures(const std::string& account, const SignInFailures& failures) {
  guarded(session_->file, [&] {
    session_->sql
        << "INSERT OR REPLACE INTO failures (account, count, last) VALUES (:account, :count, :last)",
        soci::use(account), soci::use(failures.count), soci::use(failures.last);
    // Names that no account has are counted, too; their number must not grow without bound.
    session_->sql
        << "DELETE FROM failures WHERE account NOT IN (SELECT account FROM failures ORDER BY last DESC "
           "LIMIT 10000)";
  });
}

void Database::clear_failures(const std::string& account) {
  guarded(session_->file,
          [&] { session_->sql << "DELETE FROM failures WHERE account = :account", soci::use(account); });
}

int Database::schema_of(const fs::path& file) {
  constexpr std::size_t kPlace =
      60;  // of the user version in the file's head, big-endian: sqlite.org/fileformat.html
  const std::string text = read_private_file(file).value_or("");
  if (text.size() < 100 || text.compare(0, 15, "SQLite format 3") != 0)
    throw RegistryError(RegistryFault::kDamaged, fmt::format("{} is no database", file.string()));
  int version = 0;
  for (std::size_t i = 0; i < 4; ++i) version = version * 256 + static_cast<unsigned char>(text[kPlace + i]);
  return version;
}

}  // namespace phalanx::registry
