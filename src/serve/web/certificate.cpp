// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <fmt/format.h>
#include <openssl/bio.h>
#include <openssl/bn.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <memory>
#include <stdexcept>

#include "phalanx/serve/reach.h"
#include "serve/web/secret_file.h"

namespace phalanx {
namespace {

using namespace web;  // NOLINT(google-build-using-namespace)

constexpr long kDay = 24L * 60 * 60;     // [s]
constexpr long kLifetime = 397 * kDay;   // browsers reject longer lifetimes
constexpr long kMinimumLeft = 7 * kDay;  // of the lifetime, for a certificate to be used again
constexpr long kClockSkew = kDay;        // by which a browser's clock may be behind

/// Deleter for objects of OpenSSL.
template <auto kFree>
struct OpenSslDeleter {
  template <class T>
  void operator()(T* object) const noexcept {
    kFree(object);
  }
};
using CertificateOwner = std::unique_ptr<X509, OpenSslDeleter<&X509_free>>;
using KeyOwner = std::unique_ptr<EVP_PKEY, OpenSslDeleter<&EVP_PKEY_free>>;
using BioOwner = std::unique_ptr<BIO, OpenSslDeleter<&BIO_free_all>>;
using ExtensionOwner = std::unique_ptr<X509_EXTENSION, OpenSslDeleter<&X509_EXTENSION_free>>;

[[noreturn]] void fail(const std::string& what) { throw std::runtime_error("the certificate: " + what); }

void require(bool good, const char* what) {
  if (!good) fail(what);
}

bool is_address(const std::string& name) {
  std::array<unsigned char, sizeof(in6_addr)> bytes{};
  return ::inet_pton(AF_INET, name.c_str(), bytes.data()) == 1 ||
         ::inet_pton(AF_INET6, name.c_str(), bytes.data()) == 1;
}

bool is_host_name(const std::string& name) {
  constexpr std::string_view kAllowed = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.";
  return !name.empty() && name.find_first_not_of(kAllowed) == std::string::npos;
}

/// @returns the names as OpenSSL reads them: "DNS:localhost,IP:127.0.0.1"
std::string alternative_names(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) {
    list += fmt::format("{}{}:{}", list.empty() ? "" : ",", is_address(name) ? "IP" : "DNS", name);
  }
  return list;
}

void add_extension(X509* certificate, int kind, const std::string& value) {
  X509V3_CTX context;
  X509V3_set_ctx_nodb(&context);
  X509V3_set_ctx(&context, certificate, certificate, nullptr, nullptr, 0);
  const ExtensionOwner extension(X509V3_EXT_conf_nid(nullptr, &context, kind, value.c_str()));
  require(extension && X509_add_ext(certificate, extension.get(), -1) == 1,
          "one of its fields cannot be made");
}

void set_random_serial(X509* certificate) {
  std::array<unsigned char, 16> random{};
  require(RAND_bytes(random.data(), static_cast<int>(random.size())) == 1,
          "the system has no random numbers");
  random.front() &= 0x7FU;  // positive
  BIGNUM* number = BN_bin2bn(random.data(), static_cast<int>(random.size()), nullptr);
  const bool set =
      number != nullptr && BN_to_ASN1_INTEGER(number, X509_get_serialNumber(certificate)) != nullptr;
  BN_free(number);
  require(set, "its serial number cannot be made");
}

CertificateOwner sign(EVP_PKEY* key, const std::vector<std::string>& names) {
  CertificateOwner made(X509_new());
  X509* certificate = made.get();
  require(certificate != nullptr && X509_set_version(certificate, X509_VERSION_3) == 1, "out of memory");
  set_random_serial(certificate);
  X509_gmtime_adj(X509_getm_notBefore(certificate), -kClockSkew);
  X509_gmtime_adj(X509_getm_notAfter(certificate), kLifetime - kClockSkew);
  X509_NAME* subject = X509_get_subject_name(certificate);
  const auto* common = reinterpret_cast<const unsigned char*>("Phalanx station");
  X509_NAME_add_entry_by_txt(subject, "CN", MBSTRING_ASC, common, -1, -1, 0);
  require(X509_set_issuer_name(certificate, subject) == 1 && X509_set_pubkey(certificate, key) == 1,
          "out of memory");
  add_extension(certificate, NID_basic_constraints, "critical,CA:FALSE");
  add_extension(certificate, NID_key_usage, "critical,digitalSignature");
  add_extension(certificate, NID_ext_key_usage, "serverAuth");
  add_extension(certificate, NID_subject_alt_name, alternative_names(names));
  require(X509_sign(certificate, key, EVP_sha256()) > 0, "it cannot be signed");
  return made;
}

std::string text_of(BIO* bio) {
  char* data = nullptr;
  const long size = BIO_get_mem_data(bio, &data);
  return std::string(data, static_cast<std::size_t>(size));
}

std::string pem_of(X509* certificate) {
  const BioOwner bio(BIO_new(BIO_s_mem()));
  require(bio && PEM_write_bio_X509(bio.get(), certificate) == 1, "it cannot be written");
  return text_of(bio.get());
}

std::string pem_of(EVP_PKEY* key) {
  const BioOwner bio(BIO_new(BIO_s_mem()));
  require(bio && PEM_write_bio_PrivateKey(bio.get(), key, nullptr, nullptr, 0, nullptr, nullptr) == 1,
          "its key cannot be written");
  return text_of(bio.get());
}

CertificateOwner read_certificate(const std::filesystem::path& path) {
  const BioOwner file(BIO_new_file(path.c_str(), "r"));
  return CertificateOwner(file ? PEM_read_bio_X509(file.get(), nullptr, nullptr, nullptr) : nullptr);
}

KeyOwner read_key(const std::filesystem::path& path) {
  const BioOwner file(BIO_new_file(path.c_str(), "r"));
  // Answers the question for a password with none, so that OpenSSL never asks on the terminal.
  const auto none = [](char*, int, int, void*) { return 0; };
  return KeyOwner(file ? PEM_read_bio_PrivateKey(file.get(), nullptr, none, nullptr) : nullptr);
}

bool is_for(X509* certificate, const std::string& name) {
  if (is_address(name)) return X509_check_ip_asc(certificate, name.c_str(), 0) == 1;
  return X509_check_host(certificate, name.c_str(), name.size(), X509_CHECK_FLAG_NO_WILDCARDS, nullptr) == 1;
}

bool is_good(const CertificateFiles& files, const std::vector<std::string>& names) {
  const CertificateOwner certificate = read_certificate(files.certificate);
  const KeyOwner key = read_key(files.key);
  if (!certificate || !key || X509_check_private_key(certificate.get(), key.get()) != 1) return false;
  time_t earliest = std::time(nullptr) + kMinimumLeft;
  if (X509_cmp_time(X509_get0_notAfter(certificate.get()), &earliest) <= 0) return false;
  if (X509_cmp_current_time(X509_get0_notBefore(certificate.get())) >= 0) return false;
  return std::all_of(names.begin(), names.end(),
                     [&](const std::string& name) { return is_for(certificate.get(), name); });
}

/// @returns localhost, the loopback addresses and the usable ones of `names`. Others are left out: no browser
/// asks for them, and OpenSSL would read them as syntax.
std::vector<std::string> usable(const std::vector<std::string>& names) {
  std::vector<std::string> all{"localhost", "127.0.0.1", "::1"};
  for (const std::string& name : names) {
    const bool known = std::find(all.begin(), all.end(), name) != all.end();
    if (!known && (is_address(name) || is_host_name(name))) all.push_back(name);
  }
  return all;
}

}  // namespace

CertificateFiles make_self_signed_certificate(const std::filesystem::path& folder,
                                              const std::vector<std::string>& names) {
  const std::vector<std::string> all = usable(names);
  CertificateFiles files{folder / "certificate.pem", folder / "key.pem"};
  if (is_good(files, all)) {
    restrict_to_owner(files.key);
    return files;
  }
  const KeyOwner key(EVP_EC_gen("P-256"));
  require(key != nullptr, "its key cannot be made");
  const CertificateOwner certificate = sign(key.get(), all);
  make_secret_folder(folder);
  write_secret_file(files.key, pem_of(key.get()));
  write_secret_file(files.certificate, pem_of(certificate.get()));
  return files;
}

std::string certificate_fingerprint(const std::filesystem::path& path) {
  const CertificateOwner certificate = read_certificate(path);
  if (!certificate) fail(path.string() + " has none in PEM");
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  require(X509_digest(certificate.get(), EVP_sha256(), digest.data(), &size) == 1, "it has no fingerprint");
  std::string text;
  for (unsigned i = 0; i < size; ++i) text += fmt::format("{}{:02X}", i == 0 ? "" : ":", digest[i]);
  return text;
}

}  // namespace phalanx
