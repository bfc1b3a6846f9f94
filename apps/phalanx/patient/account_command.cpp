// SPDX-License-Identifier: Apache-2.0
// phalanx account: the people who may sign in to the registry of patients.
#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "patient/patient_commands.h"
#include "patient/secret.h"

namespace phalanx {
namespace {

struct AccountOptions {
  RegistryOptions registry = {};
  std::string name = {};
  std::string role = {};
  bool confirmed = false;
};

std::string new_password_of(const std::string& name) {
  return read_new_secret(
      {.what = fmt::format("new password of {} (at least {} bytes)", name, kShortestPassword),
       .environment = "PHALANX_NEW_PASSWORD"});
}

int add_account(const AccountOptions& o) {
  const Account account{.name = o.name, .role = parse_role(o.role)};
  OpenedRegistry opened = open_registry(o.registry, MissingRegistry::kMade);
  opened.registry.add_account(opened.actor, account, new_password_of(o.name));
  fmt::print("{}: {}\n", account.name, role_name(account.role));
  return kDone;
}

int list_accounts(const AccountOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  const std::vector<Account> accounts = opened.registry.accounts(opened.actor);
  if (accounts.empty())
    fmt::print("no accounts: each user of this computer who can read {} is its owner\n",
               opened.registry.folder().string());
  for (const Account& account : accounts) fmt::print("{:<32} {}\n", account.name, role_name(account.role));
  return kDone;
}

int edit_account(const AccountOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  const Account account{.name = o.name, .role = parse_role(o.role)};
  opened.registry.edit_account(opened.actor, account);
  fmt::print("{}: {}\n", account.name, role_name(account.role));
  return kDone;
}

int delete_account(const AccountOptions& o) {
  if (!o.confirmed)
    throw std::invalid_argument(
        fmt::format("{} could not sign in any more; type the same with --yes", o.name));
  OpenedRegistry opened = open_registry(o.registry);
  opened.registry.delete_account(opened.actor, o.name);
  fmt::print("deleted the account {}\n", o.name);
  if (!opened.registry.has_accounts())
    fmt::print("  it was the last one: each user of this computer who can read {} is its owner again\n",
               opened.registry.folder().string());
  return kDone;
}

int change_password(const AccountOptions& o) {
  OpenedRegistry opened = open_registry(o.registry);
  opened.registry.set_password(opened.actor, o.name, new_password_of(o.name));
  fmt::print("{} has a new password\n", o.name);
  return kDone;
}

}  // namespace

void add_account_command(CLI::App& app, Job& job) {
  CLI::App* account =
      app.add_subcommand("account", "The people who sign in to the registry: add, list, edit, delete");
  account->require_subcommand(1);
  account->footer(
      "Without accounts, each user who can read the data folder is its owner and may do everything.\n"
      "The first account must be an administrator; from then on every command needs --as ACCOUNT.\n"
      "PHALANX_PASSWORD or the terminal has the password of --as, PHALANX_NEW_PASSWORD or the terminal a\n"
      "new one.\n"
      "Roles: docs/patients.md.");
  const auto add = [&](const char* name, const char* help, int (*work)(const AccountOptions&)) {
    auto options = std::make_shared<AccountOptions>();
    CLI::App* command = add_patient_job(*account, name, help, options, job, work);
    if (work != list_accounts)
      command->add_option("NAME", options->name, "the account")->required()->type_name("");
    if (work == add_account || work == edit_account)
      command->add_option("--role", options->role, "administrator, therapist, look_on or patient_screen")
          ->required()
          ->check(CLI::IsMember({"administrator", "therapist", "look_on", "patient_screen"}))
          ->type_name("ROLE");
    if (work == delete_account) command->add_flag("--yes", options->confirmed, "delete without asking");
  };
  add("add", "Add an account; asks for its password", add_account);
  add("list", "List the accounts", list_accounts);
  add("edit", "Change the role of an account", edit_account);
  add("delete", "Delete an account", delete_account);
  add("password", "Change the password of an account", change_password);
}

}  // namespace phalanx
