// SPDX-License-Identifier: Apache-2.0
// phalanx patient export | delete | rebuild | backup | restore | audit | passphrase: what lies on the disk.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>

#include "apps/patient/registry_program.h"

namespace phalanx {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

class CliPatientStore : public testing::RegistryProgram {
 protected:
  static unsigned mode_of(const fs::path& file) {
    struct stat state = {};
    EXPECT_EQ(::stat(file.c_str(), &state), 0) << file;
    return state.st_mode & 0777U;
  }
  /// Runs a statement of SQL on the database.
  void sql(const std::string& statement) const {
    const auto result = run_command(folder,
                                    "/usr/bin/python3 -c \"import sqlite3; c = "
                                    "sqlite3.connect('data/registry.sqlite'); c.execute('" +
                                        statement + "'); c.commit()\"");
    ASSERT_EQ(result.exit_code, 0) << result.err;
  }
};

TEST_F(CliPatientStore, DeletesSoThatNoFileHoldsTheCode) {
  const std::string code = "ZQ7-XK";
  done("patient add " + code + " --side left --note 'marked: kumquat'");
  done("patient note " + code + " 'marked: kumquat'");
  done("patient test " + code +
       " --kind grip --value 9 --rater KV --date 2026-05-04 --note 'marked: kumquat'");
  done("patient edit " + code + " --warning 'marked: kumquat'");
  done("patient show " + code);
  EXPECT_THAT(files_with(code), IsEmpty()) << "sealed, and the audit log has the record alone";
  EXPECT_THAT(files_with("kumquat"), IsEmpty());
  done("patient backup saved");
  EXPECT_THAT(said("patient export " + code), AllOf(StartsWith("2 "), HasSubstr("--out")));
  EXPECT_THAT(said("patient export " + code + " --out data/exported"),
              AllOf(StartsWith("2 "), HasSubstr("data folder")));
  EXPECT_THAT(said("patient export " + code + " --out exported"), HasSubstr("patient.json"));
  EXPECT_THAT(files_with(code), Contains(StartsWith("exported/")));

  EXPECT_THAT(said("patient delete " + code), HasSubstr("type the same with --confirm " + code));
  EXPECT_THAT(said("patient delete " + code + " --confirm ZQ7-XL"), HasSubstr("nothing was deleted"));
  EXPECT_THAT(said("patient show " + code), StartsWith("0 "));
  EXPECT_THAT(said("patient delete " + code + " --confirm " + code),
              AllOf(StartsWith("0 deleted; the record "), HasSubstr("removed: ")));
  EXPECT_THAT(files_with(code), IsEmpty());
  EXPECT_THAT(files_with("kumquat"), IsEmpty());
  EXPECT_THAT(said("patient show " + code), StartsWith("2 phalanx: "));
  EXPECT_THAT(said("patient list"), HasSubstr("no patients in "));
  EXPECT_THAT(said("patient delete " + code + " --confirm " + code), StartsWith("2 phalanx: "));
  // The backup holds the patient sealed; its key is erased.
  EXPECT_THAT(said("patient restore saved"), HasSubstr("1 patients of the backup stay deleted"));
  EXPECT_THAT(said("patient list"), HasSubstr("no patients in "));
  EXPECT_THAT(files_with(code), IsEmpty());
}

TEST_F(CliPatientStore, DeletesOnlyWhenTheCodeIsTypedAgain) {
  done("patient add P07 --side left --symbol boat");
  const std::string question =
      "P07 (left hand, boat) and all its results will be gone for good. Type the code again: ";
  EXPECT_THAT(typed("patient delete P07", {{question, "P08"}}),
              AllOf(StartsWith("2 "), HasSubstr("nothing was deleted")));
  EXPECT_THAT(typed("patient delete P07", {{question, "P07"}}),
              AllOf(StartsWith("0 "), HasSubstr("deleted")));
  EXPECT_THAT(said("patient list"), HasSubstr("no patients in "));
}

TEST_F(CliPatientStore, DeletesADamagedRecordByItsId) {
  done("patient add P07 --side left");
  const std::string record = fs::directory_iterator(folder / "data/journal")->path().filename().string();
  done("patient add P08 --side right");
  sql("update patients set sealed = 0");
  std::string journal = testing::read_file(folder / "data/journal" / record);
  for (std::size_t i = 60; i < journal.size(); ++i) journal[i] = static_cast<char>(journal[i] ^ 1);
  testing::write_file(folder / "data/journal" / record, journal);
  EXPECT_THAT(said("patient list"),
              AllOf(HasSubstr("P08"), HasSubstr("the record " + record + " is damaged")));
  EXPECT_THAT(said("patient delete " + record), HasSubstr("type the same with --confirm " + record));
  EXPECT_THAT(said("patient delete " + record + " --confirm P07"), HasSubstr("nothing was deleted"));
  EXPECT_THAT(said(fmt::format("patient delete {} --confirm {}", record, record)),
              StartsWith(fmt::format("0 deleted; the record {} remains as a tombstone", record)));
  EXPECT_THAT(said("patient list"), AllOf(HasSubstr("P08"), Not(HasSubstr("damaged"))));
}

TEST_F(CliPatientStore, NamesWhatADeletionDoesNotReach) {
  testing::write_file(
      folder / "c.toml",
      "format = 2\ndevice = \"glove\"\nserial = \"1\"\ndate = \"2026-05-04T09:30:00Z\"\nphalanx = "
      "\"0.1.0\"\n[[channel]]\nkind = \"angle\"\njoint = \"index_pip_flexion\"\ngain = 0.00042\n"
      "offset = -0.21\nresidual_rad = 0.011\nmethod = \"jig\"\nposes = [ { name = \"a\", raw = 500, "
      "value = 0.0, residual_rad = 0.0 }, { name = \"b\", raw = 3021.5, value = 1.05, residual_rad = "
      "0.002 } ]\n");
  done("patient add P07 --side left --calibration c.toml --expires 2199-01-01");
  done("patient export P07 --out exported");
  fs::rename(folder / "exported", folder / "moved");
  EXPECT_THAT(said("patient delete P07 --confirm P07"),
              AllOf(HasSubstr("remains: "), HasSubstr("c.toml (it may state the code"),
                    HasSubstr("not found: the export ")));
}

TEST_F(CliPatientStore, MakesFilesThatOnlyTheirOwnerReads) {
  ::umask(0);
  done("patient add P07 --side left");
  done("patient export P07 --out exported");
  done("patient backup saved");
  ::umask(022);
  std::size_t files = 0;
  for (const char* part : {"data", "keys", "exported", "saved"}) {
    EXPECT_EQ(mode_of(folder / part), 0700U) << part;
    for (const auto& entry : fs::recursive_directory_iterator(folder / part)) {
      EXPECT_EQ(mode_of(entry.path()), entry.is_directory() ? 0700U : 0600U) << entry.path();
      ++files;
    }
  }
  EXPECT_GT(files, 8U);
}

TEST_F(CliPatientStore, RestoresABackupAndKeepsWhatIsNewer) {
  done("patient add P07 --side left");
  done("patient add P08 --side left");
  done("patient note P07 first");
  done("patient backup saved");
  EXPECT_THAT(said("patient backup saved"), StartsWith("2 phalanx: "));
  done("patient delete P08 --confirm P08");
  done("patient add P09 --side right");
  done("patient note P09 second");
  EXPECT_THAT(said("patient restore saved"), HasSubstr("1 patients of the backup stay deleted"));
  const std::string list = said("patient list");
  EXPECT_THAT(list, AllOf(HasSubstr("P07 "), HasSubstr("P09 "), Not(HasSubstr("P08 "))));
  EXPECT_THAT(said("patient show P09"), HasSubstr("second"));
  // On an empty computer with the same keys.
  fs::remove_all(folder / "data");
  EXPECT_THAT(said("patient restore saved"), StartsWith("0 "));
  EXPECT_THAT(said("patient show P07"), HasSubstr("first"));
  EXPECT_THAT(said("patient restore nowhere"), HasSubstr("there is no backup nowhere"));
}

TEST_F(CliPatientStore, RestoresALostFileOfAccountsWithoutAnAccount) {
  done("account add ada --role administrator", "PHALANX_NEW_PASSWORD='a long password'");
  done("patient backup saved --as ada", "PHALANX_PASSWORD='a long password'");
  fs::remove(folder / "data/accounts");
  EXPECT_THAT(said("patient list"), StartsWith("2 "));
  EXPECT_THAT(said("patient restore saved"), StartsWith("0 "));
  EXPECT_THAT(said("patient list --as ada", "PHALANX_PASSWORD='a long password'"), StartsWith("0 "));
}

TEST_F(CliPatientStore, MakesTheDatabaseAgainFromTheJournal) {
  done("patient add P07 --side left --warning careful");
  done("patient note P07 first");
  done("patient test P07 --kind grip --value 9 --rater AB");
  const std::string before = run("patient show P07").out;
  for (const auto& entry : fs::directory_iterator(folder / "data"))
    if (entry.path().filename().string().starts_with("registry.sqlite")) fs::remove(entry.path());
  EXPECT_EQ(run("patient show P07").out, before);
  EXPECT_THAT(said("patient rebuild"),
              StartsWith("0 1 patients, 0 results, 1 entered tests, 1 notes; 0 rows added"));
  EXPECT_EQ(run("patient show P07").out, before);
  EXPECT_THAT(said("patient rebuild nowhere.mcap"),
              HasSubstr("there is no recording and no folder nowhere.mcap"));
  std::ofstream(folder / "text.mcap") << "a text";
  EXPECT_THAT(said("patient rebuild text.mcap"), AllOf(StartsWith("1 "), HasSubstr("text.mcap")));
}

TEST_F(CliPatientStore, RefusesANewerSchemaAndADamagedDatabaseInWords) {
  done("patient add P07 --side left");
  sql("PRAGMA user_version = 99");
  EXPECT_THAT(said("patient list"),
              AllOf(StartsWith("2 phalanx: "), HasSubstr("schema 99"), HasSubstr("newer")));
  std::ofstream(folder / "data/registry.sqlite", std::ios::trunc)
      << "this is no database, it is text of some length";
  EXPECT_THAT(said("patient list"), AllOf(StartsWith("1 phalanx: "), HasSubstr("damaged")));
}

TEST_F(CliPatientStore, NeedsTheKeysAndMakesNoOthersForExistingData) {
  done("patient add P07 --side left");
  fs::rename(folder / "keys", folder / "taken");
  EXPECT_THAT(said("patient list"), AllOf(StartsWith("2 phalanx: "), HasSubstr("there is no key file")));
  EXPECT_FALSE(fs::exists(folder / "keys/patients"));
  EXPECT_THAT(said("patient list --keys data/keys"), StartsWith("2 phalanx: "));
  EXPECT_THAT(said("patient list --keys taken/patients"), HasSubstr("P07"));
}

TEST_F(CliPatientStore, ARunMakesNoKeysInTheDataFolder) {
  EXPECT_THAT(said("run --port 0 --seconds 1 --data fresh --keys fresh/keys"),
              AllOf(StartsWith("2 phalanx: "), HasSubstr("it lies in the data folder")));
  EXPECT_FALSE(fs::exists(folder / "fresh"));
}

TEST_F(CliPatientStore, AuditsEachUseAndFindsAChangedLine) {
  done("patient add P07 --side left");
  done("patient show P07");
  const std::string audit = said("patient audit");
  EXPECT_THAT(audit, AllOf(StartsWith("0 "), HasSubstr(" owner"), HasSubstr(" add "), HasSubstr(" show "),
                           Not(HasSubstr("P07"))));
  std::string log = testing::read_file(folder / "data/audit.jsonl");
  const std::size_t at = log.find("\"show\"");
  ASSERT_NE(at, std::string::npos);
  log.replace(at, 6, "\"list\"");
  std::ofstream(folder / "data/audit.jsonl", std::ios::binary) << log;
  EXPECT_THAT(said("patient audit --check"), AllOf(StartsWith("1 "), Not(HasSubstr(" owner "))));
}

TEST_F(CliPatientStore, WrapsTheKeysByAPassphrase) {
  done("patient add P07 --side left", "PHALANX_PASSPHRASE='correct horse'");
  EXPECT_FALSE(fs::exists(folder / "keys/patients.master"));
  EXPECT_THAT(said("patient list"),
              AllOf(StartsWith("2 phalanx: the passphrase of "), HasSubstr("PHALANX_PASSPHRASE")));
  EXPECT_THAT(said("patient list", "PHALANX_PASSPHRASE=wrong"),
              AllOf(StartsWith("1 "), HasSubstr("passphrase")));
}

TEST_F(CliPatientStore, ChangesThePassphraseOfTheKeys) {
  done("patient add P07 --side left", "PHALANX_PASSPHRASE='correct horse'");
  EXPECT_THAT(said("patient passphrase --none", "PHALANX_PASSPHRASE='correct horse'"), StartsWith("0 "));
  EXPECT_THAT(said("patient list"), HasSubstr("P07"));
  EXPECT_THAT(said("patient passphrase", "PHALANX_NEW_PASSPHRASE='another one'"), StartsWith("0 "));
  EXPECT_THAT(said("patient list", "PHALANX_PASSPHRASE='another one'"), HasSubstr("P07"));
}

// The station holds the lock that src/registry takes for the time of a recording.
TEST_F(CliPatientStore, DoesNotDeleteAPatientWithWhoseKeyAStationRecords) {
  done("patient add P07 --side left");
  const std::string record = fs::directory_iterator(folder / "data/journal")->path().filename().string();
  fs::create_directory(folder / "data/in_use");
  const int use = ::open((folder / "data/in_use" / record).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  ASSERT_GE(use, 0);
  ASSERT_EQ(::flock(use, LOCK_SH), 0);
  EXPECT_THAT(said("patient delete P07 --confirm P07"),
              AllOf(StartsWith("2 phalanx: "), HasSubstr("records with the key of this patient"),
                    HasSubstr("on the page of that station"), HasSubstr("end that program")));
  EXPECT_THAT(said("patient list"), HasSubstr("P07"));
  ::close(use);
  EXPECT_THAT(said("patient delete P07 --confirm P07"), StartsWith("0 "));
  EXPECT_FALSE(fs::exists(folder / "data/in_use" / record));
}

}  // namespace
}  // namespace phalanx
