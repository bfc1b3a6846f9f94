// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace phalanx::bench {

struct Options {
  std::vector<std::string> scenes = {"bench_ball_1k", "bench_ball_10k", "bench_ball_100k",
                                     "bench_mug_1k",  "bench_mug_10k",  "bench_mug_100k"};
  int grasps = 20;  ///< a scene, beside the one squeeze
  bool peers = true;
  bool cold = true;
  bool large = true;                   ///< build the object of a million triangles
  bool record = false;                 ///< write this run's hashes to expected_hashes.txt
  int cold_every = 10;                 ///< ticks from one flush of the caches to the next
  int naive_every = 10;                ///< ticks from one that naive FCL runs to the next
  std::string recordings;              ///< folder of recorded motions; empty: the scenes are run
  std::string meshes;                  ///< folder of the objects before them
  std::string mapping = "cyberglove";  ///< of the recordings' columns to joint angles
  bool sliding = false;                ///< contacts slide; no peers then
  double friction = 0.6;               ///< of contacts that slide [-]
  double seconds = 0.0;                ///< greatest length of a recording [s]; 0: all of it
  std::string json;                    ///< file to write; empty: none
  std::string markdown;                ///< file to write; empty: none
};

/// @param exit_code  set if the program is to end here: --help, or a wrong option, which has been answered
/// @returns whether to go on
[[nodiscard]] bool parse_options(int argc, char** argv, Options& options, int& exit_code);

}  // namespace phalanx::bench
