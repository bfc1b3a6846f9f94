// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openssl/bio.h>
#include <openssl/evp.h>
#include <openssl/x509.h>
#include <openssl/x509v3.h>

#include <memory>

namespace phalanx::web {

/// Frees what OpenSSL made.
template <auto kFree>
struct Freer {
  template <class T>
  void operator()(T* made) const noexcept {
    kFree(made);
  }
};
using CertificateOwner = std::unique_ptr<X509, Freer<&X509_free>>;
using KeyOwner = std::unique_ptr<EVP_PKEY, Freer<&EVP_PKEY_free>>;
using BioOwner = std::unique_ptr<BIO, Freer<&BIO_free_all>>;
using ExtensionOwner = std::unique_ptr<X509_EXTENSION, Freer<&X509_EXTENSION_free>>;

}  // namespace phalanx::web
