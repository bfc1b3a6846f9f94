// SPDX-License-Identifier: Apache-2.0
#include "phalanx/record/station_csv.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>

#include "phalanx/record/made.h"
#include "record/json_by_name.h"

namespace phalanx {
namespace {

using Json = nlohmann::ordered_json;

Json link_json(const LinkStatistics& link) {
  return {{"received", link.received},
          {"lost", link.lost},
          {"outdated", link.outdated},
          {"corrupt", link.corrupt},
          {"refused", link.refused},
          {"overflowed", link.overflowed},
          {"sent", link.sent},
          {"device_corrupt", link.device_corrupt},
          {"device_refused", link.device_refused},
          {"device_outdated", link.device_outdated}};
}

Json histogram_json(const Histogram& histogram) {
  return {{"count", histogram.count()},
          {"p50_us", histogram.percentile_us(50)},
          {"p99_us", histogram.percentile_us(99)},
          {"p999_us", histogram.percentile_us(99.9)},
          {"max_us", histogram.max_us()}};
}

Json report_json(const FaultReport& report) {
  const FaultEvent& event = report.event;
  return {{"fault", fault_name(event.fault)},
          {"meaning", fault_words(event)},
          {"remedy", fault_remedy(event.fault)},
          {"found_by", event.from_device ? "device" : "host"},
          {"channel", event.channel},
          {"host_time_s", event.time},
          {"tick", event.tick},
          {"device", {{"name", report.device.name}, {"serial", report.device.serial}}},
          {"angle_origin", angle_origin_json(report.angle_origin)},
          {"samples", report.samples.size()},
          {"steps", report.steps.size()},
          {"link", link_json(report.link)},
          {"made", {{"commit", built_from_commit()}}}};
}

void write_samples(OutputFile& file, const FaultReport& report) {
  file.text("sequence,time_us,received_s,state,fault,estop,factor,acted_tick");
  const std::size_t channels = report.device.channels.size();
  for (std::size_t c = 0; c < channels; ++c) file.text(fmt::format(",raw_{}", c));
  file.text("\n");
  for (const DeviceSample& sample : report.samples) {
    file.text(fmt::format("{},{},{},{},{},{},{},{}", sample.sequence, sample.time_us, sample.received,
                          static_cast<int>(sample.state), fault_name(sample.fault), sample.estop ? 1 : 0,
                          sample.factor, sample.acted_tick));
    for (std::size_t c = 0; c < channels; ++c) file.text(fmt::format(",{}", sample.raw[c]));
    file.text("\n");
  }
}

/// Makes a folder that did not exist: two faults within a second get separate ones.
std::filesystem::path new_folder(const std::filesystem::path& folder, Fault fault, std::time_t now) {
  prepare_output_folder(folder);
  const std::string name = fmt::format("{:%Y%m%d-%H%M%S}-{}", fmt::localtime(now), fault_name(fault));
  std::filesystem::path path = folder / name;
  for (int i = 2; !std::filesystem::create_directory(path); ++i)
    path = folder / fmt::format("{}-{}", name, i);
  return path;
}

}  // namespace

void write_step_header(OutputFile& file) {
  file.text(
      "tick,time_s,lateness_us,duration_us,overrun,samples,sample_sequence,sample_time_us,state,fault,factor,"
      "status,"
      "stiffness_n_per_m");
  for (int digit = 0; digit < kDigits; ++digit) file.text(fmt::format(",force_n_{}", digit_name(digit)));
  for (int joint = 0; joint < kJoints; ++joint) file.text(fmt::format(",torque_nm_{}", joint_name(joint)));
  for (int joint = 0; joint < kJoints; ++joint) file.text(fmt::format(",angle_rad_{}", joint_name(joint)));
  file.text("\n");
}

/// Writes the whole row or, if memory runs out, none of it.
void write_step(OutputFile& file, const StepRecord& record) {
  std::string row = fmt::format(
      "{},{},{:.1f},{:.1f},{},{},{},{},{},{},{},{},{}", record.command.tick, record.input.time,
      1e6 * record.lateness, 1e6 * record.duration, record.input.late ? 1 : 0, record.samples,
      record.sample_sequence, record.sample_time_us, safety_state_name(record.state),
      fault_name(record.fault), record.factor, static_cast<std::uint32_t>(record.status), record.stiffness);
  const auto add = [&](double value) { fmt::format_to(std::back_inserter(row), ",{}", value); };
  for (const double force : record.force) add(force);
  for (const double torque : record.command.torque) add(torque);
  for (const double angle : record.angle) add(angle);
  row += '\n';
  file.text(row);
}

std::filesystem::path write_fault_report(const std::filesystem::path& folder, const FaultReport& report,
                                         std::time_t now) {
  const std::filesystem::path path = new_folder(folder, report.event.fault, now);
  OutputFile samples(path / "samples.csv");
  write_samples(samples, report);
  samples.commit();
  OutputFile steps(path / "steps.csv");
  write_step_header(steps);
  for (const StepRecord& record : report.steps) write_step(steps, record);
  steps.commit();
  write_text_file(path / "report.json", report_json(report).dump(2) + "\n");
  return path;
}

std::string station_summary_json(const SessionStatistics& session, const StationView& last,
                                 const std::string& granted, double seconds) {
  const DeadlineStatistics& deadlines = session.deadlines;
  const Json json = {{"seconds", seconds},
                     {"steps", deadlines.steps},
                     {"period_us", 1e6 * deadlines.period},
                     {"granted", granted},
                     {"lateness", histogram_json(deadlines.lateness)},
                     {"step", histogram_json(deadlines.step)},
                     {"overruns", deadlines.overruns},
                     {"longest_run_of_overruns", deadlines.longest_run},
                     {"skipped", deadlines.skipped},
                     {"records_lost", session.records_lost},
                     {"state", safety_state_name(last.state)},
                     {"fault", fault_name(last.fault.fault)},
                     {"angle_origin", angle_origin_json(last.snapshot.angle_origin)},
                     {"link", link_json(session.link)},
                     {"made", {{"commit", built_from_commit()}}}};
  return json.dump(2) + "\n";
}

}  // namespace phalanx
