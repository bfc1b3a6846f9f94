// SPDX-License-Identifier: Apache-2.0
#include "options.h"

#include <CLI/CLI.hpp>

namespace phalanx::bench {

bool parse_options(int argc, char** argv, Options& options, int& exit_code) {
  CLI::App app{"Times the whole haptic step, and holds it against FCL and brute force. See bench/README.md."};
  app.set_help_flag("--help", "This text");
  CLI::Option* scenes = app.add_option("--scene", options.scenes,
                                       "Scene in scenes/, or a path; may be repeated (default: all six)")
                            ->take_all();
  app.add_option("--motions", options.grasps, "Seeded grasps a scene, beside the squeeze (default 20)")
      ->check(CLI::Range(1, 10000));
  app.add_flag("--peers,!--no-peers", options.peers, "Run FCL and brute force and compare (default)");
  app.add_flag("--cold,!--no-cold", options.cold, "Time steps with flushed caches too (default)");
  app.add_flag("--large,!--no-large", options.large, "Objects of a million triangles too (default)");
  app.add_option("--cold-every", options.cold_every, "Ticks from one flushed step to the next (default 10)")
      ->check(CLI::Range(1, 100000));
  app.add_option("--naive-every", options.naive_every,
                 "Ticks from one that naive FCL runs to the next (default 10)")
      ->check(CLI::Range(1, 100000));
  CLI::Option* record = app.add_flag("--record", options.record,
                                     "Take this run's forces as those that bench/expected_hashes.txt holds");
  CLI::Option* recordings =
      app.add_option("--recordings", options.recordings,
                     "Folder of recorded motions (.csv), in place of the scenes: bench/recordings.md")
          ->check(CLI::ExistingDirectory);
  CLI::Option* meshes =
      app.add_option("--meshes", options.meshes, "Folder of the mesh files that they are run before")
          ->check(CLI::ExistingDirectory);
  recordings->needs(meshes)->excludes(scenes)->excludes(record);
  meshes->needs(recordings);
  app.add_option("--mapping", options.mapping,
                 "How the recordings' columns become joint angles (default cyberglove)")
      ->needs(recordings);
  CLI::Option* sliding =
      app.add_flag("--sliding", options.sliding,
                   "Contacts slide: contact.mode = \"sliding\"; without the peers, whose contacts do not")
          ->excludes(record);
  app.add_option("--friction", options.friction,
                 "Coefficient of the friction of contacts that slide (default 0.6)")
      ->needs(sliding)
      ->check(CLI::Range(0.0, 2.0));
  app.add_option("--seconds", options.seconds, "Greatest length of a recording (default: all of it)")
      ->needs(recordings)
      ->check(CLI::Range(0.01, 1e5));
  app.add_option("--json", options.json, "File for all figures");
  app.add_option("--markdown", options.markdown, "File for the tables");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    exit_code = app.exit(error) == 0 ? 0 : 2;
    return false;
  }
  return true;
}

}  // namespace phalanx::bench
