// SPDX-License-Identifier: Apache-2.0
// phalanx patient audit | passphrase.
#include <fmt/format.h>

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <string>

#include "patient/patient_commands.h"
#include "patient/patient_text.h"
#include "patient/secret.h"

namespace phalanx {
namespace {

struct AuditOptions {
  RegistryOptions registry = {};
  std::size_t newest = 20;
  bool check = false;
};

struct PassphraseOptions {
  RegistryOptions registry = {};
  bool none = false;
};

int print_audit(const AuditOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  if (!o.check)
    for (const AuditEntry& entry : opened.registry.audit(opened.actor, o.newest))
      fmt::print("{:>6}  {}  {:<16} {:<16} {} {}\n", entry.n, entry.time, printable(entry.account),
                 entry.action, entry.record, printable(entry.detail));
  const AuditCheck check = opened.registry.check_audit(opened.actor);
  fmt::print("{}\n", printable(check.text));
  return check.whole ? kDone : kFailed;
}

int change_passphrase(const PassphraseOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  if (opened.actor.role != Role::kAdministrator)
    throw RegistryError(
        RegistryFault::kDenied,
        fmt::format("{}: only an administrator changes the passphrase", opened.actor.account));
  KeyStore keys = opened.registry.keys();
  const std::string file = keys.file().string();
  const std::string passphrase = o.none ? ""
                                        : read_new_secret({.what = fmt::format("new passphrase of {}", file),
                                                           .environment = "PHALANX_NEW_PASSPHRASE"});
  if (!o.none && passphrase.empty())
    throw std::invalid_argument(
        "the new passphrase is empty; type one, or --none for a master key beside the file");
  keys.change_passphrase(passphrase);
  fmt::print(
      "{}: {}\n", file,
      o.none ? "its master key lies beside it from now on" : "the new passphrase opens it from now on");
  return kDone;
}

}  // namespace

void add_patient_control_commands(CLI::App& patient, Job& job) {
  auto audited = std::make_shared<AuditOptions>();
  CLI::App* audit =
      add_patient_job(patient, "audit", "Print the newest lines of the audit log, and check its chain",
                      audited, job, print_audit);
  audit->footer("Exit codes: 0 the chain is whole, 1 a line is missing or changed, 2 wrong usage.");
  audit->add_option("--newest", audited->newest, "how many lines")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str()
      ->type_name("N");
  audit->add_flag("--check", audited->check, "the check alone");
  auto changed = std::make_shared<PassphraseOptions>();
  CLI::App* passphrase = add_patient_job(patient, "passphrase", "Wrap the key file by another passphrase",
                                         changed, job, change_passphrase);
  passphrase->footer(
      "PHALANX_PASSPHRASE or the terminal has the present one, PHALANX_NEW_PASSPHRASE or the terminal the "
      "new one.");
  passphrase->add_flag("--none", changed->none, "a random master key in a file beside it instead");
}

}  // namespace phalanx
