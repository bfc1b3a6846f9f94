// SPDX-License-Identifier: Apache-2.0
// The addresses below /people/accounts: the people who sign in. The registry checks roles, as for `phalanx account`.
#pragma once

#include <string_view>

#include "phalanx/registry/registry.h"
#include "phalanx/serve/web_server.h"

namespace phalanx::people {

/// @returns true if the path is that of accounts
[[nodiscard]] bool is_of_accounts(std::string_view path) noexcept;

/// Lists accounts, adds one, changes a role or a password, or deletes one. No answer has a password.
/// @throws RegistryError or std::invalid_argument with a refusal in words
[[nodiscard]] WebResponse accounts_response(Registry& registry, const Actor& actor,
                                            const WebRequest& request);

}  // namespace phalanx::people
