// SPDX-License-Identifier: Apache-2.0
#include "phalanx/registry/accounts.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <utility>

namespace phalanx {
namespace {

constexpr std::array<std::pair<Role, std::string_view>, 4> kRoles = {
    {{Role::kAdministrator, "administrator"},
     {Role::kTherapist, "therapist"},
     {Role::kLookOn, "look_on"},
     {Role::kPatientScreen, "patient_screen"}}};

}  // namespace

std::string_view role_name(Role role) noexcept {
  for (const auto& [each, name] : kRoles)
    if (each == role) return name;
  return "look_on";
}

Role parse_role(std::string_view name) {
  for (const auto& [role, each] : kRoles)
    if (each == name) return role;
  throw std::invalid_argument(fmt::format(
      "there is no role \"{}\"; the roles are administrator, therapist, look_on, patient_screen", name));
}

}  // namespace phalanx
