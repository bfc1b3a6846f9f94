// SPDX-License-Identifier: Apache-2.0
// phalanx account, and what the roles may do with `phalanx patient`.
#include "apps/patient/registry_program.h"

namespace phalanx {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class CliAccount : public testing::RegistryProgram {
 protected:
  void SetUp() override {
    done("patient add P07 --side left");
    done("account add anna --role administrator", "PHALANX_NEW_PASSWORD=long-enough-1");
  }
  /// Runs a command as the administrator.
  std::string as_anna(const std::string& command, const std::string& set = "") const {
    return said(command + " --as anna", "PHALANX_PASSWORD=long-enough-1 " + set);
  }
};

TEST_F(CliAccount, EndsTheOwnersModeAndItsPasswordIsHidden) {
  EXPECT_THAT(said("patient list"),
              AllOf(StartsWith("2 phalanx: "), HasSubstr("state yours with --as ACCOUNT")));
  EXPECT_THAT(said("patient list --as anna"),
              AllOf(StartsWith("2 phalanx: the password of anna is missing"), HasSubstr("PHALANX_PASSWORD")));
  EXPECT_THAT(said("patient list --as anna", "PHALANX_PASSWORD=wrong"), StartsWith("2 phalanx: "));
  EXPECT_THAT(typed("patient audit --as anna", {{"password of anna: ", "long-enough-1"}}),
              AllOf(StartsWith("0 "), HasSubstr(" anna "), HasSubstr(" owner "), HasSubstr("_failed"),
                    Not(HasSubstr("long-enough"))));
  EXPECT_THAT(said("account delete anna"), HasSubstr("type the same with --yes"));
  EXPECT_THAT(as_anna("account password anna", "PHALANX_NEW_PASSWORD=long-enough-9"), StartsWith("0 "));
  EXPECT_THAT(said("account delete anna --yes --as anna", "PHALANX_PASSWORD=long-enough-9"),
              HasSubstr("it was the last one"));
  EXPECT_THAT(said("patient list"), HasSubstr("P07"));
  EXPECT_THAT(said("patient list --as anna", "PHALANX_PASSWORD=long-enough-9"), HasSubstr("has no accounts"));
}

TEST_F(CliAccount, GivesEachRoleItsRights) {
  EXPECT_THAT(as_anna("account add theo --role therapist", "PHALANX_NEW_PASSWORD=long-enough-2"),
              StartsWith("0 theo: therapist\n"));
  const std::string theo = "PHALANX_PASSWORD=long-enough-2";
  EXPECT_THAT(said("patient show P07 --as theo", theo), StartsWith("0 P07"));
  EXPECT_THAT(said("patient audit --as theo", theo), StartsWith("2 phalanx: "));
  EXPECT_THAT(as_anna("account edit theo --role look_on"), StartsWith("0 theo: look_on\n"));
  EXPECT_THAT(said("patient list --as theo", theo), AllOf(StartsWith("2 phalanx: "), Not(HasSubstr("left"))));
}

TEST_F(CliAccount, AreListedChangedAndDeletedButForTheLastAdministrator) {
  EXPECT_THAT(as_anna("account add theo --role therapist", "PHALANX_NEW_PASSWORD=long-enough-2"),
              StartsWith("0 "));
  EXPECT_THAT(as_anna("account add theo --role therapist", "PHALANX_NEW_PASSWORD=long-enough-2"),
              StartsWith("2 phalanx: "));
  EXPECT_THAT(as_anna("account add Theo --role therapist", "PHALANX_NEW_PASSWORD=long-enough-2"),
              StartsWith("2 phalanx: "));
  EXPECT_THAT(as_anna("account add tom --role nurse", "PHALANX_NEW_PASSWORD=long-enough-2"),
              HasSubstr("therapist"));
  EXPECT_THAT(as_anna("account list"), AllOf(HasSubstr("anna"), HasSubstr("theo"), HasSubstr("therapist")));
  EXPECT_THAT(as_anna("account edit anna --role therapist"), StartsWith("2 phalanx: "));
  EXPECT_THAT(as_anna("account delete anna --yes"), StartsWith("2 phalanx: "));
  EXPECT_THAT(as_anna("account password theo", "PHALANX_NEW_PASSWORD=short"), StartsWith("2 phalanx: "));
  EXPECT_THAT(as_anna("account delete theo --yes"), StartsWith("0 deleted the account theo\n"));
  EXPECT_THAT(as_anna("account delete theo --yes"), StartsWith("2 phalanx: "));
  EXPECT_THAT(as_anna("account list"), Not(HasSubstr("theo")));
}

TEST_F(CliAccount, OfLookOnSeesNothingOfPatients) {
  EXPECT_THAT(as_anna("account add lou --role look_on", "PHALANX_NEW_PASSWORD=long-enough-3"),
              StartsWith("0 "));
  for (const char* command :
       {"patient list", "patient show P07", "patient results P07", "patient trend P07", "patient note P07 x",
        "patient edit P07 --note x", "patient export P07 --out e", "patient delete P07 --confirm P07",
        "patient backup b", "patient restore data", "patient rebuild", "patient audit",
        "patient passphrase --none", "account list"})
    EXPECT_THAT(said(std::string(command) + " --as lou", "PHALANX_PASSWORD=long-enough-3"),
                AllOf(StartsWith("2 phalanx: "), Not(HasSubstr("left"))))
        << command;
}

using CliSecret = testing::RegistryProgram;

TEST_F(CliSecret, ThatIsNewIsTypedTwice) {
  const std::string question = "new password of anna (at least 10 bytes)";
  EXPECT_THAT(
      typed("account add anna --role administrator",
            {{question + ": ", "long-enough-1"}, {question + ", again: ", "long-enough-2"}}),
      AllOf(StartsWith("2 "), HasSubstr("the two differ; nothing was done"), Not(HasSubstr("long-enough"))));
  EXPECT_THAT(said("account list"), HasSubstr("no accounts"));
}

}  // namespace
}  // namespace phalanx
