// SPDX-License-Identifier: Apache-2.0
// A program that changes the registry is killed at any of its system calls, half-written bytes included.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <filesystem>
#include <functional>
#include <new>
#include <random>

#include "registry/killed_calls.h"
#include "registry/private_file.h"
#include "registry/registry_files.h"
#include "support/sanitized.h"

namespace phalanx {
namespace {

using testing::example_patient;
using testing::example_result;
using testing::kOwner;
using testing::RegistryFiles;
using testing::state_text;

/// What the killed program tells this one.
struct Told {
  std::atomic<std::uint64_t> done{0};   ///< operations whose call returned
  std::atomic<std::uint64_t> calls{0};  ///< system calls until the end
  std::atomic<bool> failed{false};
};

/// Memory that parent and child share.
class SharedTold {
 public:
  SharedTold()
      : memory_(::mmap(nullptr, sizeof(Told), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)),
        told_(new(memory_) Told()) {}
  ~SharedTold() { ::munmap(memory_, sizeof(Told)); }
  SharedTold(const SharedTold&) = delete;
  SharedTold& operator=(const SharedTold&) = delete;
  Told& operator*() { return *told_; }
  Told* operator->() { return told_; }

 private:
  void* memory_;
  Told* told_;
};

/// A reader of recordings that finds none.
std::vector<ResultRow> no_results(const std::filesystem::path&, const FindRecordingKey&) { return {}; }

/// One random operation. Each draws the same numbers in every run, so that a seed is one sequence.
void change(Registry& registry, RegistryFiles& files, std::mt19937_64& random, std::uint64_t step) {
  const std::vector<Patient> all = registry.patients(kOwner);
  const std::uint64_t kind = random() % 12;
  const std::uint64_t whom = random();
  const std::uint64_t value = random() % 100;
  if (all.empty() || kind < 3) {
    registry.add_patient(kOwner, example_patient(fmt::format("P{:03}", step)));
    return;
  }
  Patient patient = all[whom % all.size()];
  switch (kind) {
    case 3:
    case 4:
    case 5:
      registry.add_result(kOwner, patient.record,
                          example_result(fmt::format("{}.mcap.enc", step), 1, static_cast<double>(value)));
      return;
    case 6:
      registry.add_test(kOwner, patient.record,
                        {.kind = TestKind::kGrip,
                         .value = static_cast<double>(value),
                         .side = TestSide::kMoreAffected,
                         .date = "2026-05-04",
                         .rater = "A",
                         .note = {}});
      return;
    case 7:
      registry.add_note(kOwner, patient.record, fmt::format("note {}", step));
      return;
    case 8:
      patient.note = fmt::format("changed {}", step);
      registry.edit_patient(kOwner, patient);
      return;
    case 9:
      registry.delete_patient(kOwner, patient.record);
      return;
    case 10:
      registry.export_patient(kOwner, patient.record, files.path(fmt::format("export{}", step)));
      return;
    default:
      if (value % 2 == 0) {
        registry.rebuild(kOwner, {}, no_results);
      } else {
        registry.backup(kOwner, files.path(fmt::format("backup{}", step)));
      }
  }
}

constexpr std::uint64_t kSteps = 12;

void change_all(RegistryFiles& files, std::uint64_t seed,
                const std::function<void(Registry&, std::uint64_t)>& after) {
  std::mt19937_64 random(seed);
  Registry registry = files.open();
  for (std::uint64_t step = 0; step < kSteps; ++step) {
    change(registry, files, random, step);
    after(registry, step);
  }
}

/// Runs the sequence in a process that dies at a call. @returns true if it was killed
bool run_and_kill(RegistryFiles& files, std::uint64_t seed, std::uint64_t call, Told& told) {
  const pid_t child = ::fork();
  if (child == 0) {
    testing::kill_at_call(call);
    try {
      change_all(files, seed, [&](Registry&, std::uint64_t step) { told.done = step + 1; });
    } catch (...) {
      told.failed = true;
    }
    told.calls = testing::counted_calls();
    ::_exit(0);
  }
  int status = 0;
  EXPECT_EQ(::waitpid(child, &status, 0), child);
  return WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL;
}

/// @returns the states after 0, 1, ... operations of a sequence
std::vector<std::string> states_of(std::uint64_t seed) {
  RegistryFiles files;
  std::vector<std::string> out = {""};
  change_all(files, seed, [&](Registry& registry, std::uint64_t) { out.push_back(state_text(registry)); });
  return out;
}

std::uint64_t calls_of(std::uint64_t seed) {
  RegistryFiles files;
  SharedTold told;
  EXPECT_FALSE(run_and_kill(files, seed, 0, *told));
  EXPECT_FALSE(told->failed) << "the sequence itself fails";
  EXPECT_EQ(told->done, kSteps);
  return told->calls;
}

void expect_invariants(RegistryFiles& files, const std::vector<std::string>& states, std::uint64_t done) {
  std::string state;
  {
    Registry registry = files.open();
    state = state_text(registry);
    EXPECT_TRUE(state == states.at(done) || (done + 1 < states.size() && state == states[done + 1]))
        << "after " << done << " operations:\n"
        << state << "instead of\n"
        << states.at(done);
    const AuditCheck check = registry.check_audit(kOwner);
    EXPECT_TRUE(check.whole) << check.text;
    EXPECT_GE(check.lines, 2 * done) << "each operation lists all patients first";
    registry.rebuild(kOwner, {}, no_results);
    EXPECT_EQ(state_text(registry), state) << "rebuilt";
  }
  for (const char* name : {"registry.sqlite", "registry.sqlite-wal", "registry.sqlite-shm"})
    std::filesystem::remove(files.data() / name);
  Registry registry = files.open();
  EXPECT_EQ(state_text(registry), state) << "from the journal alone";
  for (const std::string& id : files.keys().erased_ids())
    EXPECT_FALSE(std::filesystem::exists(files.data() / "journal" / id)) << "a deleted patient's journal";
  for (const char* folder : {"data", "config"})
    EXPECT_EQ(testing::open_to_others(files.path(folder)), std::vector<std::string>{});
  const Patient added = registry.add_patient(kOwner, example_patient("LAST"));
  EXPECT_TRUE(registry.add_result(kOwner, added.record, example_result("last.mcap"))) << "it goes on";
}

void kill_many(std::uint64_t first_seed, std::uint64_t seeds, std::uint64_t kills) {
  for (std::uint64_t seed = first_seed; seed < first_seed + seeds; ++seed) {
    const std::vector<std::string> states = states_of(seed);
    const std::uint64_t calls = calls_of(seed);
    ASSERT_GT(calls, 100U);
    std::mt19937_64 random(seed + 1000);
    for (std::uint64_t i = 0; i < kills / seeds; ++i) {
      const std::uint64_t call = 1 + random() % calls;
      SCOPED_TRACE(fmt::format("seed {}, killed at call {} of about {}", seed, call, calls));
      RegistryFiles files;
      SharedTold told;
      static_cast<void>(run_and_kill(files, seed, call, *told));
      EXPECT_FALSE(told->failed);
      expect_invariants(files, states, told->done);
      if (::testing::Test::HasFailure()) return;
    }
  }
}

TEST(RegistryKills, KeepAllInvariantsTwentyTimes) { kill_many(1, 2, 20); }

TEST(FullRegistryKills, KeepAllInvariantsHundredsOfTimes) {
  if (test::kSlowBuild)
    kill_many(100, 4, 100);
  else
    kill_many(100, 20, 500);
}

TEST(RegistryKills, KeepADeletionThatBegan) {
  const std::string code = "ZQ7X4K-KILL";
  const auto filled = [&](RegistryFiles& files) {
    Registry registry = files.open();
    registry.add_patient(kOwner, example_patient("P01"));
    const std::string record = registry.add_patient(kOwner, example_patient(code)).record;
    registry.add_result(kOwner, record, example_result("a.mcap.enc"));
    registry.export_patient(kOwner, record, files.path("export"));
    return record;
  };
  std::mt19937_64 random(7);
  for (std::uint64_t call = 1 + random() % 8, killed = 1; killed != 0; call += 8) {
    RegistryFiles files;
    const std::string record = filled(files);
    const pid_t child = ::fork();
    if (child == 0) {
      Registry registry = files.open();
      testing::kill_at_call(call);
      registry.delete_patient(kOwner, record);
      ::_exit(0);
    }
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    killed = WIFSIGNALED(status) ? 1 : 0;
    SCOPED_TRACE(fmt::format("killed at call {}", call));
    Registry registry = files.open();
    const bool lives = files.keys().find(record).has_value();
    EXPECT_EQ(registry.patients(kOwner).size(), lives ? 2U : 1U);
    EXPECT_EQ(registry.patients_without_key(kOwner), std::vector<std::string>{}) << "no row is left";
    if (lives) {
      EXPECT_EQ(registry.results(kOwner, record).size(), 1U);
      registry.delete_patient(kOwner, record);
    }
    EXPECT_EQ(testing::files_with(files.path("data"), code), std::vector<std::string>{});
    EXPECT_EQ(testing::files_with(files.path("config"), code), std::vector<std::string>{});
    EXPECT_TRUE(registry.check_audit(kOwner).whole);
  }
}

TEST(RegistryKills, FourProgramsAtOnceLoseNothing) {
  constexpr std::uint64_t kPrograms = 4;
  constexpr std::uint64_t kNotes = 10;
  RegistryFiles files;
  const std::string record = files.open().add_patient(kOwner, example_patient()).record;
  std::vector<pid_t> children;
  for (std::uint64_t program = 0; program < kPrograms; ++program) {
    children.push_back(::fork());
    if (children.back() != 0) continue;
    try {
      Registry registry = files.open();
      for (std::uint64_t i = 0; i < kNotes; ++i) {
        registry.add_note(kOwner, record, fmt::format("{} {}", program, i));
        registry.add_result(kOwner, record, example_result(fmt::format("{}.mcap.enc", i)));
      }
      registry.add_patient(kOwner, example_patient(fmt::format("P{}", program)));
    } catch (...) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  for (const pid_t child : children) {
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
  }
  Registry registry = files.open();
  EXPECT_EQ(registry.notes(kOwner, record).size(), kPrograms * kNotes);
  EXPECT_EQ(registry.results(kOwner, record).size(), kNotes) << "a result that several programs add is one";
  EXPECT_EQ(registry.patients(kOwner).size(), 1 + kPrograms);
  EXPECT_TRUE(registry.check_audit(kOwner).whole) << registry.check_audit(kOwner).text;
}

using Operation = std::function<void(Registry&, const std::string& record, std::uint64_t number)>;

/// Lets each system call of an operation fail once. A failed operation must have changed nothing, also later.
void fail_at_each_call(const Operation& operation) {
  RegistryFiles files;
  const std::string record = files.open().add_patient(kOwner, example_patient()).record;
  std::uint64_t failures = 0;
  for (std::uint64_t call = 1;; ++call) {
    ASSERT_LT(call, 1000U);
    SCOPED_TRACE(fmt::format("the failing call is number {}", call));
    Registry registry = files.open();
    const std::string before = state_text(registry);
    bool failed = false;
    testing::fail_at_call(call);
    try {
      operation(registry, record, call);
    } catch (const RegistryError&) {
      failed = true;
    }
    const bool all_calls = testing::counted_calls() < call;
    testing::fail_at_call(0);
    EXPECT_EQ(state_text(registry) == before, failed) << "in the same program";
    Registry again = files.open();
    EXPECT_EQ(state_text(again) == before, failed) << "in the next one";
    EXPECT_TRUE(again.check_audit(kOwner).whole) << again.check_audit(kOwner).text;
    EXPECT_EQ(again.patients_without_key(kOwner), std::vector<std::string>{});
    failures += failed ? 1U : 0U;
    if (all_calls || ::testing::Test::HasFailure()) break;
  }
  EXPECT_GE(failures, 5U);
}

TEST(RegistryFullDisk, ChangesNothingByANoteThatFails) {
  fail_at_each_call([](Registry& registry, const std::string& record, std::uint64_t number) {
    registry.add_note(kOwner, record, fmt::format("note {}", number));
  });
}

TEST(RegistryFullDisk, ChangesNothingByAResultThatFails) {
  fail_at_each_call([](Registry& registry, const std::string& record, std::uint64_t number) {
    registry.add_result(kOwner, record, example_result(fmt::format("{}.mcap.enc", number)));
  });
}

TEST(RegistryFullDisk, ChangesNothingByAnEditThatFails) {
  fail_at_each_call([](Registry& registry, const std::string& record, std::uint64_t number) {
    Patient patient = registry.patient(kOwner, record);
    patient.note = fmt::format("edit {}", number);
    registry.edit_patient(kOwner, patient);
  });
}

TEST(RegistryFullDisk, ChangesNothingByAPatientWhoCannotBeAdded) {
  fail_at_each_call([](Registry& registry, const std::string&, std::uint64_t number) {
    registry.add_patient(kOwner, example_patient(fmt::format("Q{}", number)));
  });
}

/// link() fails for the lifetime of this object.
class WithoutLinks {
 public:
  WithoutLinks() { testing::refuse_links(true); }
  ~WithoutLinks() { testing::refuse_links(false); }
  WithoutLinks(const WithoutLinks&) = delete;
  WithoutLinks& operator=(const WithoutLinks&) = delete;
};

// A program that had the file open, or a tool that reads the free blocks of the disk, finds the old bytes otherwise.
TEST(RegistryWithoutHardLinks, OverwritesTheBytesOfAReplacedFile) {
  RegistryFiles files;
  const std::filesystem::path file = files.keys_file().parent_path() / "replaced";
  std::filesystem::create_directories(file.parent_path());
  const std::string before = "the old content, which must not stay on the disk";
  registry::replace_private_file(file, before, true);
  const registry::Descriptor old(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  ASSERT_TRUE(old.valid());
  {
    const WithoutLinks refused;
    ASSERT_NE(::link(file.c_str(), files.path("link").c_str()), 0);
    registry::replace_private_file(file, "the new content", true);
  }
  EXPECT_EQ(registry::read_private_file(file), "the new content");
  std::string bytes(before.size(), '\0');
  ASSERT_EQ(::pread(old.number(), bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  EXPECT_EQ(bytes.find("content"), std::string::npos) << bytes;
  for (const char* name : {"replaced.old", "replaced.new"})
    EXPECT_FALSE(std::filesystem::exists(file.parent_path() / name)) << name;
}

TEST(RegistryWithoutHardLinks, DeletesAPatientAndKeepsTheOthers) {
  RegistryFiles files;
  const std::string record = files.open().add_patient(kOwner, example_patient()).record;
  {
    const WithoutLinks refused;
    Registry registry = files.open();
    const std::string other = registry.add_patient(kOwner, example_patient("Q2")).record;
    registry.delete_patient(kOwner, record);
    EXPECT_EQ(registry.patient(kOwner, other).code, "Q2");
    EXPECT_THROW(static_cast<void>(registry.patient(kOwner, record)), RegistryError);
  }
  Registry again = files.open();
  EXPECT_EQ(again.patients(kOwner).size(), 1U);
  EXPECT_EQ(again.patients_without_key(kOwner), std::vector<std::string>{});
  EXPECT_TRUE(again.check_audit(kOwner).whole) << again.check_audit(kOwner).text;
}

}  // namespace
}  // namespace phalanx
