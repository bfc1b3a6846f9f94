// SPDX-License-Identifier: Apache-2.0
// Refusals of the registry, with their kind: a command prints the text, a page answers with
// the kind's status.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace phalanx {

/// Kind of a refusal.
enum class RegistryFault : std::uint8_t {
  kUnknown,   ///< there is no such patient, account or backup                                       HTTP 404
  kConflict,  ///< the code or the account's name is in use, or a backup exists already              HTTP 409
  kSignIn,    ///< accounts exist and no account is given, or the password is wrong                  HTTP 401
  kDelayed,   ///< too many wrong passwords; the text states the seconds to wait                     HTTP 429
  kDenied,    ///< the role of the account does not permit it                                        HTTP 403
  kNewer,     ///< a newer program wrote the database, journal, backup or key file                   HTTP 409
  kNoKey,     ///< the patient's key is not in the key file                                          HTTP 409
  kDamaged,   ///< a file is damaged, or a key file belongs to another passphrase or master key      HTTP 409
  kDisk,      ///< a file cannot be read or written                                                  HTTP 507
  kBusy,      ///< another program holds the registry or its keys; the text names it                 HTTP 503
};

/// Refusal of the registry. what() names place, value and remedy. Numbers and texts that are out of range are
/// std::invalid_argument instead (HTTP 400).
class RegistryError : public std::runtime_error {
 public:
  RegistryError(RegistryFault fault, const std::string& text) : std::runtime_error(text), fault_(fault) {}
  [[nodiscard]] RegistryFault fault() const noexcept { return fault_; }

 private:
  RegistryFault fault_;
};

}  // namespace phalanx
