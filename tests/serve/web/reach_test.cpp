// SPDX-License-Identifier: Apache-2.0
// The linker redirects the calls of getifaddrs() and freeifaddrs() in this program to the
// functions below (--wrap).
#include "phalanx/serve/reach.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <ifaddrs.h>
#include <net/if.h>
#include <netinet/in.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <qrencode.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "serve/web/secret_file.h"

namespace phalanx {
namespace {

/// Result of getifaddrs(); null: the result of the system.
ifaddrs* the_interfaces = nullptr;

}  // namespace
}  // namespace phalanx

extern "C" int __real_getifaddrs(ifaddrs** list);
extern "C" void __real_freeifaddrs(ifaddrs* list);
extern "C" int __wrap_getifaddrs(ifaddrs** list);
extern "C" int __wrap_getifaddrs(ifaddrs** list) {
  if (phalanx::the_interfaces == nullptr) return __real_getifaddrs(list);
  *list = phalanx::the_interfaces;
  return 0;
}
extern "C" void __wrap_freeifaddrs(ifaddrs* list);
extern "C" void __wrap_freeifaddrs(ifaddrs* list) {
  if (list != phalanx::the_interfaces) __real_freeifaddrs(list);
}

namespace phalanx {
namespace {

using testing::Contains;
using testing::Each;
using testing::ElementsAre;
using testing::EndsWith;
using testing::MatchesRegex;
using testing::StartsWith;

TEST(RandomToken, IsAHundredAndTwentyEightBitsThatAreNeverTheSame) {
  std::set<std::string> seen;
  for (int i = 0; i < 1000; ++i) {
    const std::string token = random_token();
    EXPECT_THAT(token, MatchesRegex("[A-Za-z0-9_-]{22}"));
    EXPECT_TRUE(seen.insert(token).second);
  }
}

TEST(LanUrls, NameEveryAddressAndTheToken) {
  const std::vector<std::string> urls = lan_urls("::", 8480, "abc");
  EXPECT_EQ(urls.size(), machine_addresses().size());
  EXPECT_THAT(urls, Each(StartsWith("https://")));
  EXPECT_THAT(urls, Each(EndsWith(":8480/?token=abc")));
  EXPECT_THAT(lan_urls("::", 8480, ""), Each(EndsWith(":8480/")));
  EXPECT_THAT(machine_addresses(), testing::Not(Contains("127.0.0.1")));
}

struct Interface {
  int flags = 0;
  std::string address;  ///< empty: none; "hardware": none of IP
};

/// Gives the machine these interfaces during its lifetime.
class TheseInterfaces {
 public:
  explicit TheseInterfaces(const std::vector<Interface>& interfaces) : all_(interfaces.size()) {
    for (std::size_t i = 0; i < all_.size(); ++i) {
      Entry& entry = all_[i];
      const std::string& address = interfaces[i].address;
      entry.listed.ifa_flags = static_cast<unsigned>(interfaces[i].flags);
      entry.listed.ifa_next = i + 1 < all_.size() ? &all_[i + 1].listed : nullptr;
      if (address.empty()) continue;
      const bool is_v4 = ::inet_pton(AF_INET, address.c_str(), &entry.v4.sin_addr) == 1;
      const bool is_v6 = ::inet_pton(AF_INET6, address.c_str(), &entry.v6.sin6_addr) == 1;
      entry.v4.sin_family = AF_INET;
      entry.v6.sin6_family = static_cast<sa_family_t>(is_v6 ? AF_INET6 : AF_PACKET);
      entry.listed.ifa_addr =
          is_v4 ? reinterpret_cast<sockaddr*>(&entry.v4) : reinterpret_cast<sockaddr*>(&entry.v6);
    }
    the_interfaces = &all_.front().listed;
  }
  TheseInterfaces(const TheseInterfaces&) = delete;
  TheseInterfaces& operator=(const TheseInterfaces&) = delete;
  ~TheseInterfaces() { the_interfaces = nullptr; }

 private:
  struct Entry {
    ifaddrs listed{};
    sockaddr_in v4{};
    sockaddr_in6 v6{};
  };
  std::vector<Entry> all_;
};

// 169.254/16 and fe80::/10 are link-local.
TEST(MachineAddresses, AreReachableFromOthersIPv4First) {
  const TheseInterfaces these({{IFF_UP | IFF_LOOPBACK, "127.0.0.1"},
                               {IFF_UP | IFF_LOOPBACK, "::1"},
                               {IFF_UP, "hardware"},
                               {IFF_UP, ""},
                               {IFF_UP, "2001:db8::7"},
                               {IFF_UP, "fe80::7"},
                               {0, "192.0.2.1"},
                               {IFF_UP | IFF_RUNNING, "192.0.2.7"},
                               {IFF_UP, "169.254.0.7"},
                               {IFF_UP, "169.253.0.7"}});
  EXPECT_THAT(machine_addresses(), ElementsAre("192.0.2.7", "169.253.0.7", "2001:db8::7"));
  EXPECT_THAT(lan_urls("::", 8480, "abc"),
              ElementsAre("https://192.0.2.7:8480/?token=abc", "https://169.253.0.7:8480/?token=abc",
                          "https://[2001:db8::7]:8480/?token=abc"));
  EXPECT_THAT(lan_urls("0.0.0.0", 8480, "abc"),
              ElementsAre("https://192.0.2.7:8480/?token=abc", "https://169.253.0.7:8480/?token=abc"))
      << "a socket of IPv4 does not answer at an address of IPv6";
  EXPECT_THAT(lan_urls("192.0.2.7", 8480, "abc"), ElementsAre("https://192.0.2.7:8480/?token=abc"));
  EXPECT_THAT(lan_urls("2001:db8::7", 8480, ""), ElementsAre("https://[2001:db8::7]:8480/"));
}

TEST(IsLoopback, IsTrueForAddressesThatOnlyThisMachineReaches) {
  for (const char* address : {"127.0.0.1", "127.255.0.9", "::1", "0:0:0:0:0:0:0:1", "localhost"})
    EXPECT_TRUE(is_loopback(address)) << address;
  for (const char* address : {"", "0.0.0.0", "::", "128.0.0.1", "126.0.0.1", "127.0.0.1.evil.example", "::2"})
    EXPECT_FALSE(is_loopback(address)) << address;
}

TEST(SshLine, IsGivenInAnSshSession) {
  ASSERT_EQ(::setenv("SSH_CONNECTION", "198.51.100.7 50000 192.0.2.2 22", 1), 0);
  EXPECT_THAT(ssh_line(8480), MatchesRegex("ssh -L 8480:127\\.0\\.0\\.1:8480 [^ ]+@192\\.0\\.2\\.2"));
  ASSERT_EQ(::setenv("SSH_CONNECTION", "198.51.100.7 50000 192.0.2.2 2222", 1), 0);
  EXPECT_THAT(ssh_line(8481), StartsWith("ssh -p 2222 -L 8481:127.0.0.1:8481 "));
  ASSERT_EQ(::setenv("SSH_CONNECTION", "nonsense", 1), 0);
  EXPECT_EQ(ssh_line(8480), "");
  ASSERT_EQ(::unsetenv("SSH_CONNECTION"), 0);
  EXPECT_EQ(ssh_line(8480), "");
}

/// @returns the modules of a printed code, true for dark; the caller checks the colours
std::vector<std::vector<bool>> modules(const std::string& text) {
  std::vector<std::vector<bool>> rows;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t begin = line.find('m') + 1;
    const std::string cells = line.substr(begin, line.rfind('\x1b') - begin);
    std::vector<bool> upper;
    std::vector<bool> lower;
    for (std::size_t i = 0; i < cells.size();) {
      const bool space = cells[i] == ' ';
      const std::string cell = cells.substr(i, space ? 1 : 3);
      upper.push_back(cell == "\u2588" || cell == "\u2580");
      lower.push_back(cell == "\u2588" || cell == "\u2584");
      i += cell.size();
    }
    rows.push_back(upper);
    rows.push_back(lower);
  }
  return rows;
}

TEST(QrText, IsTheCodeWithAQuietZoneDarkOnLight) {
  const std::string url = "https://192.0.2.2:8480/?token=AAAAAAAAAAAAAAAAAAAAAA";
  const std::string text = qr_text(url);
  const auto rows = modules(text);
  const std::unique_ptr<QRcode, decltype(&QRcode_free)> code(
      QRcode_encodeString8bit(url.c_str(), 0, QR_ECLEVEL_M), &QRcode_free);
  const auto width = static_cast<std::size_t>(code->width);
  ASSERT_GE(rows.size(), width + 8);
  for (std::size_t row = 0; row < rows.size(); ++row) {
    ASSERT_EQ(rows[row].size(), width + 8);
    for (std::size_t column = 0; column < width + 8; ++column) {
      const bool inside = row >= 4 && row < width + 4 && column >= 4 && column < width + 4;
      const bool dark = inside && (code->data[(row - 4) * width + column - 4] & 1U) != 0;
      ASSERT_EQ(rows[row][column], dark) << row << " " << column;
    }
  }
  EXPECT_THAT(text, StartsWith("\x1b[38;5;16;48;5;231m"));
  EXPECT_THAT(text, EndsWith("\x1b[0m\n"));
}

TEST(QrText, RefusesTextThatDoesNotFit) {
  EXPECT_THROW((void)qr_text(""), std::runtime_error);
  EXPECT_THROW((void)qr_text(std::string(5000, 'x')), std::runtime_error);
}

class Certificate : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove_all(folder_); }
  static std::string text_of(const std::filesystem::path& path) {
    std::ifstream file(path);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static unsigned mode_of(const std::filesystem::path& path) {
    struct stat status{};
    EXPECT_EQ(::stat(path.c_str(), &status), 0);
    return status.st_mode & 07777U;
  }
  const std::filesystem::path folder_ =
      std::filesystem::temp_directory_path() / ("phalanx-certificate-" + std::to_string(::getpid()));
};

TEST_F(Certificate, IsForTheNamesAndItsKeyIsSecret) {
  const CertificateFiles files = make_self_signed_certificate(
      folder_ / "deep", {"station", "192.0.2.2", "fd00::2", "", "x,IP:192.0.2.66"});
  EXPECT_EQ(mode_of(files.key), 0600U);
  EXPECT_EQ(mode_of(folder_ / "deep"), 0700U);
  const std::unique_ptr<BIO, decltype(&BIO_free_all)> file(BIO_new_file(files.certificate.c_str(), "r"),
                                                           &BIO_free_all);
  const std::unique_ptr<X509, decltype(&X509_free)> made(
      PEM_read_bio_X509(file.get(), nullptr, nullptr, nullptr), &X509_free);
  ASSERT_TRUE(made);
  for (const char* name : {"station", "localhost"}) {
    EXPECT_EQ(X509_check_host(made.get(), name, 0, 0, nullptr), 1) << name;
  }
  EXPECT_EQ(X509_check_host(made.get(), "other", 0, 0, nullptr), 0);
  for (const char* address : {"192.0.2.2", "fd00::2", "127.0.0.1", "::1"}) {
    EXPECT_EQ(X509_check_ip_asc(made.get(), address, 0), 1) << address;
  }
  EXPECT_EQ(X509_check_ip_asc(made.get(), "192.0.2.66", 0), 0) << "a text with a comma is no name";
  std::array<char, 64> common{};
  X509_NAME_get_text_by_NID(X509_get_subject_name(made.get()), NID_commonName, common.data(),
                            static_cast<int>(common.size()));
  EXPECT_STREQ(common.data(), "Phalanx station");
  EXPECT_GE(X509_get_ext_by_NID(made.get(), NID_basic_constraints, -1), 0);
  EXPECT_EQ(X509_check_ca(made.get()), 0) << "it signs no others";
  EXPECT_EQ(X509_get_key_usage(made.get()), std::uint32_t{KU_DIGITAL_SIGNATURE});
  EXPECT_EQ(X509_get_extended_key_usage(made.get()), std::uint32_t{XKU_SSL_SERVER});
  int days = 0;
  int rest = 0;
  ASSERT_EQ(ASN1_TIME_diff(&days, &rest, X509_get0_notBefore(made.get()), X509_get0_notAfter(made.get())), 1);
  EXPECT_EQ(days, 397);
  ASSERT_EQ(ASN1_TIME_diff(&days, &rest, X509_get0_notBefore(made.get()), nullptr), 1);
  EXPECT_EQ(days, 1) << "valid from yesterday on: another computer's clock may be behind";
  EXPECT_EQ(X509_verify(made.get(), X509_get0_pubkey(made.get())), 1) << "signed by itself";
  EXPECT_THAT(certificate_fingerprint(files.certificate), MatchesRegex("([0-9A-F]{2}:){31}[0-9A-F]{2}"));
}

TEST_F(Certificate, IsUsedAgainWhileItFits) {
  const CertificateFiles files = make_self_signed_certificate(folder_, {"station", "odd name; is left out"});
  const std::string first = text_of(files.certificate);
  ASSERT_EQ(::chmod(files.key.c_str(), 0644), 0);
  const CertificateFiles again = make_self_signed_certificate(folder_, {"station", "odd name; is left out"});
  EXPECT_EQ(again.certificate, files.certificate);
  EXPECT_EQ(again.key, files.key);
  EXPECT_EQ(text_of(files.certificate), first);
  EXPECT_EQ(mode_of(files.key), 0600U) << "restricted again";
  (void)make_self_signed_certificate(folder_, {"station", "192.0.2.9"});
  EXPECT_NE(text_of(files.certificate), first) << "it was not for this address";
}

// It must be valid for another week.
TEST_F(Certificate, IsReplacedBeforeItEnds) {
  const CertificateFiles files = make_self_signed_certificate(folder_, {});
  const std::unique_ptr<BIO, decltype(&BIO_free_all)> file(BIO_new_file(files.certificate.c_str(), "r"),
                                                           &BIO_free_all);
  const std::unique_ptr<BIO, decltype(&BIO_free_all)> key_file(BIO_new_file(files.key.c_str(), "r"),
                                                               &BIO_free_all);
  const std::unique_ptr<X509, decltype(&X509_free)> made(
      PEM_read_bio_X509(file.get(), nullptr, nullptr, nullptr), &X509_free);
  const std::unique_ptr<EVP_PKEY, decltype(&EVP_PKEY_free)> key(
      PEM_read_bio_PrivateKey(key_file.get(), nullptr, nullptr, nullptr), &EVP_PKEY_free);
  ASSERT_TRUE(made && key);
  for (const int days : {10, 3}) {
    X509_gmtime_adj(X509_getm_notAfter(made.get()), days * 24L * 60 * 60);
    ASSERT_GT(X509_sign(made.get(), key.get(), EVP_sha256()), 0);
    {
      const std::unique_ptr<BIO, decltype(&BIO_free_all)> out(BIO_new_file(files.certificate.c_str(), "w"),
                                                              &BIO_free_all);
      ASSERT_EQ(PEM_write_bio_X509(out.get(), made.get()), 1);
    }
    const std::string written = text_of(files.certificate);
    (void)make_self_signed_certificate(folder_, {});
    EXPECT_EQ(text_of(files.certificate) == written, days == 10) << days;
  }
}

TEST_F(Certificate, IsReplacedIfItIsBroken) {
  const CertificateFiles files = make_self_signed_certificate(folder_, {});
  const std::string first = text_of(files.certificate);
  std::ofstream(files.key) << "nonsense";
  (void)make_self_signed_certificate(folder_, {});
  EXPECT_NE(text_of(files.certificate), first);
  EXPECT_THAT(text_of(files.key), StartsWith("-----BEGIN PRIVATE KEY-----"));
}

TEST_F(Certificate, ASecretMayBeOneByteLong) {
  std::filesystem::create_directories(folder_);
  web::write_secret_file(folder_ / "secret", "x");
  EXPECT_EQ(text_of(folder_ / "secret"), "x");
  EXPECT_EQ(mode_of(folder_ / "secret"), 0600U);
}

TEST_F(Certificate, AKeyThatOthersMayReadOrWriteIsRefused) {
  std::filesystem::create_directories(folder_);
  const std::filesystem::path key = folder_ / "key.pem";
  web::write_secret_file(key, "secret");
  for (const mode_t mode : {0600U, 0400U}) {
    ASSERT_EQ(::chmod(key.c_str(), mode), 0);
    EXPECT_EQ(web::read_secret_file(key), "secret");
  }
  for (const mode_t mode : {0604U, 0602U, 0640U, 0620U, 0644U, 0666U}) {
    ASSERT_EQ(::chmod(key.c_str(), mode), 0);
    try {
      static_cast<void>(web::read_secret_file(key));
      ADD_FAILURE() << std::oct << mode;
    } catch (const std::runtime_error& refused) {
      EXPECT_THAT(refused.what(), testing::AllOf(testing::HasSubstr("chmod 600"), StartsWith(key.string())));
    }
  }
  EXPECT_THROW(static_cast<void>(web::read_secret_file(folder_ / "none")), std::runtime_error);
  web::write_secret_file(key, std::string(64 * 1024 + 1, 'x'));
  EXPECT_THROW(static_cast<void>(web::read_secret_file(key)), std::runtime_error);
}

TEST_F(Certificate, ThrowsIfItCannotBeWritten) {
  std::filesystem::create_directories(folder_);
  std::ofstream(folder_ / "file") << "in the way";
  EXPECT_THROW((void)make_self_signed_certificate(folder_ / "file" / "keys", {}), std::runtime_error);
  EXPECT_THROW((void)certificate_fingerprint(folder_ / "file"), std::runtime_error);
}

}  // namespace
}  // namespace phalanx
