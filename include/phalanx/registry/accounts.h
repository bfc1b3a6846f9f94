// SPDX-License-Identifier: Apache-2.0
// People who sign in, their roles, and who is signed in.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace phalanx {

/// Role of an account.
enum class Role : std::uint8_t {
  kAdministrator,  ///< everything
  kTherapist,      ///< patients, results, export, deletion, backup; not accounts, restore, audit log
  kLookOn,         ///< the cockpit without patients
  kPatientScreen,  ///< the screen of a patient, likewise without patients
};
/// @returns "administrator", "therapist", "look_on" or "patient_screen"
[[nodiscard]] std::string_view role_name(Role role) noexcept;
/// @throws std::invalid_argument naming the known roles
[[nodiscard]] Role parse_role(std::string_view name);

/// An account without its password.
struct Account {
  std::string name;  ///< 1 .. 32 of a-z, 0-9, '.', '_', '-'; begins with a letter; "owner" is reserved
  Role role = Role::kTherapist;
};

/// Who acts. Each function of Registry takes one, checks its role, and writes its name to the audit log.
struct Actor {
  std::string account;
  Role role = Role::kLookOn;

  /// Returns the user of a registry without accounts. Registry refuses it (kSignIn) as soon
  /// as accounts exist.
  [[nodiscard]] static Actor owner() { return {.account = "owner", .role = Role::kAdministrator}; }
  [[nodiscard]] bool may_see_patients() const noexcept {
    return role == Role::kAdministrator || role == Role::kTherapist;
  }
};

/// Length of a password [bytes].
inline constexpr std::size_t kShortestPassword = 10;
inline constexpr std::size_t kLongestPassword = 256;

/// State of a signed-in account.
enum class SignInState : std::uint8_t {
  kNone,  ///< unknown, signed out, or too old
  kActive,
  kLocked,  ///< idle for too long, or locked by hand: unlock() with the password. Stopping the device needs no sign-in.
};

/// Answer about a token.
struct SignedIn {
  SignInState state = SignInState::kNone;
  Actor actor;               ///< of kActive and kLocked
  double idle_left_s = 0.0;  ///< until it locks by itself [s]
};

}  // namespace phalanx
