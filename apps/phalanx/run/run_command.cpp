// SPDX-License-Identifier: Apache-2.0
// phalanx run [SCENE]: runs the station.
#include <fmt/format.h>

#include <memory>
#include <string>
#include <utility>

#include "commands.h"
#include "patient/registry_options.h"
#include "phalanx/mesh/isolation/isolation_helper.h"
#include "retention_options.h"
#include "run/run_options.h"
#include "run/run_page.h"
#include "run/run_registry.h"
#include "run/run_station.h"
#include "terminal/end_signals.h"
#include "usage.h"

namespace phalanx {

void add_run_command(CLI::App& app, Job& job) {
  auto options = std::make_shared<RunOptions>();
  CLI::App* run = app.add_subcommand(
      "run",
      "The station: device, hand and scene in real time, with the simulated device if there is no other");
  run->add_option("scene", options->scene,
                  fmt::format("a scene's name or file [{}; {} with a device]", RunOptions::kDemonstration,
                              RunOptions::kGrasp));
  run->add_option("--device", options->device,
                  "simulated, sliders, udp:HOST:PORT, serial:PORT[:BAUD] or opengloves:PORT[:BAUD]")
      ->capture_default_str();
  run->add_option("--calibration", options->calibration,
                  "the device's calibration file (phalanx device calibrate)");
  run->add_option("--range", options->range,
                  "the patient's own range of motion (phalanx device range); no torque pushes beyond it");
  run->add_option("--seconds", options->seconds, "end after so long; else with Ctrl-C")->check(positive());
  run->add_option("--rate-hz", options->rate_hz, "the loop's rate, 200 .. 2000 Hz; else the scene's");
  run->add_option("--profile", options->profile, "the patient's hand: a profile's name or file");
  run->add_option("--object", options->object,
                  "a mesh in place of the scene's objects: .obj .3ds .stl .ply .glb");
  run->add_option("--object-size-mm", options->object_size_mm,
                  "its largest extent; without it the file's numbers are metres")
      ->check(CLI::Range(0.0, 2000.0));
  run->add_option("--set", options->set, "a scene's key: KEY=VALUE; may be repeated")
      ->allow_extra_args(false);
  run->add_option("--clinician", options->clinician,
                  "who answers for a fingertip force above 5 N (up to 10 N)");
  CLI::Option* watchdog = run->add_option(
      "--watchdog-ms", options->watchdog_ms,
      "a glove's firmware ends its forces so long after this program's last message [1 .. 1000]");
  run->add_flag("--no-force-feedback", options->no_force_feedback,
                "the glove only senses: it is never told to hold a finger")
      ->excludes(watchdog);
  run->add_option("--record", options->recordings,
                  "folder of the recordings, a file each run (docs/recording.md); off: none")
      ->capture_default_str();
  run->add_flag("--no-foxglove", options->no_foxglove,
                "recordings without the 3D scene for tools that read Foxglove's schemas");
  run->add_option("--record-quota-gb", options->record_quota_gb,
                  "room for all recordings of the folder: above it, no run begins [none]")
      ->check(number_up_to(1e6));
  add_retention(*run, options->record_keep_days, options->record_keep_gb, "--record-keep-");
  CLI::Option* markers =
      run->add_option("--marker-port", options->marker_port,
                      "UDP port for markers of other programs: each datagram is a text in the recording")
          ->check(CLI::Range(1, 65535));
  run->add_option("--marker-listen", options->marker_address,
                  "address of the marker port; any but 127.0.0.1 lets other computers reach it")
      ->needs(markers)
      ->capture_default_str();
  run->add_option("--log", options->log, "write every step to this CSV file");
  run->add_option("--summary", options->summary, "write percentiles and counts to this JSON file at the end");
  run->add_option("--fault-reports", options->faults, "folder of the fault reports")->capture_default_str();
  run->add_option("--priority", options->priority, "of SCHED_FIFO")
      ->check(CLI::Range(1, 99))
      ->capture_default_str();
  run->add_option("--cpu", options->cpu, "keep the loop on this CPU")->check(CLI::NonNegativeNumber);
  run->add_option("--slow-motion", options->slow_motion,
                  "run everything so many times slower, time limits included")
      ->check(CLI::Range(1.0, 1000.0));
  run->add_flag("--no-realtime", options->no_realtime, "do not ask for SCHED_FIFO and locked memory");
  run->add_flag("--headless", options->headless, "no page");
  run->add_option("--listen", options->listen, "address of the page; any but this machine's own needs TLS")
      ->capture_default_str();
  CLI::Option* port =
      run->add_option("--port", options->port, "of the page; 0: any; else the next free one from 8480")
          ->check(CLI::Range(0, 65535));
  run->add_option("--tls-cert", options->certificate,
                  "the page's certificate (PEM); else one of its own is made");
  run->add_option("--tls-key", options->key, "its key (PEM)");
  run->add_option("--data", options->data,
                  "data folder of the patients: the page people.html shows them (docs/patients.md) [none]")
      ->type_name("DIR");
  run->add_option("--keys", options->keys,
                  "file with the patients' keys, with --data [$PHALANX_KEYS, else ~/.config/phalanx/keys]")
      ->type_name("FILE");
  run->add_option("--stable-n-per-mm", options->stable_n_per_mm,
                  "largest stiffness at which this device is stable with an exercise's scene, as measured "
                  "(docs/stability.md); feel_and_find needs it")
      ->check(positive())
      ->type_name("K");
  run->add_option("--audit", options->audit, "every change made in the page, a JSON line each")
      ->capture_default_str();
  run->add_option("--uploads", options->uploads, "folder of the meshes that pages send")
      ->capture_default_str();
  run->add_option("--calibrations", options->calibrations, "folder of what the page's calibration writes")
      ->capture_default_str();
  run->add_option("--ranges", options->ranges, "folder of the ranges of motion that the page measures")
      ->capture_default_str();
  run->add_flag("--quiet", options->quiet, "no status line");
  run->callback([options, run, port, &job] {
    refuse_empty_values(*run);
    options->port_stated = port->count() > 0;
    check_page_options(*options);
    job = [options] {
      end_on_signal();
      const mesh::IsolationHelper helper;  // before there are threads, while memory is small
      std::shared_ptr<Registry> registry;
      with_registry_errors([&] { return registry = open_run_registry(*options), 0; });
      const Clock clock(options->slow_motion);
      return run_station(*options, clock, std::move(registry));
    };
  });
}

}  // namespace phalanx
