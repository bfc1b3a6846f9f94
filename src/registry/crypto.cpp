// SPDX-License-Identifier: Apache-2.0
#include "registry/crypto.h"

#include <argon2.h>
#include <fmt/format.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/hmac.h>
#include <openssl/kdf.h>
#include <openssl/rand.h>
#include <openssl/sha.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "phalanx/core/index.h"

namespace phalanx::registry {
namespace {

constexpr std::size_t kNonce = 12;
constexpr std::size_t kTag = 16;

const unsigned char* bytes_of(std::string_view text) noexcept {
  return reinterpret_cast<const unsigned char*>(text.data());
}
unsigned char* bytes_of(std::string& text) noexcept { return reinterpret_cast<unsigned char*>(text.data()); }

void require(bool ok, const char* what) {
  if (!ok) throw std::runtime_error(fmt::format("OpenSSL cannot {}; check its installation", what));
}

using Cipher = std::unique_ptr<EVP_CIPHER_CTX, decltype(&EVP_CIPHER_CTX_free)>;

Cipher make_cipher() {
  Cipher cipher(EVP_CIPHER_CTX_new(), &EVP_CIPHER_CTX_free);
  require(cipher != nullptr, "make a cipher");
  return cipher;
}

int length_of(std::string_view text) {
  if (text.size() > 1U << 30U) throw std::invalid_argument("a text of more than 1 GiB cannot be sealed");
  return static_cast<int>(text.size());
}

}  // namespace

std::string random_bytes(std::size_t count) {
  std::string out(count, '\0');
  require(RAND_bytes(bytes_of(out), length_of(out)) == 1, "make random numbers");
  return out;
}

Key random_key() {
  Key key{};
  require(RAND_priv_bytes(key.data(), static_cast<int>(key.size())) == 1, "make random numbers");
  return key;
}

std::string random_record_id() { return to_hex(random_bytes(16)); }

std::string to_hex(std::string_view bytes) {
  constexpr std::string_view kDigitsOfHex = "0123456789abcdef";
  std::string out;
  out.reserve(2 * bytes.size());
  for (const char each : bytes) {
    const auto value = static_cast<unsigned char>(each);
    out.push_back(kDigitsOfHex[value >> 4U]);
    out.push_back(kDigitsOfHex[value & 15U]);
  }
  return out;
}

std::optional<std::string> from_hex(std::string_view text) {
  if (text.size() % 2 != 0) return std::nullopt;
  const auto value = [](char digit) -> int {
    if (digit >= '0' && digit <= '9') return digit - '0';
    if (digit >= 'a' && digit <= 'f') return digit - 'a' + 10;
    return -1;
  };
  std::string out;
  out.reserve(text.size() / 2);
  for (std::size_t i = 0; i < text.size(); i += 2) {
    const int high = value(text[i]);
    const int low = value(text[i + 1]);
    if (high < 0 || low < 0) return std::nullopt;
    out.push_back(static_cast<char>(16 * high + low));
  }
  return out;
}

std::string seal(const Key& key, std::string_view context, std::string_view text) {
  const std::string nonce = random_bytes(kNonce);
  std::string out(kNonce + text.size() + kTag, '\0');
  std::copy(nonce.begin(), nonce.end(), out.begin());
  const Cipher cipher = make_cipher();
  int length = 0;
  unsigned char* body = bytes_of(out) + kNonce;
  bool ok = EVP_EncryptInit_ex(cipher.get(), EVP_aes_256_gcm(), nullptr, key.data(), bytes_of(nonce)) == 1 &&
            EVP_EncryptUpdate(cipher.get(), nullptr, &length, bytes_of(context), length_of(context)) == 1 &&
            EVP_EncryptUpdate(cipher.get(), body, &length, bytes_of(text), length_of(text)) == 1;
  ok = ok && EVP_EncryptFinal_ex(cipher.get(), body + text.size(), &length) == 1;
  ok = ok && EVP_CIPHER_CTX_ctrl(cipher.get(), EVP_CTRL_GCM_GET_TAG, static_cast<int>(kTag),
                                 body + text.size()) == 1;
  require(ok, "encrypt");
  return out;
}

std::optional<std::string> open_sealed(const Key& key, std::string_view context, std::string_view sealed) {
  if (sealed.size() < kNonce + kTag) return std::nullopt;
  std::string out(sealed.size() - kNonce - kTag, '\0');
  std::string tag(sealed.substr(sealed.size() - kTag));
  const std::string_view body = sealed.substr(kNonce, out.size());
  const Cipher cipher = make_cipher();
  int length = 0;
  const bool ready =
      EVP_DecryptInit_ex(cipher.get(), EVP_aes_256_gcm(), nullptr, key.data(), bytes_of(sealed)) == 1 &&
      EVP_DecryptUpdate(cipher.get(), nullptr, &length, bytes_of(context), length_of(context)) == 1 &&
      EVP_DecryptUpdate(cipher.get(), bytes_of(out), &length, bytes_of(body), length_of(body)) == 1 &&
      EVP_CIPHER_CTX_ctrl(cipher.get(), EVP_CTRL_GCM_SET_TAG, static_cast<int>(kTag), bytes_of(tag)) == 1;
  require(ready, "decrypt");
  if (EVP_DecryptFinal_ex(cipher.get(), bytes_of(tag), &length) != 1) return std::nullopt;
  return out;
}

Key derived_key(const Key& key, std::string_view purpose) {
  const std::unique_ptr<EVP_PKEY_CTX, decltype(&EVP_PKEY_CTX_free)> context(
      EVP_PKEY_CTX_new_id(EVP_PKEY_HKDF, nullptr), &EVP_PKEY_CTX_free);
  Key out{};
  std::size_t length = out.size();
  require(context && EVP_PKEY_derive_init(context.get()) == 1 &&
              EVP_PKEY_CTX_set_hkdf_md(context.get(), EVP_sha256()) == 1 &&
              EVP_PKEY_CTX_set1_hkdf_key(context.get(), key.data(), static_cast<int>(key.size())) == 1 &&
              EVP_PKEY_CTX_add1_hkdf_info(context.get(), bytes_of(purpose), length_of(purpose)) == 1 &&
              EVP_PKEY_derive(context.get(), out.data(), &length) == 1,
          "derive a key");
  return out;
}

std::string keyed_hash(const Key& key, std::string_view text) {
  std::string out(SHA256_DIGEST_LENGTH, '\0');
  unsigned int length = 0;
  require(HMAC(EVP_sha256(), key.data(), static_cast<int>(key.size()), bytes_of(text), text.size(),
               bytes_of(out), &length) != nullptr,
          "make a keyed hash");
  return to_hex(out);
}

std::string sha256(std::string_view bytes) {
  std::string out(SHA256_DIGEST_LENGTH, '\0');
  SHA256(bytes_of(bytes), bytes.size(), bytes_of(out));
  return to_hex(out);
}

Key passphrase_key(std::string_view passphrase, std::string_view salt, const Argon2Cost& cost) {
  Key out{};
  const int failed = argon2id_hash_raw(cost.passes, cost.memory_kib, cost.lanes, passphrase.data(),
                                       passphrase.size(), salt.data(), salt.size(), out.data(), out.size());
  if (failed != ARGON2_OK)
    throw std::runtime_error(fmt::format("Argon2id failed: {}; it needs {} KiB of memory",
                                         argon2_error_message(failed), cost.memory_kib));
  return out;
}

std::string password_hash(std::string_view password, const Argon2Cost& cost) {
  constexpr std::uint32_t kSalt = 16;
  constexpr std::uint32_t kHash = 32;
  const std::string salt = random_bytes(kSalt);
  std::string out(argon2_encodedlen(cost.passes, cost.memory_kib, cost.lanes, kSalt, kHash, Argon2_id), '\0');
  const int failed =
      argon2id_hash_encoded(cost.passes, cost.memory_kib, cost.lanes, password.data(), password.size(),
                            salt.data(), kSalt, kHash, out.data(), out.size());
  if (failed != ARGON2_OK)
    throw std::runtime_error(fmt::format("Argon2id failed: {}; it needs {} KiB of memory",
                                         argon2_error_message(failed), cost.memory_kib));
  out.resize(out.find('\0'));
  return out;
}

bool password_matches(std::string_view password, const std::string& hash) {
  return argon2id_verify(hash.c_str(), password.data(), password.size()) == ARGON2_OK;
}

void wipe(Key& key) noexcept { OPENSSL_cleanse(key.data(), key.size()); }
void wipe(std::string& text) noexcept {
  OPENSSL_cleanse(text.data(), text.size());
  text.clear();
}

}  // namespace phalanx::registry
