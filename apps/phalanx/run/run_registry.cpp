// SPDX-License-Identifier: Apache-2.0
#include "run/run_registry.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "patient/registry_options.h"
#include "phalanx/scene/exercise_file.h"

namespace phalanx {
namespace {

bool file_exists(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::exists(file, ignored);
}

KeyStore run_key_store(const RegistryOptions& registry, bool is_new) {
  const std::filesystem::path keys = keys_file_of(registry);
  if (!is_new || file_exists(keys)) return open_key_store(registry);
  const char* passphrase = std::getenv("PHALANX_PASSPHRASE");
  KeyStore store = KeyStore::create(keys, passphrase == nullptr ? "" : passphrase);
  fmt::print(stderr, "new key file: {}; keep a copy apart from the backups (docs/patients.md)\n",
             keys.string());
  return store;
}

}  // namespace

std::shared_ptr<Registry> open_run_registry(const RunOptions& options) {
  if (options.data.empty() && options.keys.empty()) return nullptr;
  if (options.data.empty())
    throw std::invalid_argument(
        fmt::format("--keys {}: add --data FOLDER, whose patients the keys belong to", options.keys));
  const RegistryOptions registry{.data = options.data, .keys = options.keys, .account = {}};
  const std::filesystem::path folder = data_folder_of(registry);
  check_places(folder, keys_file_of(registry));
  const bool is_new = !file_exists(folder / "registry.sqlite") && !file_exists(folder / "journal");
  RegistrySettings settings;
  settings.folder = folder;
  auto opened = std::make_shared<Registry>(settings, run_key_store(registry, is_new));
  if (is_new) fmt::print(stderr, "new registry of patients: {}\n", folder.string());
  return opened;
}

std::shared_ptr<StationExercises> exercises_of_run(
    const RunOptions& options, Session& session, RunRecorder& recorder, std::shared_ptr<Registry> registry,
    std::function<void(const std::string& text, bool warning)> say) {
  const auto recording = recorder_settings(options);
  if (!registry || !recording) return nullptr;
  StationExercisesSettings settings;
  settings.recording = *recording;
  if (options.rate_hz) settings.overrides.emplace_back("rate_hz", fmt::format("{:.17g}", *options.rate_hz));
  settings.clinician = options.clinician;
  if (options.stable_n_per_mm) settings.stable_stiffness = 1e3 * *options.stable_n_per_mm;
  settings.plain_log = options.log;
  settings.say = std::move(say);
  return std::make_shared<StationExercises>(session, recorder, std::move(registry), std::move(settings));
}

std::vector<ListedExercise> exercises_for_pages() {
  std::vector<ListedExercise> listed;
  try {
    for (const ExerciseInfo& info : list_exercises())
      if (info.readable)
        listed.push_back({.name = info.name,
                          .title = info.title,
                          .title_de = info.exercise.title_de,
                          .kind = std::string(exercise_kind_name(info.exercise.kind)),
                          .measure = std::string(exercise_measure_name(info.exercise.measure))});
  } catch (const SceneError&) {  // the folder is not found: the page lists none
  }
  return listed;
}

}  // namespace phalanx
