// SPDX-License-Identifier: Apache-2.0
// How people reach the cockpit from elsewhere: over SSH, or over the network with TLS and a token.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace phalanx {

/// 128 random bits of the system's in 22 characters of base64url: what nobody guesses.
/// @throws std::runtime_error  the system has none
[[nodiscard]] std::string random_token();

/// What this machine is called, in small letters: its host name, the part before its first dot, and that with
/// ".local".
[[nodiscard]] std::vector<std::string> machine_names();
/// Addresses of the machine's interfaces that are up, without loopback and link-local ones; IPv4 first.
[[nodiscard]] std::vector<std::string> machine_addresses();

/// @returns true if only this machine reaches a server that listens there: "localhost", 127/8 or ::1
[[nodiscard]] bool is_loopback(const std::string& address);

/// Addresses at which a server that listens on `address` answers other machines: of machine_addresses() those
/// of IPv4 for 0.0.0.0, all for ::; else the address itself.
[[nodiscard]] std::vector<std::string> reachable_addresses(const std::string& address);

/// "https://192.0.2.2:8480/?token=...", for each of reachable_addresses(); without the query if the token is
/// empty.
[[nodiscard]] std::vector<std::string> lan_urls(const std::string& address, std::uint16_t port,
                                                const std::string& token);

/// What to type at the other end to reach a port of this machine's loopback: "ssh -L 8480:127.0.0.1:8480
/// user@host", host being the address that the SSH session of the environment (SSH_CONNECTION) came in by.
/// Empty if there is none. Set-up code: reads the environment.
[[nodiscard]] std::string ssh_line(std::uint16_t port);

/// The text as a QR code (error correction M), in Unicode half blocks with the quiet zone of 4 modules;
/// colours of its own, dark on light whatever the terminal's are. Lines end with '\n'.
/// @throws std::runtime_error  too long for a QR code, or empty
[[nodiscard]] std::string qr_text(const std::string& text);

struct CertificateFiles {
  std::filesystem::path certificate;  ///< PEM
  std::filesystem::path key;          ///< PEM, readable by its owner only
};

/// A certificate that this machine signed itself (EC P-256, 397 days, for servers), for these names and
/// addresses and localhost. What is in the folder is used again if it is still good for a week and for all
/// the names; else made anew. Browsers warn of it once; its fingerprint says that it is this one.
/// @param names  host names and IP addresses; what is neither is left out
/// @throws std::runtime_error  the folder cannot be written
[[nodiscard]] CertificateFiles make_self_signed_certificate(const std::filesystem::path& folder,
                                                            const std::vector<std::string>& names);

/// SHA-256 of a certificate as browsers show it: "AB:CD:...". @throws std::runtime_error  no certificate
/// there
[[nodiscard]] std::string certificate_fingerprint(const std::filesystem::path& certificate);

}  // namespace phalanx
