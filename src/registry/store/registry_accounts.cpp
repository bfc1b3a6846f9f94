// SPDX-License-Identifier: Apache-2.0
// Accounts, passwords and who is signed in.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "registry/field_checks.h"
#include "registry/store/registry_impl.h"

namespace phalanx {
namespace {

using nlohmann::json;

constexpr const char* kAccountsContext = "phalanx accounts";
constexpr int kFreeFailures = 3;         ///< after which sign-ins are delayed
constexpr double kLongestDelay = 900.0;  ///< [s]
constexpr std::size_t kMostTokens = 1000;
constexpr std::size_t kMostAccounts = 1000;

bool is_account_name(const std::string& name) noexcept {
  return registry::has_only(name, "a-z0-9._-", 32) && name.front() >= 'a' && name.front() <= 'z';
}

void check_account_name(const std::string& name) {
  if (!is_account_name(name) || name == Actor::owner().account)
    throw std::invalid_argument(fmt::format(
        "the name \"{}\" must be 1 to 32 of a-z, 0-9, '.', '_', '-', begin with a letter, and not be "
        "\"owner\"",
        name));
}

void check_new_password(const std::string& password) {
  if (password.size() < kShortestPassword || password.size() > kLongestPassword)
    throw std::invalid_argument(
        fmt::format("a password has {} to {} bytes", kShortestPassword, kLongestPassword));
}

/// @returns the delay after so many failures [s]: 2, 4, 8, ... from the third one on
double delay_after(int failures) noexcept {
  return failures < kFreeFailures
             ? 0.0
             : std::min(kLongestDelay, std::ldexp(1.0, std::min(failures, 20) - kFreeFailures + 1));
}

std::size_t administrators(const std::vector<StoredAccount>& all) {
  return static_cast<std::size_t>(std::count_if(all.begin(), all.end(), [](const StoredAccount& each) {
    return each.account.role == Role::kAdministrator;
  }));
}

[[noreturn]] void fail_unknown(const std::string& name) {
  throw RegistryError(RegistryFault::kUnknown,
                      fmt::format("there is no account {}; `phalanx account list` shows all", name));
}

}  // namespace

double Registry::Impl::utc() const {
  if (settings.utc) return settings.utc();
  return std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
}

double Registry::Impl::steady() const {
  if (settings.steady) return settings.steady();
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::optional<std::vector<StoredAccount>> Registry::Impl::opened_accounts(const std::string& text) const {
  const std::optional<std::string> sealed = registry::from_hex(text.substr(0, text.find('\n')));
  const std::optional<std::string> opened =
      sealed ? keys.open_sealed(kAccountsContext, *sealed) : std::nullopt;
  if (!opened) return std::nullopt;
  std::vector<StoredAccount> out;
  for (const json& each : json::parse(*opened))
    out.push_back({.account = {.name = each.at("name").get<std::string>(),
                               .role = parse_role(each.at("role").get<std::string>())},
                   .hash = each.at("hash").get<std::string>()});
  return out;
}

const std::vector<StoredAccount>& Registry::Impl::accounts() {
  const std::filesystem::path file = folder / "accounts";
  const std::optional<registry::FileStamp> stamp = registry::stamp_of(file);
  if (stamp == accounts_stamp) return known_accounts;
  std::vector<StoredAccount> next;
  if (stamp) {
    std::optional<std::vector<StoredAccount>> opened =
        opened_accounts(registry::read_private_file(file).value_or(""));
    if (!opened)
      throw RegistryError(
          RegistryFault::kDamaged,
          fmt::format("{} is damaged, or belongs to another key file than {}; put back its copy",
                      file.string(), keys.file().string()));
    next = std::move(*opened);
  }
  known_accounts = std::move(next);
  accounts_stamp = stamp;
  return known_accounts;
}

bool Registry::Impl::accounts_file_is_missing() {
  if (!accounts().empty()) return false;
  const std::optional<registry::AuditHead> head = audit->head();
  return head && head->accounts > 0;
}

bool Registry::Impl::accounts_are_lost() {
  try {
    return accounts_file_is_missing();
  } catch (const RegistryError& error) {
    if (error.fault() != RegistryFault::kDamaged) throw;
    return true;
  }
}

const StoredAccount* Registry::Impl::find_account(const std::string& name) {
  const std::vector<StoredAccount>& all = accounts();
  const auto found = std::find_if(all.begin(), all.end(),
                                  [&](const StoredAccount& each) { return each.account.name == name; });
  return found == all.end() ? nullptr : &*found;
}

void Registry::Impl::write_accounts(std::vector<StoredAccount> next) {
  const std::filesystem::path file = folder / "accounts";
  std::sort(next.begin(), next.end(),
            [](const StoredAccount& a, const StoredAccount& b) { return a.account.name < b.account.name; });
  if (next.empty()) {  // the head first: a head with accounts and no file is a loss
    audit->set_accounts(0);
    registry::erase_private_file(file);
    return;
  }
  json all = json::array();
  for (const StoredAccount& each : next)
    all.push_back({{"name", each.account.name}, {"role", role_name(each.account.role)}, {"hash", each.hash}});
  registry::replace_private_file(
      file, fmt::format("{}\n", registry::to_hex(keys.seal(kAccountsContext, all.dump()))), true);
  audit->set_accounts(next.size());
}

std::string Registry::Impl::failure_bucket(const std::string& name) const {
  return is_account_name(name) ? keys.keyed_hash(fmt::format("sign-in|{}", name)) : "?";
}

Actor Registry::Impl::check_password(const std::string& name, const std::string& password,
                                     const std::string& action) {
  const std::string bucket = failure_bucket(name);
  std::string hash;
  std::optional<Account> account;
  {
    const Operation operation(*this);
    if (accounts().empty())
      throw RegistryError(RegistryFault::kSignIn,
                          "this registry has no accounts; there is nothing to sign in to");
    registry::SignInFailures before = db->failures(bucket);
    if (before.last > utc()) {  // the clock was set back: the delay begins now
      before.last = utc();
      db->put_failures(bucket, before);
    }
    const double left = before.last + delay_after(before.count) - utc();
    if (left > 0.0)
      throw RegistryError(RegistryFault::kDelayed,
                          fmt::format("too many wrong passwords; try again in {:.0f} s", std::ceil(left)));
    // The failure is counted before the password is checked, so that attempts at the same time count, too.
    db->put_failures(bucket, {.count = before.count + 1, .last = utc()});
    if (const StoredAccount* found = find_account(name)) {
      hash = found->hash;
      account = found->account;
    } else {
      if (decoy_hash.empty())
        decoy_hash = registry::password_hash("decoy of no account", settings.password_cost);
      hash = decoy_hash;
    }
  }
  const bool matches = password.size() <= kLongestPassword && registry::password_matches(password, hash) &&
                       account.has_value();
  const Operation operation(*this);
  if (!matches) {
    audit->append(utc(), account ? account->name : "?", fmt::format("{}_failed", action), "");
    throw RegistryError(RegistryFault::kSignIn, "the account or its password is wrong");
  }
  const StoredAccount* current = find_account(name);
  if (current == nullptr || current->hash != hash)
    throw RegistryError(RegistryFault::kSignIn, "the account or its password was changed; sign in again");
  db->clear_failures(bucket);
  audit->append(utc(), name, action, "");
  return {.account = name, .role = current->account.role};
}

bool Registry::has_accounts() {
  const Impl::Operation operation(*impl_);
  return !impl_->accounts().empty() || impl_->accounts_file_is_missing();
}

bool Registry::accounts_lost() {
  const Impl::Operation operation(*impl_);
  return impl_->accounts_are_lost();
}

std::vector<Account> Registry::accounts(const Actor& actor) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kAdministration);
  std::vector<Account> out;
  for (const StoredAccount& each : impl_->accounts()) out.push_back(each.account);
  return out;
}

void Registry::add_account(const Actor& actor, const Account& account, const std::string& password) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kAdministration);
  check_account_name(account.name);
  check_new_password(password);
  std::vector<StoredAccount> next = impl_->accounts();
  if (impl_->find_account(account.name) != nullptr)
    throw RegistryError(RegistryFault::kConflict, fmt::format("the account {} exists already", account.name));
  if (next.empty() && account.role != Role::kAdministrator)
    throw RegistryError(RegistryFault::kConflict,
                        "the first account must be an administrator: from then on, only accounts may enter");
  if (next.size() >= kMostAccounts)
    throw std::invalid_argument(fmt::format("at most {} accounts are possible", kMostAccounts));
  impl_->log(actor, "add_account", "", account.name);
  next.push_back(
      {.account = account, .hash = registry::password_hash(password, impl_->settings.password_cost)});
  impl_->write_accounts(std::move(next));
}

void Registry::edit_account(const Actor& actor, const Account& account) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kAdministration);
  std::vector<StoredAccount> next = impl_->accounts();
  const auto found = std::find_if(
      next.begin(), next.end(), [&](const StoredAccount& each) { return each.account.name == account.name; });
  if (found == next.end()) fail_unknown(account.name);
  found->account.role = account.role;
  if (administrators(next) == 0)
    throw RegistryError(RegistryFault::kConflict, "the last administrator stays one; add another one first");
  impl_->log(actor, "edit_account", "", account.name);
  impl_->write_accounts(std::move(next));
}

void Registry::delete_account(const Actor& actor, const std::string& name) {
  const Impl::Operation operation(*impl_);
  impl_->require(actor, Impl::Permission::kAdministration);
  std::vector<StoredAccount> next = impl_->accounts();
  const std::size_t removed =
      std::erase_if(next, [&](const StoredAccount& each) { return each.account.name == name; });
  if (removed == 0) fail_unknown(name);
  if (!next.empty() && administrators(next) == 0)
    throw RegistryError(RegistryFault::kConflict,
                        "the last administrator can be removed only as the last account");
  impl_->log(actor, "delete_account", "", name);
  impl_->write_accounts(std::move(next));
  std::erase_if(impl_->tokens, [&](const auto& each) { return each.second.account == name; });
}

void Registry::set_password(const Actor& actor, const std::string& name, const std::string& password) {
  const Impl::Operation operation(*impl_);
  const StoredAccount* self = impl_->find_account(actor.account);
  if (self == nullptr || actor.account != name) impl_->require(actor, Impl::Permission::kAdministration);
  check_new_password(password);
  std::vector<StoredAccount> next = impl_->accounts();
  const auto found = std::find_if(next.begin(), next.end(),
                                  [&](const StoredAccount& each) { return each.account.name == name; });
  if (found == next.end()) fail_unknown(name);
  impl_->log(actor, "set_password", "", name);
  found->hash = registry::password_hash(password, impl_->settings.password_cost);
  impl_->write_accounts(std::move(next));
  impl_->db->clear_failures(impl_->failure_bucket(name));
  std::erase_if(impl_->tokens, [&](const auto& each) { return each.second.account == name; });
}

Actor Registry::authenticate(const std::string& name, const std::string& password) {
  return impl_->check_password(name, password, "authenticate");
}

std::string Registry::sign_in(const std::string& name, const std::string& password) {
  const Actor actor = impl_->check_password(name, password, "sign_in");
  std::string token = registry::to_hex(registry::random_bytes(32));
  const std::lock_guard guard(impl_->mutex);
  const double now = impl_->steady();
  if (impl_->tokens.size() >= kMostTokens)
    impl_->tokens.erase(
        std::min_element(impl_->tokens.begin(), impl_->tokens.end(),
                         [](const auto& a, const auto& b) { return a.second.last < b.second.last; }));
  impl_->tokens[registry::sha256(token)] = {.account = actor.account, .since = now, .last = now};
  return token;
}

SignedIn Registry::signed_in(const std::string& token, bool touch) {
  const std::lock_guard guard(impl_->mutex);
  const auto found = impl_->tokens.find(registry::sha256(token));
  if (found == impl_->tokens.end()) return {};
  SignInToken& known = found->second;
  const double now = impl_->steady();
  const StoredAccount* account = impl_->find_account(known.account);
  if (account == nullptr || now - known.since >= impl_->settings.longest_sign_in_s) {
    impl_->tokens.erase(found);
    return {};
  }
  SignedIn out{.state = SignInState::kActive,
               .actor = {.account = known.account, .role = account->account.role},
               .idle_left_s = known.last + impl_->settings.idle_lock_s - now};
  if (out.idle_left_s <= 0.0) known.locked = true;
  if (known.locked) {
    out.state = SignInState::kLocked;
    out.idle_left_s = 0.0;
  } else if (touch) {
    known.last = now;
    out.idle_left_s = impl_->settings.idle_lock_s;
  }
  return out;
}

void Registry::unlock(const std::string& token, const std::string& password) {
  const SignedIn state = signed_in(token, false);
  if (state.state == SignInState::kNone)
    throw RegistryError(RegistryFault::kSignIn, "the sign-in has ended; sign in again");
  static_cast<void>(impl_->check_password(state.actor.account, password, "unlock"));
  const std::lock_guard guard(impl_->mutex);
  const auto found = impl_->tokens.find(registry::sha256(token));
  if (found == impl_->tokens.end())
    throw RegistryError(RegistryFault::kSignIn, "the sign-in has ended; sign in again");
  found->second.locked = false;
  found->second.last = impl_->steady();
}

void Registry::lock(const std::string& token) {
  const Impl::Operation operation(*impl_);
  const auto found = impl_->tokens.find(registry::sha256(token));
  if (found == impl_->tokens.end() || found->second.locked) return;
  found->second.locked = true;
  impl_->audit->append(impl_->utc(), found->second.account, "lock", "");
}

void Registry::sign_out(const std::string& token) {
  const Impl::Operation operation(*impl_);
  const auto found = impl_->tokens.find(registry::sha256(token));
  if (found == impl_->tokens.end()) return;
  const std::string account = found->second.account;
  impl_->tokens.erase(found);
  impl_->audit->append(impl_->utc(), account, "sign_out", "");
}

}  // namespace phalanx
