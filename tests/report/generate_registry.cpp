// SPDX-License-Identifier: Apache-2.0
// Writes a registry with a generated patient, to look at reports and to measure them:
//   generate_registry DATA_FOLDER KEY_FILE [SESSIONS]
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <filesystem>

#include "report/generated_patient.h"

int main(int argc, char** argv) {
  using namespace phalanx;
  if (argc < 3) {
    fmt::print(stderr, "usage: generate_registry DATA_FOLDER KEY_FILE [SESSIONS]\n");
    return 2;
  }
  try {
    const int sessions = argc > 3 ? std::atoi(argv[3]) : 200;
    const std::filesystem::path keys = argv[2];
    Registry registry({.folder = argv[1]},
                      std::filesystem::exists(keys) ? KeyStore::open(keys) : KeyStore::create(keys));
    fmt::print("{}\n", testing::add_generated(registry, testing::generated_patient(sessions, 7)));
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
  return 0;
}
