// SPDX-License-Identifier: Apache-2.0
// Cryptography of the registry, by OpenSSL and libargon2: AES-256-GCM, HKDF-SHA256,
// HMAC-SHA256, SHA-256, Argon2id.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "phalanx/registry/key_store.h"

namespace phalanx::registry {

using Key = RecordingKey;

/// @returns random bytes of the operating system. @throws std::runtime_error if it has none
[[nodiscard]] std::string random_bytes(std::size_t count);
[[nodiscard]] Key random_key();
/// @returns 32 random hexadecimal digits
[[nodiscard]] std::string random_record_id();

[[nodiscard]] std::string to_hex(std::string_view bytes);
/// @returns none for an odd number of digits, or another character
[[nodiscard]] std::optional<std::string> from_hex(std::string_view text);

/// Seals a text: 12 random bytes (nonce), ciphertext, 16 bytes (tag). `context` is authenticated, too: a
/// sealed text cannot move to another place.
[[nodiscard]] std::string seal(const Key& key, std::string_view context, std::string_view text);
/// @returns none if key, context or a byte differ
[[nodiscard]] std::optional<std::string> open_sealed(const Key& key, std::string_view context,
                                                     std::string_view sealed);

/// @returns HKDF-SHA256 of a key, without salt
[[nodiscard]] Key derived_key(const Key& key, std::string_view purpose);
/// @returns HMAC-SHA256 as 64 hexadecimal digits
[[nodiscard]] std::string keyed_hash(const Key& key, std::string_view text);
/// @returns SHA-256 as 64 hexadecimal digits
[[nodiscard]] std::string sha256(std::string_view bytes);

/// @returns Argon2id of a passphrase
[[nodiscard]] Key passphrase_key(std::string_view passphrase, std::string_view salt, const Argon2Cost& cost);
/// @returns Argon2id of a password with a random salt, in the PHC string format
[[nodiscard]] std::string password_hash(std::string_view password, const Argon2Cost& cost);
[[nodiscard]] bool password_matches(std::string_view password, const std::string& hash);

/// Overwrites a secret in memory.
void wipe(Key& key) noexcept;
void wipe(std::string& text) noexcept;

}  // namespace phalanx::registry
