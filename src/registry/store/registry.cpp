// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/registry.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "registry/field_checks.h"
#include "registry/store/registry_impl.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

/// @returns the random id of the data folder; makes it if it is missing
std::string folder_id(const fs::path& folder) {
  const fs::path file = folder / "id";
  const std::string text = registry::read_private_file(file).value_or("");
  if (const std::string id = text.substr(0, text.find('\n')); is_record_id(id)) return id;
  std::string id = registry::random_record_id();
  registry::replace_private_file(file, fmt::format("{}\n", id));
  return id;
}

bool lies_in(const fs::path& file, const fs::path& folder) {
  const fs::path relative = fs::weakly_canonical(file).lexically_relative(fs::weakly_canonical(folder));
  return !relative.empty() && *relative.begin() != "..";
}

std::string patient_event(const Patient& patient) {
  return json{{"event", "patient"}, {"patient", json::parse(patient_json(patient))}}.dump();
}

/// @returns the symbol that the fewest patients have
std::string free_symbol(const std::vector<Patient>& patients) {
  const auto uses = [&](std::string_view symbol) {
    return std::count_if(patients.begin(), patients.end(),
                         [&](const Patient& each) { return each.symbol == symbol; });
  };
  const std::span<const std::string_view> symbols = patient_symbols();
  return std::string(
      *std::min_element(symbols.begin(), symbols.end(),
                        [&](std::string_view a, std::string_view b) { return uses(a) < uses(b); }));
}

void require_free_code(const std::vector<Patient>& patients, const Patient& patient) {
  for (const Patient& each : patients)
    if (each.code == patient.code && each.record != patient.record)
      throw RegistryError(RegistryFault::kConflict,
                          fmt::format("the code {} is in use; choose another one", patient.code));
}

}  // namespace

Registry::Impl::Operation::Operation(Impl& registry)
    : guard_(registry.mutex), lock_(registry.folder / "lock") {
  registry.keys.check();
  registry.catch_up();
}

Registry::Impl::Impl(const RegistrySettings& given, KeyStore store)
    : settings(given), keys(std::move(store)) {
  if (settings.folder.empty())
    throw std::invalid_argument("the data folder has no name; name it with --data");
  folder = fs::absolute(settings.folder).lexically_normal();
  if (lies_in(keys.file(), folder))
    throw std::invalid_argument(
        fmt::format("the key file {} lies in the data folder {}: a copy of the folder would hold the keys; "
                    "name another place",
                    keys.file().string(), folder.string()));
  const bool own = !fs::exists(folder) || fs::exists(folder / "id");
  registry::make_private_folder(folder);
  if (own) static_cast<void>(::chmod(folder.c_str(), 0700));
  registry::make_private_folder(folder / "journal");
  const registry::FileLock lock(folder / "lock");
  audit = std::make_unique<registry::AuditTrail>(folder, keys.file(), folder_id(folder));
  db = std::make_unique<registry::Database>(folder / "registry.sqlite");
  registry::finish_replacement(folder / "accounts");
  for (const std::string& record : deleted_records(folder / "deleted"))
    if (keys.find(record)) keys.erase(record);  // an old key file was put back
  for (const std::string& record : keys.erased_ids()) finish_deletion(record);
  catch_up();
  for (const registry::PatientRow& row : db->patients())
    if (!row.sealed.empty() && !registry::stamp_of(journal_file(row.record))) catch_up(row.record);
}

void Registry::Impl::require(const Actor& actor, Permission permission) {
  if (accounts_file_is_missing())
    throw RegistryError(
        RegistryFault::kDamaged,
        fmt::format("{} is missing, and accounts existed; restore a backup", (folder / "accounts").string()));
  Role role = actor.role;
  if (accounts().empty()) {
    if (actor.account != Actor::owner().account)
      throw RegistryError(RegistryFault::kSignIn, fmt::format("there is no account {}", actor.account));
    role = Role::kAdministrator;
  } else {
    const StoredAccount* found = find_account(actor.account);
    if (found == nullptr)
      throw RegistryError(RegistryFault::kSignIn,
                          "this registry has accounts; sign in, or name one with --as");
    role = found->account.role;
  }
  const bool permitted =
      role == Role::kAdministrator || (role == Role::kTherapist && permission == Permission::kPatients);
  if (!permitted)
    throw RegistryError(RegistryFault::kDenied, fmt::format("the role {} of {} does not permit this",
                                                            role_name(role), actor.account));
}

void Registry::Impl::log(const Actor& actor, const std::string& action, const std::string& record,
                         const std::string& detail) {
  audit->append(utc(), actor.account, action, record, detail);
}

OpenRecord Registry::Impl::open_record(const std::string& record) {
  const std::optional<registry::PatientRow> row = is_record_id(record) ? db->patient(record) : std::nullopt;
  if (!row || row->sealed.empty())
    throw RegistryError(
        RegistryFault::kUnknown,
        fmt::format("there is no patient with record id {}; `phalanx patient list` shows all", record));
  const std::optional<registry::Key> key = row_key(record);
  if (!key)
    throw RegistryError(RegistryFault::kNoKey,
                        fmt::format("the key of record {} is not in {}; put back the key file that has it",
                                    record, keys.file().string()));
  const auto open = [&](const registry::PatientRow& from) {
    return open_row(*key, fmt::format("patient|{}", record), from.sealed);
  };
  std::optional<registry::PatientRow> current = row;
  std::optional<std::string> text = open(*current);
  if (!text) {  // the row is damaged: the journal makes it again
    apply_all(record, *key);
    current = db->patient(record);
    if (current) text = open(*current);
  }
  if (!text)
    throw RegistryError(RegistryFault::kDamaged,
                        fmt::format("row and journal of record {} are damaged; restore a backup", record));
  OpenRecord out{.key = *key, .row = *current, .journal = journal_of(record, *key)};
  try {
    out.patient = parse_patient_json(*text);
  } catch (const std::invalid_argument& error) {
    throw RegistryError(RegistryFault::kDamaged, fmt::format("record {}: {}", record, error.what()));
  }
  out.patient.record = record;
  return out;
}

std::vector<Patient> Registry::Impl::all_patients(std::set<std::string>* damaged) {
  std::vector<Patient> out;
  for (const registry::PatientRow& row : db->patients()) {
    if (row.sealed.empty() || !keys.find(row.record)) continue;
    try {
      out.push_back(open_record(row.record).patient);
    } catch (const RegistryError& error) {  // one damaged record must not hide the others
      if (error.fault() != RegistryFault::kDamaged) throw;
      if (damaged != nullptr) damaged->insert(row.record);
    }
  }
  std::sort(out.begin(), out.end(), [](const Patient& a, const Patient& b) {
    return std::tie(a.code, a.record) < std::tie(b.code, b.record);
  });
  return out;
}

void Registry::Impl::add_event(OpenRecord& open, const std::string& event) {
  const registry::JournalPlace before = {.events = open.row.events, .bytes = open.row.bytes};
  const registry::JournalPlace after = open.journal.append(open.row.generation, before, event);
  try {
    db->transaction([&] {
      registry::PatientRow next = open.row;
      apply_event(next.record, open.key, next.events, event, next);
      next.events = after.events;
      next.bytes = after.bytes;
      db->put_patient(next);
      open.row = std::move(next);
    });
  } catch (...) {  // the caller is told that it failed: it must not happen later
    open.row.events = before.events;
    open.row.bytes = before.bytes;
    open.journal.cut(before);
    throw;
  }
  if (const auto stamp = registry::stamp_of(journal_file(open.row.record))) seen[open.row.record] = *stamp;
}

Registry::Registry(const RegistrySettings& settings, KeyStore keys)
    : impl_(std::make_unique<Impl>(settings, std::move(keys))) {}
Registry::~Registry() = default;
Registry::Registry(Registry&&) noexcept = default;
Registry& Registry::operator=(Registry&&) noexcept = default;

const fs::path& Registry::folder() const noexcept { return impl_->folder; }
const KeyStore& Registry::keys() const noexcept { return impl_->keys; }

std::vector<Patient> Registry::patients(const Actor& actor) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  impl_->log(actor, "list", "*");
  return impl_->all_patients();
}

Patient Registry::patient(const Actor& actor, const std::string& code_or_record) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  for (Patient& each : impl_->all_patients())
    if (each.code == code_or_record || each.record == code_or_record) {
      impl_->log(actor, "show", each.record);
      return std::move(each);
    }
  impl_->log(actor, "show_failed", "*");
  if (is_record_id(code_or_record)) static_cast<void>(impl_->open_record(code_or_record));  // states why
  throw RegistryError(
      RegistryFault::kUnknown,
      fmt::format("there is no patient {}; `phalanx patient list` shows all", code_or_record));
}

Patient Registry::add_patient(const Actor& actor, Patient patient) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  const std::vector<Patient> others = impl_->all_patients();
  patient.record = registry::random_record_id();
  if (patient.symbol.empty()) patient.symbol = free_symbol(others);
  check_patient_fields(patient);
  impl_->logged_if_it_fails(actor, "add_failed", [&] { require_free_code(others, patient); });
  impl_->log(actor, "add", patient.record);
  impl_->keys.add(patient.record);
  const std::optional<registry::Key> key = impl_->row_key(patient.record);
  if (!key) throw RegistryError(RegistryFault::kDisk, "the key file cannot be read again");
  registry::Journal journal = impl_->journal_of(patient.record, *key);
  try {
    static_cast<void>(journal.replace({patient_event(patient)}));
    impl_->catch_up(patient.record);
  } catch (...) {  // the caller is told that it failed: it must not happen later
    journal.erase();
    throw;
  }
  return patient;
}

Patient Registry::edit_patient(const Actor& actor, const Patient& patient, const std::string& base) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  std::optional<OpenRecord> open;
  Patient next = patient;
  impl_->logged_if_it_fails(actor, "edit_failed", [&] {
    open = impl_->open_record(patient.record);
    if (!base.empty() && patient_revision(open->patient) != base)
      throw RegistryError(
          RegistryFault::kConflict,
          fmt::format("{} was changed meanwhile; open the patient again and repeat the change",
                      open->patient.code));
    if (next.symbol.empty()) next.symbol = open->patient.symbol;
    check_patient_fields(next);
    require_free_code(impl_->all_patients(), next);
  });
  impl_->log(actor, "edit", next.record);
  impl_->add_event(*open, patient_event(next));
  return next;
}

std::vector<std::string> Registry::patients_without_key(const Actor& actor) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  std::set<std::string> out;
  for (const registry::PatientRow& row : impl_->db->patients())
    if (!row.sealed.empty() && !impl_->keys.find(row.record)) out.insert(row.record);
  for (const std::string& record : impl_->journal_records())
    if (!impl_->keys.find(record)) out.insert(record);
  return {out.begin(), out.end()};
}

std::vector<std::string> Registry::damaged_patients(const Actor& actor) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kPatients);
  std::set<std::string> out;
  static_cast<void>(impl_->all_patients(&out));
  for (const std::string& record :
       impl_->journal_records()) {  // a journal without a readable patient has no row
    const std::optional<registry::PatientRow> row = impl_->db->patient(record);
    if ((!row || row->sealed.empty()) && impl_->keys.find(record)) out.insert(record);
  }
  return {out.begin(), out.end()};
}

AuditCheck Registry::check_audit(const Actor& actor) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kAdministration);
  return impl_->audit->check();
}

std::vector<AuditEntry> Registry::audit(const Actor& actor, std::size_t newest) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kAdministration);
  return impl_->audit->newest(newest);
}

fs::path default_data_folder() {
  const auto variable = [](const char* name) -> std::string {
    const char* value = std::getenv(name);  // NOLINT(concurrency-mt-unsafe)
    return value == nullptr ? std::string() : std::string(value);
  };
  if (const std::string folder = variable("PHALANX_PATIENTS_DIR"); !folder.empty()) return folder;
  if (const std::string folder = variable("XDG_DATA_HOME"); !folder.empty())
    return fs::path(folder) / "phalanx";
  return fs::path(variable("HOME")) / ".local" / "share" / "phalanx";
}

}  // namespace phalanx
