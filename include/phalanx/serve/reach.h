// SPDX-License-Identifier: Apache-2.0
// How people reach the cockpit from other computers: over SSH, or over the network with TLS and a token.
// Set-up code: allocates and reads the system's state.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace phalanx {

/// @returns 128 random bits of the system in 22 characters of base64url, which cannot be guessed
/// @throws std::runtime_error if the system has no random numbers
[[nodiscard]] std::string random_token();

/// @returns the names of this machine in lower case: its host name, the part before its first dot, and that
/// part with ".local"
[[nodiscard]] std::vector<std::string> machine_names();
/// @returns the addresses of the machine's interfaces that are up, without loopback and link-local
/// ones; IPv4 first
[[nodiscard]] std::vector<std::string> machine_addresses();

/// @returns true if only this machine can reach a server that listens there: "localhost", 127/8 or ::1
[[nodiscard]] bool is_loopback(const std::string& address);

/// @returns the addresses at which other machines reach a server that listens on `address`: those of
/// machine_addresses() for "::", the IPv4 ones among them for "0.0.0.0", else the address itself
[[nodiscard]] std::vector<std::string> reachable_addresses(const std::string& address);

/// @returns "https://192.0.2.2:8480/?token=..." for each of reachable_addresses(); without the query if the
/// token is empty
[[nodiscard]] std::vector<std::string> lan_urls(const std::string& address, std::uint16_t port,
                                                const std::string& token);

/// @returns the command with which another computer reaches a port of this machine's loopback interface:
/// "ssh -L 8480:127.0.0.1:8480 user@host". Its host is the address that the SSH session of this process came
/// in by (SSH_CONNECTION). Empty without such a session.
[[nodiscard]] std::string ssh_line(std::uint16_t port);

/// @returns the text as a QR code (error correction M) in Unicode half blocks, with the quiet zone of 4
/// modules. It sets its own colours, dark on light. Lines end with '\n'.
/// @throws std::runtime_error if the text is empty or too long for a QR code
[[nodiscard]] std::string qr_text(const std::string& text);

struct CertificateFiles {
  std::filesystem::path certificate;  ///< PEM
  std::filesystem::path key;          ///< PEM, readable by its owner only
};

/// Makes a self-signed server certificate (EC P-256, 397 days) for these names and for localhost. Uses the
/// one in the folder again if it is valid for another week and for all the names. Browsers warn of it once;
/// people compare its fingerprint then.
/// @param names  host names and IP addresses; other texts are left out
/// @throws std::runtime_error if the folder cannot be written
[[nodiscard]] CertificateFiles make_self_signed_certificate(const std::filesystem::path& folder,
                                                            const std::vector<std::string>& names);

/// @returns the SHA-256 fingerprint of a certificate as browsers show it: "AB:CD:..."
/// @throws std::runtime_error if the file has no certificate
[[nodiscard]] std::string certificate_fingerprint(const std::filesystem::path& certificate);

}  // namespace phalanx
