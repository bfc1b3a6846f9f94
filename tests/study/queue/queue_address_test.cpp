// SPDX-License-Identifier: Apache-2.0
#include "study/queue/queue_address.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "study/laboratory/expect_refusal.h"

namespace phalanx {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(QueueAddress, OverTcpTheCertificateIsChecked) {
  EXPECT_THAT(queue_connection("postgresql://me@db.example.org/studies"),
              AllOf(HasSubstr("host='db.example.org'"), HasSubstr("sslmode='verify-full'"),
                    HasSubstr("user='me'"), HasSubstr("dbname='studies'")));
  EXPECT_THAT(queue_connection("postgres://h/d?sslrootcert=/a%20b/it's"),
              HasSubstr(R"(sslrootcert='/a b/it\'s')"));
  for (const char* url : {"postgresql://h/d?sslmode=require", "postgresql://h/d?sslmode=prefer",
                          "postgresql://h/d?sslmode=verify-ca", "postgresql://localhost,h/d?sslmode=disable",
                          "postgresql:///d?host=/run,h&sslmode=disable",
                          "postgresql://localhost/d?hostaddr=10.0.0.1&sslmode=disable"})
    testing::expect_refusal([&] { static_cast<void>(queue_connection(url)); },
                            {"sslmode", "sslrootcert=FILE"});
}

TEST(QueueAddress, ALoopbackServerMayBeUsedWithout) {
  EXPECT_THAT(queue_connection("postgresql://localhost/d"), HasSubstr("sslmode='verify-full'"));
  for (const char* host : {"localhost", "127.0.0.1", "[::1]"})
    EXPECT_THAT(queue_connection(std::string("postgresql://") + host + "/d?sslmode=disable"),
                HasSubstr("sslmode='disable'"));
}

TEST(QueueAddress, ASocketMayBeUsedWithout) {
  EXPECT_THAT(queue_connection("postgresql:///d?host=/run/postgresql&sslmode=disable"),
              HasSubstr("host='/run/postgresql'"));
}

TEST(QueueAddress, NeitherTheEnvironmentNorAServiceNorKerberosChangesTheHostOrTheCheck) {
  const std::string connection = queue_connection("postgresql:///d?host=/run/postgresql");
  for (const char* setting : {"hostaddr=''", "sslmode='verify-full'", "gssencmode='disable'"})
    EXPECT_THAT(connection, HasSubstr(setting));
  EXPECT_THAT(queue_connection("postgresql://h/d?gssencmode=prefer"), HasSubstr("gssencmode='disable'"));
  testing::expect_refusal([] { static_cast<void>(queue_connection("postgresql://h/d?service=s")); },
                          {"service"});
}

TEST(QueueAddress, APasswordIsRefusedAndNotRepeated) {
  for (const char* url : {"postgresql://me:sesame@h/d", "postgresql://h/d?password=sesame",
                          "postgresql://h/d?sslpassword=sesame", "postgresql://me:sesame@h/d?nonsense=1",
                          "postgresql://me:sesame@h:port:5/d", "host=h password=sesame"}) {
    try {
      static_cast<void>(queue_connection(url));
      ADD_FAILURE() << "accepted: " << url;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), Not(HasSubstr("sesame")));
    }
  }
  testing::expect_refusal([] { static_cast<void>(queue_connection("postgresql://me:sesame@h/d")); },
                          {"~/.pgpass"});
}

TEST(QueueAddress, WhatIsNoAddressIsRefusedWithTheForm) {
  for (const char* url : {"", "mysql://h/d", "host=h", "postgresql://h/d?nonsense=1", "postgresql://[::1/d",
                          "postgresql:///d", "postgresql://h/%zz"})
    testing::expect_refusal([&] { static_cast<void>(queue_connection(url)); },
                            {"postgresql://USER@HOST/DATABASE"});
}

}  // namespace
}  // namespace phalanx
