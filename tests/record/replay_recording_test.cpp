// SPDX-License-Identifier: Apache-2.0
// A station is recorded while everything happens to it, and its recording is played again.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <random>
#include <string>
#include <vector>

#include "phalanx/record/replay.h"
#include "phalanx/record/session_recorder.h"
#include "phalanx/recording.pb.h"
#include "record/mcap/mcap_reader.h"
#include "record/mcap/mcap_repair.h"
#include "record/memory_file.h"
#include "record/recording/topics.h"
#include "record/stored_recording.h"
#include "record/temporary_folder.h"
#include "station/session_fixture.h"

namespace phalanx::test {
namespace {

using ::testing::HasSubstr;

class Recorded : public SessionFixture {
 protected:
  void record(SessionSettings settings) {
    settings.keep_changes = true;
    start(settings);
    auto made = std::make_unique<MemoryFile>([this] { return clock.now(); });
    file = made.get();
    RecorderSettings to{.folder = {}, .least_room = 0, .metadata = recording_metadata("test")};
    if (stored() == Stored::kEncrypted) to.encryption = test_encryption();
    recorder = std::make_unique<SessionRecorder>(std::move(to), *session, clock, "a.mcap", std::move(made));
  }
  void own() override {
    session->poll();
    StepRecord step;
    std::vector<DeviceSample> samples;
    while (session->next_record(step, samples)) {
      records.push_back(step);
      if (!drops(step)) recorder->add(step, samples);
    }
    recorder->update();
    if (auto report = session->take_fault_report()) reports.push_back(std::move(*report));
  }
  virtual bool drops(const StepRecord&) { return false; }
  [[nodiscard]] virtual Stored stored() const { return Stored::kPlain; }
  /// Ends the session and the recording. @returns the file
  std::string finished() {
    session->shut_down();
    own();
    EXPECT_TRUE(recorder->finish());
    return file->content;
  }
  [[nodiscard]] std::filesystem::path on_disk(const std::string& bytes) const {
    const auto name = folder / "recording.mcap";
    std::ofstream(name, std::ios::binary) << bytes;
    return name;
  }

  [[nodiscard]] ReplayResult replayed(const std::string& bytes) const {
    return replay(on_disk(bytes), {}, nullptr, test_keys());
  }
  void lose_power_200_times();
  void delay_each_write();
  void fill_the_disk();

  const testing::TemporaryFolder folder;
  std::unique_ptr<SessionRecorder> recorder;
  MemoryFile* file = nullptr;  ///< of the recorder
};

/// The same, encrypted.
class RecordedEncrypted : public Recorded {
  [[nodiscard]] Stored stored() const override { return Stored::kEncrypted; }
};

/// Calls `change(step)` with each Step, and writes the file again.
template <class Change>
std::string changed(const std::string& bytes, const Change& change) {
  const mcap::ReadableFile file(mcap::InMemory{bytes});
  mcap::McapReader reader(file);
  MemoryFile out;
  mcap::McapWriter writer(out, recording_schemas(), recording_channels(),
                          {{"phalanx", recording_metadata("test")}});
  mcap::Message message;
  while (reader.next(message)) {
    std::string data(message.data);
    if (reader.schema_of(message.channel) == "phalanx.wire.Step") {
      wire::Step step;
      EXPECT_TRUE(step.ParseFromString(data));
      change(step);
      data = step.SerializeAsString();
    }
    writer.add(message.channel, message.time, data);
    if (writer.open_bytes() > 100'000) writer.write_chunk();
  }
  writer.finish();
  return out.content;
}

TEST_F(Recorded, ThroughChangesStopsFaultsAndResetsEveryStepHasTheSameBits) {
  record(with("simulated"));
  ASSERT_TRUE(until_running());
  pass(2.0);
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.3"}}), "");
  pass(0.1);
  EXPECT_EQ(set({{"force.stiffness_n_per_mm", "0.9"}}), "") << "while the change before goes on";
  pass(1.0);
  EXPECT_EQ(set({{"stabiliser.method", "\"smoothing\""}}), "");
  pass(1.0);
  EXPECT_EQ(set({{"force.law", "\"kelvin_voigt\""}}), "") << "at zero torque";
  pass(2.0);
  EXPECT_EQ(set({{"force.law", "\"hooke\""}, {"stabiliser.method", "\"local_wall\""}}), "");
  pass(6.0);
  EXPECT_EQ(set({{"contact.mode", "\"sliding\""}, {"stabiliser.method", "\"smoothing\""}}), "");
  pass(3.0);
  session->stop();
  pass(1.0);
  session->resume();
  pass(2.0);
  overload();
  session->reset();
  ASSERT_TRUE(until_running());
  pass(1.0);
  EXPECT_EQ(load("pinch_ball"), "") << "another station";
  ASSERT_TRUE(until_running());
  pass(2.0);
  EXPECT_EQ(move_by(HandSource::kSliders), "");
  ASSERT_TRUE(until_running());
  JointArray angles = session->sliders();
  for (double& angle : angles) angle += 0.8;
  EXPECT_TRUE(session->set_sliders(angles));
  pass(1.0);
  EXPECT_EQ(set({{"grasp.type", "\"none\""}, {"objects.0.diameter_mm", "40"}}), "") << "another object";
  pass(3.0);
  const std::string bytes = finished();
  const ReplayResult result = replay(on_disk(bytes));
  EXPECT_EQ(result.different, 0U) << result.first->tick << ": " << result.first->what;
  EXPECT_TRUE(result.exact);
  EXPECT_FALSE(result.other_version);
  EXPECT_EQ(result.steps, records.size());
  EXPECT_EQ(result.compared, records.size());
  EXPECT_EQ(result.missing, 0U);
  EXPECT_GE(result.stations, 3U);
  EXPECT_EQ(result.largest_torque, 0.0);
  // The test would show nothing if nothing had happened.
  const auto any = [&](const auto& what) { return std::any_of(records.begin(), records.end(), what); };
  EXPECT_TRUE(any([](const StepRecord& step) { return step.input.exchanged != 0; }));
  EXPECT_TRUE(any([](const StepRecord& step) { return step.input.changed != 0; }));
  EXPECT_TRUE(any([](const StepRecord& step) { return step.state == SafetyState::kFault; }));
  EXPECT_TRUE(any([](const StepRecord& step) { return (step.input.requests & StepRequest::kReset) != 0; }));
  EXPECT_TRUE(any([](const StepRecord& step) { return step.force[1] > 0.5 && step.factor == 1.0; }));
  EXPECT_TRUE(any([](const StepRecord& step) {
    return std::any_of(step.command.wall.begin(), step.command.wall.end(),
                       [](const LocalWall& wall) { return wall.active; });
  }));
}

TEST_F(Recorded, OfADeviceWithLinkagesEveryStepHasTheSameBits) {
  SessionSettings settings = with("simulated");
  settings.overrides = {{"device.file", "\"linkages\""}};
  record(settings);
  ASSERT_TRUE(until_running());
  pass(2.0);
  const std::string bytes = finished();
  const ReplayResult result = replay(on_disk(bytes));
  EXPECT_EQ(result.different, 0U);
  EXPECT_TRUE(result.exact);
  EXPECT_EQ(result.compared, records.size());
  const mcap::ReadableFile whole(mcap::InMemory{bytes});
  mcap::McapReader reader(whole);
  mcap::Message message;
  int linkages = 0;
  while (reader.next(message)) {
    if (reader.schema_of(message.channel) != "phalanx.wire.Setup") continue;
    wire::Setup setup;
    ASSERT_TRUE(setup.ParseFromString(std::string(message.data)));
    for (const wire::Setup::Witness& witness : setup.witness()) linkages += witness.linkage_size();
  }
  EXPECT_EQ(linkages, 2) << "the gate that is made again has the linkages";
}

TEST_F(Recorded, OneFlippedBitOfASampleNamesTheFirstStepAndTheChannel) {
  record(with("simulated"));
  ASSERT_TRUE(until_running());
  pass(2.0);
  const std::string bytes = finished();
  constexpr std::uint64_t kSeed = 22;
  std::mt19937_64 random(kSeed);
  const mcap::ReadableFile whole(mcap::InMemory{bytes});
  for (int i = 0; i < 5; ++i) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", case " + std::to_string(i));
    const std::uint64_t at = 200 + random() % 200;
    int channel = -1;
    const std::string flipped = changed(bytes, [&](wire::Step& step) {
      if (step.tick() != at || step.sample_size() == 0) return;
      auto& raw = *step.mutable_sample(0)->mutable_raw();
      channel = static_cast<int>(random() % static_cast<std::uint64_t>(raw.size()));
      raw[channel] ^= 1 << (random() % 8);
    });
    ASSERT_GE(channel, 0);
    const ReplayResult result = replay(on_disk(flipped));
    ASSERT_TRUE(result.first);
    EXPECT_EQ(result.first->tick, at);
    EXPECT_THAT(result.first->what, HasSubstr("channel " + std::to_string(channel) + " ("));
  }
}

TEST_F(Recorded, AnotherResultIsNamedByTheTorqueThatDiffers) {
  record(with("simulated"));
  ASSERT_TRUE(until_running());
  pass(3.0);
  std::uint64_t at = 0;
  const std::string bytes = finished();
  const std::string other = changed(bytes, [&](wire::Step& step) {
    if (at != 0 || step.torque_size() == 0) return;
    at = step.tick();
    step.set_torque(4, step.torque(4) + 1e-15);
    step.set_hash(step.hash() ^ 1U);
  });
  ASSERT_NE(at, 0U);
  const ReplayResult result = replay(on_disk(other));
  EXPECT_EQ(result.different, 1U);
  ASSERT_TRUE(result.first);
  EXPECT_EQ(result.first->tick, at);
  EXPECT_THAT(result.first->what, HasSubstr("torque of " + std::string(joint_name(4))));
}

class RecordedWithGap : public Recorded {
  bool drops(const StepRecord& step) override { return step.command.tick >= 300 && step.command.tick < 350; }
};

TEST_F(RecordedWithGap, AGapNamesItsStepsAndIsNotCompared) {
  record(with("simulated"));
  ASSERT_TRUE(until_running());
  pass(3.0);
  EXPECT_EQ(recorder->status().lost_steps, 50U);
  const ReplayResult result = replay(on_disk(finished()));
  EXPECT_EQ(result.missing, 50U);
  EXPECT_EQ(result.different, 0U);
  EXPECT_EQ(result.compared, 299U);
  EXPECT_EQ(result.compared + result.not_compared + result.missing, records.size());
}

void Recorded::lose_power_200_times() {
  record(with("simulated"));
  ASSERT_TRUE(until_running());
  pass(6.0);
  static_cast<void>(finished());
  const double begin = records.front().input.time;
  constexpr std::uint64_t kSeed = 200;
  std::mt19937_64 random(kSeed);
  // The first operations are the header's: before them there is no recording.
  const std::size_t header = stored() == Stored::kEncrypted ? 3 : 2;
  for (int i = 0; i < 200; ++i) {
    const std::size_t at = header + random() % (file->operations.size() - header);
    SCOPED_TRACE("seed " + std::to_string(kSeed) + ", case " + std::to_string(i) + ", operation " +
                 std::to_string(at));
    const std::string disk = file->after_power_loss(at, random);
    const mcap::ReadableFile torn(mcap::InMemory{disk}, test_keys(), mcap::Unreadable::kFilled);
    MemoryFile repaired;
    static_cast<void>(mcap::repair(torn, repaired));
    double last = begin;
    const mcap::ReadableFile whole(mcap::InMemory{repaired.content});
    mcap::McapReader reader(whole);
    mcap::Message message;
    std::uint64_t steps = 0;
    wire::Step step;
    while (reader.next(message)) {
      if (reader.schema_of(message.channel) != "phalanx.wire.Step") continue;
      ASSERT_TRUE(step.ParseFromArray(message.data.data(), static_cast<int>(message.data.size())));
      ASSERT_EQ(step.tick(), ++steps) << "no step is missing before the last one";
      last = step.time();
    }
    ASSERT_GE(last, file->operations[at].time - 0.5);
  }
}

TEST_F(Recorded, OfTwoHundredPowerLossesAtMostHalfASecondIsMissing) { lose_power_200_times(); }
TEST_F(RecordedEncrypted, OfTwoHundredPowerLossesAtMostHalfASecondIsMissing) { lose_power_200_times(); }

void Recorded::delay_each_write() {
  record(with("simulated"));
  ASSERT_TRUE(until_running());
  double longest = 0.0;
  file->delay = [&] {
    longest = std::max(longest, recorder->status().unsaved);
    sleep(0.2);
  };
  pass(30.0);
  file->delay = {};
  EXPECT_GT(longest, 0.4) << "a chunk waits for the write and the synchronisation of the one before";
  EXPECT_LT(longest, 1.2);
  EXPECT_EQ(session->view().state, SafetyState::kRunning);
  pass(1.0);
  EXPECT_EQ(recorder->status().lost_steps, 0U);
  const ReplayResult result = replayed(finished());
  EXPECT_EQ(result.compared, records.size());
  EXPECT_EQ(result.different, 0U);
}

TEST_F(Recorded, ADiskThatTakes200MsForEachWriteFor30SecondsLosesNothing) { delay_each_write(); }
TEST_F(RecordedEncrypted, ADiskThatTakes200MsForEachWriteFor30SecondsLosesNothing) { delay_each_write(); }

void Recorded::fill_the_disk() {
  record(with("simulated"));
  ASSERT_TRUE(until_running());
  pass(1.0);
  file->refuses = ENOSPC;
  pass(0.5);
  EXPECT_THAT(recorder->status().trouble, HasSubstr("No space left on device"));
  EXPECT_GT(recorder->status().unsaved, 0.2);
  pass(3.0);
  EXPECT_EQ(session->view().state, SafetyState::kRunning);
  file->refuses = 0;
  pass(1.0);
  EXPECT_EQ(recorder->status().trouble, "");
  EXPECT_LT(recorder->status().unsaved, 0.5);
  EXPECT_EQ(recorder->status().lost_steps, 0U);
  const ReplayResult result = replayed(finished());
  EXPECT_EQ(result.compared, records.size());
  EXPECT_EQ(result.different, 0U);
}

TEST_F(Recorded, WhileTheDiskIsFullTheStationRunsOnAndEverythingIsWrittenLater) { fill_the_disk(); }
TEST_F(RecordedEncrypted, WhileTheDiskIsFullTheStationRunsOnAndEverythingIsWrittenLater) { fill_the_disk(); }

TEST_F(RecordedEncrypted, NothingOfTheSessionIsOnTheDiskAsItIs) {
  record(with("simulated"));
  ASSERT_TRUE(until_running());
  recorder->event("marker", "", "a remarkable word");
  pass(1.0);
  const std::string bytes = finished();
  // Five bytes at least: given four are in random bytes of this size by chance too often.
  for (const char* text : {"MCAP0", "phalanx", "first_touch", "simulated", "remarkable", "/step"})
    EXPECT_EQ(bytes.find(text), std::string::npos) << text;
  EXPECT_EQ(bytes.find(std::string("\4\0\0\0zstd", 8)), std::string::npos) << "a chunk's compression";
  for (const MemoryFile::Operation& operation : file->operations)
    EXPECT_EQ(operation.bytes.find("MCAP0"), std::string::npos);
  const ReplayResult result = replayed(bytes);
  EXPECT_EQ(result.compared, records.size());
  EXPECT_EQ(result.different, 0U);
}

TEST_F(RecordedEncrypted, AFileOfTheFolderIsNamedAsAnEncryptedOne) {
  SessionSettings settings = with("simulated");
  settings.keep_changes = true;
  start(settings);
  SessionRecorder written(
      {.folder = folder.path(), .least_room = 0, .metadata = {}, .encryption = test_encryption()}, *session,
      clock);
  EXPECT_THAT(written.status().file.string(), ::testing::EndsWith("Z.mcap.enc"));
  EXPECT_TRUE(written.finish());
  EXPECT_THAT(testing::read_file(written.status().file), ::testing::StartsWith("\x89PHXE"));
}

}  // namespace
}  // namespace phalanx::test
