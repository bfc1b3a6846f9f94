// SPDX-License-Identifier: Apache-2.0
// recording FOLDER: a session with the simulated device and patient is recorded for 100 steps.
// Then the recording is played through the same code again, and every step is compared to the last bit.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <stdexcept>
#include <vector>

#include "phalanx/record/recordings.h"
#include "phalanx/record/replay.h"
#include "phalanx/record/session_recorder.h"
#include "phalanx/station/session.h"

using namespace phalanx;

namespace {

std::filesystem::path record(const std::filesystem::path& folder) {
  SessionSettings settings;
  settings.scene = "first_touch";
  settings.ask_for_realtime = false;
  settings.keep_changes = true;  // so that the recording has what it needs to be made again
  const Clock clock;
  Session session(settings, clock);
  SessionRecorder recorder({.folder = folder, .metadata = recording_metadata("example")}, session, clock);

  // The loop never waits for the disk: this thread fetches the steps that the loop has left for it.
  StepRecord step;
  std::vector<DeviceSample> samples;
  const auto add_all = [&] {
    while (session.next_record(step, samples)) recorder.add(step, samples);
    recorder.update();
  };
  while (session.view().snapshot.tick < 100) {
    if (clock.now() > 60.0) throw std::runtime_error("100 steps take longer than 60 s");
    clock.sleep_until(clock.now() + 1.0 / 60.0);
    add_all();
  }
  session.shut_down();
  add_all();
  if (!recorder.finish()) throw std::runtime_error(recorder.status().trouble);
  return recorder.status().file;
}

}  // namespace

int main(int argc, char** argv) try {
  const std::filesystem::path file = record(argc > 1 ? argv[1] : "recordings");
  const RecordingSummary summary = summarise_recording(file);
  std::printf("%s: steps of the scene %s\n", file.c_str(), summary.scene.c_str());
  const ReplayResult again = replay(file);
  std::printf("%zu steps recorded, %zu compared, %zu different\n", std::size_t{summary.steps},
              std::size_t{again.compared}, std::size_t{again.different});
  return again.compared > 0 && again.different == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
