// SPDX-License-Identifier: Apache-2.0
// Recordings of a patient: what `patient rebuild` makes of them, and what `patient delete` leaves of them.
#include <filesystem>

#include "apps/exercise/exercise_program.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::StartsWith;

class CliPatientRecordings : public testing::ExerciseProgram {
 protected:
  /// Adds a simulated patient, makes a backup `saved`, and then a recording with a result.
  void SetUp() override {
    write_short();
    done("patient add " + code + " --side right --consent yes");
    done("patient backup saved");
    const auto carried_out =
        exercise("short.toml --demo healthy --seed 3 --patient " + code + " --confirm " + code);
    ASSERT_EQ(carried_out.exit_code, 0) << carried_out.err;
    ASSERT_THAT(recordings(), SizeIs(1));
  }

  /// @returns what `patient show` has of the own range; empty: none
  std::string own_range() const {
    const std::string shown = said("patient show " + code);
    const std::size_t at = shown.find("own range:");
    return at == std::string::npos ? std::string() : shown.substr(at, shown.find("own force:", at) - at);
  }

  const std::string code = "SIM-ZQ7";
};

TEST_F(CliPatientRecordings, GiveTheSameRowsToARegistryThatLostThem) {
  const std::string results = said("patient results " + code + " --json");
  EXPECT_THAT(results, HasSubstr("\"exercise\":\"short\""));
  const std::string measured = own_range();
  EXPECT_THAT(measured, HasSubstr("index_pip_flexion"));
  fs::remove_all(folder / "data");
  done("patient restore saved");
  EXPECT_THAT(said("patient results " + code), HasSubstr("no results"));
  EXPECT_THAT(own_range(), IsEmpty());
  EXPECT_THAT(said("patient rebuild rec"),
              StartsWith("0 1 patients, 1 results, 0 entered tests, 0 notes; 1 rows added"));
  EXPECT_EQ(said("patient results " + code + " --json"), results);
  EXPECT_EQ(own_range(), measured) << "it was measured after the backup";
  done("patient edit " + code + " --clear own-range");
  EXPECT_THAT(said("patient rebuild rec"), HasSubstr("0 rows added, 0 changed"));
  EXPECT_THAT(own_range(), IsEmpty()) << "the registry had the result: a person has changed this since";
  fs::rename(folder / "rec", folder / "away");
  EXPECT_THAT(said("patient rebuild"), HasSubstr("kept, its recording is missing: "));
  EXPECT_EQ(said("patient results " + code + " --json"), results);
}

TEST_F(CliPatientRecordings, AreUnreadableOnceThePatientIsDeleted) {
  fs::copy(folder / "rec", folder / "copy");
  fs::copy(folder / "data", folder / "data-copy", fs::copy_options::recursive);
  const std::string name = fs::path(recordings().front()).filename().string();
  EXPECT_THAT(said("session show --quiet copy/" + name), StartsWith("0 "));
  EXPECT_THAT(said("exercise results --quiet copy/" + name), StartsWith("0 "));
  EXPECT_THAT(said("patient delete " + code + " --confirm " + code),
              HasSubstr("unreadable from now on, copies too: " + name));
  EXPECT_THAT(files_with(code), IsEmpty());
  for (const char* file : {"rec/", "copy/"})
    EXPECT_THAT(said("exercise results --quiet " + (file + name)),
                AllOf(Not(StartsWith("0 ")), HasSubstr("it is encrypted, and its key")))
        << file;
  EXPECT_THAT(said("patient list --data data-copy"),
              AllOf(HasSubstr("no patients in "), Not(HasSubstr(code))));
  EXPECT_THAT(said("patient restore saved"), HasSubstr("1 patients of the backup stay deleted"));
  EXPECT_THAT(said("patient rebuild rec"),
              AllOf(StartsWith("0 0 patients, 0 results"), HasSubstr(name + ": its patient was deleted")));
}

TEST_F(CliPatientRecordings, AreReadThroughTheRegistryWhereThereAreAccounts) {
  const std::string file = recordings().front();
  const std::string secret = "PHALANX_PASSWORD=long-enough-1";
  done("account add anna --role administrator", "PHALANX_NEW_PASSWORD=long-enough-1");
  done("account add luis --role look_on --as anna", secret + " PHALANX_NEW_PASSWORD=long-enough-2");
  for (const std::string command : {"session show --quiet ", "session export --quiet --out tables ",
                                    "replay --quiet ", "exercise results --quiet "}) {
    EXPECT_THAT(said(command + file),
                AllOf(Not(StartsWith("0 ")), HasSubstr("state yours with --as"), HasSubstr("is encrypted")))
        << command;
    EXPECT_THAT(said(command + "--keys keys/patients " + file),
                AllOf(StartsWith("2 "), HasSubstr("state yours with --as")))
        << command;
    EXPECT_THAT(said(command + "--as luis " + file, "PHALANX_PASSWORD=long-enough-2"), Not(StartsWith("0 ")))
        << command;
    EXPECT_THAT(said(command + "--as anna " + file, secret), StartsWith("0 ")) << command;
  }
  EXPECT_THAT(said("patient audit --as anna", secret), HasSubstr(" keys"));
}

}  // namespace
}  // namespace phalanx
