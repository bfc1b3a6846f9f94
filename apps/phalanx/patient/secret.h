// SPDX-License-Identifier: Apache-2.0
// Passwords and passphrases: from the terminal without echo, or from the environment for scripts. They are
// neither printed nor written to a file.
#pragma once

#include <string>

namespace phalanx {

/// Places that a secret may come from.
struct SecretSource {
  std::string what;         ///< for the question and messages: "password of anna"
  std::string environment;  ///< name of a variable; if it is set, nothing is asked
};

/// Reads a secret: the value of the variable of the environment, else a line of the terminal, which does
/// not show it.
/// @throws std::invalid_argument naming the variable if it is not set and standard input is no terminal; if
/// the line ends early, or is longer than 1,000 bytes
[[nodiscard]] std::string read_secret(const SecretSource& source);

/// Reads a secret that is new, such as that of another account: at the terminal it is asked for twice.
/// @throws std::invalid_argument as read_secret(), and if the two differ
[[nodiscard]] std::string read_new_secret(const SecretSource& source);

}  // namespace phalanx
