// SPDX-License-Identifier: Apache-2.0
// A registry of patients for tests of its page, with clocks that the test advances.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "phalanx/registry/registry.h"

namespace phalanx::test {

inline constexpr double kRegistryUtc = 1'780'000'000.0;  ///< 2026-05-28, 20:26:40 UTC [s]
inline constexpr double kRegistryIdle = 600.0;           ///< [s]

/// Clocks of a registry, which its threads read.
struct RegistryClocks {
  std::atomic<double> utc{kRegistryUtc};
  std::atomic<double> steady{0.0};
};

/// Makes an empty registry with its keys in another folder. Passwords have the least cost.
/// @param clocks  shared with the registry
inline std::shared_ptr<Registry> make_registry(const std::filesystem::path& folder,
                                               const std::shared_ptr<RegistryClocks>& clocks) {
  RegistrySettings settings;
  settings.folder = folder / "data";
  settings.password_cost = Argon2Cost::least();
  settings.idle_lock_s = kRegistryIdle;
  settings.utc = [clocks] { return clocks->utc.load(); };
  settings.steady = [clocks] { return clocks->steady.load(); };
  const std::filesystem::path keys = folder / "config" / "keys";
  return std::make_shared<Registry>(
      settings, std::filesystem::exists(keys) ? KeyStore::open(keys) : KeyStore::create(keys));
}

/// @returns a patient who lacks nothing for an exercise
inline Patient ready_patient(const std::string& code, Handedness side = Handedness::kRight) {
  Patient patient;
  patient.code = code;
  patient.side = side;
  patient.consent = true;
  patient.calibration_expires = "2026-12-31";
  patient.entry =
      EntryCheck{.flexion_deg = 45.0, .release_deg = 30.0, .date = "2026-05-02", .suitable = true};
  return patient;
}

}  // namespace phalanx::test
