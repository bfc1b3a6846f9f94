// SPDX-License-Identifier: Apache-2.0
#include "record/mcap/encrypted_format.h"

#include <fmt/format.h>
#include <openssl/core_names.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <openssl/kdf.h>
#include <openssl/params.h>
#include <openssl/rand.h>

#include <algorithm>
#include <new>

namespace phalanx::mcap {
namespace {

constexpr std::size_t kNonceBytes = 12;
constexpr std::size_t kAuthenticated = 4 + 4 + 8 + 8;  ///< bytes of a frame's head that the tag covers

const unsigned char* bytes_of(std::string_view text) noexcept {
  return reinterpret_cast<const unsigned char*>(text.data());
}

[[noreturn]] void openssl_refuses(const char* what) {
  throw std::runtime_error(fmt::format("encryption: OpenSSL refuses {}", what));
}

std::array<unsigned char, kNonceBytes> nonce_of(std::uint64_t counter) noexcept {
  std::array<unsigned char, kNonceBytes> nonce{};
  for (std::size_t i = 0; i < 8; ++i) nonce[4 + i] = static_cast<unsigned char>(counter >> (8U * i) & 0xffU);
  return nonce;
}

void put_head(Bytes& out, const EncryptedHead& head) {
  const std::size_t begin = out.size();
  put_raw(out, kEncryptedMagic);
  put(out, kEncryptedVersion);
  put_raw(out, head.id);
  out.insert(out.end(), head.salt.begin(), head.salt.end());
  out.insert(out.end(), head.check.begin(), head.check.end());
  put(out, crc32_of(view_of(out).substr(begin)));
}

/// HKDF-SHA256 of the key and the file's salt. @param out  gets the file's key and the check
void derive(const EncryptedHead& head, const RecordingKey& key, std::array<unsigned char, 48>& out) {
  EVP_KDF* const kdf = ::EVP_KDF_fetch(nullptr, "HKDF", nullptr);
  EVP_KDF_CTX* const context = kdf == nullptr ? nullptr : ::EVP_KDF_CTX_new(kdf);
  ::EVP_KDF_free(kdf);
  if (context == nullptr) openssl_refuses("HKDF");
  std::string digest = "SHA256";
  std::string info = fmt::format("phalanx recording {} {}", kEncryptedVersion, head.id);
  RecordingKey secret = key;
  auto salt = head.salt;
  const std::array<OSSL_PARAM, 5> parameters = {
      ::OSSL_PARAM_construct_utf8_string(OSSL_KDF_PARAM_DIGEST, digest.data(), 0),
      ::OSSL_PARAM_construct_octet_string(OSSL_KDF_PARAM_KEY, secret.data(), secret.size()),
      ::OSSL_PARAM_construct_octet_string(OSSL_KDF_PARAM_SALT, salt.data(), salt.size()),
      ::OSSL_PARAM_construct_octet_string(OSSL_KDF_PARAM_INFO, info.data(), info.size()),
      ::OSSL_PARAM_construct_end()};
  const int done = ::EVP_KDF_derive(context, out.data(), out.size(), parameters.data());
  ::EVP_KDF_CTX_free(context);
  ::OPENSSL_cleanse(secret.data(), secret.size());
  if (done != 1) openssl_refuses("HKDF");
}

}  // namespace

Bytes begin_of_encrypted(const EncryptedHead& head) {
  Bytes out;
  put_head(out, head);
  put_head(out, head);
  return out;
}

bool begins_as_encrypted(std::string_view bytes) noexcept {
  // One of the two is enough: a damaged byte of the magic does not make the file a strange one.
  return bytes.starts_with(kEncryptedMagic) || (bytes.size() >= kEncryptedHead + kEncryptedMagic.size() &&
                                                bytes.substr(kEncryptedHead).starts_with(kEncryptedMagic));
}

EncryptedHead parse_encrypted_head(std::string_view bytes) {
  for (std::size_t begin = 0; begin <= kEncryptedHead && begin + kEncryptedHead <= bytes.size();
       begin += kEncryptedHead) {
    const std::string_view block = bytes.substr(begin, kEncryptedHead);
    Cursor fields(block);
    if (fields.raw(kEncryptedMagic.size()) != kEncryptedMagic) continue;
    const std::uint32_t version = fields.u32();
    EncryptedHead head;
    head.id = fields.raw(RecordingEncryption::kIdLength);
    const std::string_view salt = fields.raw(kSaltBytes);
    std::copy(salt.begin(), salt.end(), head.salt.begin());
    const std::string_view check = fields.raw(kCheckBytes);
    std::copy(check.begin(), check.end(), head.check.begin());
    if (fields.u32() != crc32_of(block.substr(0, kEncryptedHead - 4))) continue;
    if (version != kEncryptedVersion)
      throw McapError(
          fmt::format("it is encrypted in the format {}, and this version knows {}; use a newer one", version,
                      kEncryptedVersion));
    if (is_key_id(head.id)) return head;
  }
  throw McapError("it is encrypted, and its head is damaged in both places: it cannot be decrypted");
}

bool parse_frame_head(std::string_view bytes, FrameHead& head) noexcept {
  if (bytes.size() < kFrameHead) return false;
  head.last = bytes.starts_with(kLastFrameMark);
  if (!head.last && !bytes.starts_with(kFrameMark)) return false;
  Cursor fields(bytes.substr(4, kFrameHead - 4));
  head.length = fields.u32();
  head.place = fields.u64();
  head.counter = fields.u64();
  head.body_crc = fields.u32();
  return fields.u32() == crc32_of(bytes.substr(0, kFrameHead - 4)) && head.length > 0 &&
         head.length <= kMostFrame && head.counter > 0;
}

FrameCipher::FrameCipher(const EncryptedHead& head, const RecordingKey& key)
    : context_(::EVP_CIPHER_CTX_new()) {
  if (context_ == nullptr) throw std::bad_alloc();
  try {
    std::array<unsigned char, 48> derived{};
    derive(head, key, derived);
    std::copy_n(derived.begin(), key_.size(), key_.begin());
    std::copy_n(derived.begin() + static_cast<std::ptrdiff_t>(key_.size()), kCheckBytes, check_.begin());
    ::OPENSSL_cleanse(derived.data(), derived.size());
  } catch (...) {
    ::EVP_CIPHER_CTX_free(context_);
    throw;
  }
}

FrameCipher::~FrameCipher() {
  ::OPENSSL_cleanse(key_.data(), key_.size());
  ::EVP_CIPHER_CTX_free(context_);  // wipes its copy
}

void FrameCipher::encrypt(const FrameHead& head, std::string_view content, Bytes& out) {
  out.clear();
  out.reserve(kFrameExtra + content.size());
  put_raw(out, head.last ? kLastFrameMark : kFrameMark);
  put(out, static_cast<std::uint32_t>(content.size()));
  put(out, head.place);
  put(out, head.counter);
  out.resize(kFrameHead + content.size() + kTagBytes);
  auto* const bytes = reinterpret_cast<unsigned char*>(out.data());
  const auto nonce = nonce_of(head.counter);
  int length = 0;
  const bool done =
      ::EVP_EncryptInit_ex(context_, ::EVP_aes_256_gcm(), nullptr, key_.data(), nonce.data()) == 1 &&
      ::EVP_EncryptUpdate(context_, nullptr, &length, bytes, kAuthenticated) == 1 &&
      ::EVP_EncryptUpdate(context_, bytes + kFrameHead, &length, bytes_of(content),
                          static_cast<int>(content.size())) == 1 &&
      ::EVP_EncryptFinal_ex(context_, bytes + kFrameHead + content.size(), &length) == 1 &&
      ::EVP_CIPHER_CTX_ctrl(context_, EVP_CTRL_GCM_GET_TAG, static_cast<int>(kTagBytes),
                            bytes + kFrameHead + content.size()) == 1;
  if (!done) openssl_refuses("AES-256-GCM");
  Bytes checksums;
  put(checksums, crc32_of(view_of(out).substr(kFrameHead)));
  std::copy(checksums.begin(), checksums.end(), out.begin() + kAuthenticated);
  checksums.clear();
  put(checksums, crc32_of(view_of(out).substr(0, kFrameHead - 4)));
  std::copy(checksums.begin(), checksums.end(), out.begin() + kFrameHead - 4);
  put(out, static_cast<std::uint32_t>(content.size()));
}

bool FrameCipher::decrypt(std::string_view frame, std::string& content) {
  content.clear();
  FrameHead head;
  if (!parse_frame_head(frame, head) || frame.size() < head.stored()) return false;
  content.resize(head.length);
  const auto nonce = nonce_of(head.counter);
  std::array<unsigned char, kTagBytes> tag{};
  const std::string_view stored_tag = frame.substr(kFrameHead + head.length, kTagBytes);
  std::copy(stored_tag.begin(), stored_tag.end(), tag.begin());
  auto* const into = reinterpret_cast<unsigned char*>(content.data());
  int length = 0;
  const bool done =
      ::EVP_DecryptInit_ex(context_, ::EVP_aes_256_gcm(), nullptr, key_.data(), nonce.data()) == 1 &&
      ::EVP_DecryptUpdate(context_, nullptr, &length, bytes_of(frame), kAuthenticated) == 1 &&
      ::EVP_DecryptUpdate(context_, into, &length, bytes_of(frame.substr(kFrameHead)),
                          static_cast<int>(head.length)) == 1 &&
      ::EVP_CIPHER_CTX_ctrl(context_, EVP_CTRL_GCM_SET_TAG, static_cast<int>(kTagBytes), tag.data()) == 1 &&
      ::EVP_DecryptFinal_ex(context_, into + length, &length) == 1;
  if (!done) content.clear();
  return done;
}

void fill_randomly(unsigned char* bytes, std::size_t count) {
  if (::RAND_bytes(bytes, static_cast<int>(count)) != 1) openssl_refuses("random bytes");
}

bool is_key_id(std::string_view id) noexcept {
  return id.size() == RecordingEncryption::kIdLength &&
         id.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace phalanx::mcap
