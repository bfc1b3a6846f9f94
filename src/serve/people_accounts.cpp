// SPDX-License-Identifier: Apache-2.0
#include "serve/people_accounts.h"

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "serve/people_json.h"
#include "serve/people_routes.h"

namespace phalanx::people {
namespace {

constexpr std::string_view kAccounts = "/people/accounts";
constexpr std::string_view kDelete = "/delete";
constexpr std::size_t kLongestAccount = 64;  // name, or word of a role [bytes]

nlohmann::json accounts_json(Registry& registry, const Actor& actor) {
  nlohmann::json all = nlohmann::json::array();
  for (const Account& account : registry.accounts(actor))
    all.push_back({{"name", account.name}, {"role", role_name(account.role)}});
  return {{"accounts", std::move(all)}};
}

void add(Registry& registry, const Actor& actor, const nlohmann::json& fields) {
  const Account account = {.name = text_of(fields, "name", kLongestAccount),
                           .role = parse_role(text_of(fields, "role", kLongestAccount))};
  registry.add_account(actor, account, text_of(fields, "password", kLongestPassword));
}

void edit(Registry& registry, const Actor& actor, const std::string& name, const nlohmann::json& fields) {
  const bool other_role = fields.contains("role");
  const bool other_password = fields.contains("password");
  if (other_role == other_password)
    throw std::invalid_argument("an account is changed by one of the fields 'role' and 'password'");
  if (other_role) {
    registry.edit_account(actor,
                          {.name = name, .role = parse_role(text_of(fields, "role", kLongestAccount))});
  } else {
    registry.set_password(actor, name, text_of(fields, "password", kLongestPassword));
  }
}

}  // namespace

bool is_of_accounts(std::string_view path) noexcept {
  return path == kAccounts || (path.starts_with(kAccounts) && path[kAccounts.size()] == '/');
}

WebResponse accounts_response(Registry& registry, const Actor& actor, const WebRequest& request) {
  const bool changes = request.method == "POST";
  std::string_view name = std::string_view(request.path).substr(kAccounts.size());
  if (name.empty()) {
    if (!changes) return json_response(accounts_json(registry, actor));
    add(registry, actor, read_object(request.body));
    return json_response(nlohmann::json::object());
  }
  name.remove_prefix(1);
  if (!changes) return words_response(405, "this address does not allow this method");
  if (name.ends_with(kDelete)) {
    name.remove_suffix(kDelete.size());
    registry.delete_account(actor, std::string(name));
  } else {
    edit(registry, actor, std::string(name), read_object(request.body));
  }
  return json_response(nlohmann::json::object());
}

}  // namespace phalanx::people
