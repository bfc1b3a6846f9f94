// SPDX-License-Identifier: Apache-2.0
#include "report/generated_patient.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "phalanx/exercise/reasons.h"
#include "report/date_axis.h"

namespace phalanx::testing {
namespace {

constexpr double kFirstMonday = 1'767'600'000.0;  // 2026-01-05, 08:00 UTC
constexpr double kDaySeconds = 86400.0;

Score measured(const std::string& name, const std::string& unit, double value) {
  return {.name = name, .unit = unit, .value = value, .origin = ScoreOrigin::kMeasured, .invalid = {}};
}
Score rendered(const std::string& name, const std::string& unit, double value) {
  return {.name = name, .unit = unit, .value = value, .origin = ScoreOrigin::kRendered, .invalid = {}};
}

/// Generator of one patient.
class Maker {
 public:
  Maker(int sessions, std::uint64_t seed) : sessions_(sessions), random_(seed) {}

  GeneratedPatient make() {
    make_patient();
    for (int session = 0; session < sessions_; ++session) {
      date_ = kFirstMonday + kDaySeconds * (7.0 * (session / 5) + session % 5) + noise(1800.0);
      learned_ = 1.0 - std::exp(-session / (0.4 * sessions_ + 1.0));
      share_ = static_cast<double>(session) / sessions_;
      if (session % 10 == 0) add_assessments();
      add_training("train_press", 30);
      add_training("train_pinch", 24);
      add_training("train_opposition", 20);
      if (session % 20 == 0) add_tests();
      if (session % 17 == 3)
        made_.notes.push_back(
            {.date = date_ + 1500.0,
             .account = "owner",
             .text = fmt::format("session {}: hand is warm,\nswelling < before", session + 1)});
    }
    return std::move(made_);
  }

 private:
  double noise(double size) { return std::normal_distribution<>(0.0, size)(random_); }
  bool happens(double probability) { return std::bernoulli_distribution(probability)(random_); }

  void make_patient() {
    Patient& patient = made_.patient;
    patient.code = "SIM07";
    patient.symbol = "tree";
    patient.side = Handedness::kRight;
    patient.calibration_device = "beihang";
    patient.calibration_serial = "0001";
    patient.calibration_method = "jig";
    patient.calibration_expires = "2026-12-31";
    patient.own_force_n = {8.25, 9.5, 7.75, 0.0, 3.0};
    patient.force_limit_n = 3.5;
    patient.stiffness_limit_n_per_mm = 1.03125;
    patient.torque_limit_nm = 0.21875;
    patient.warnings = {"tires quickly", "cold hand: warm it first"};
    PrescribedExercise press;
    press.exercise = "train_press";
    press.repetitions_per_day = 40;
    press.minutes_per_day = 10.0;
    PrescribedExercise pinch;
    pinch.exercise = "train_pinch";
    pinch.minutes_per_day = 7.5;
    pinch.overrides = {{"pain_limit", "4"}};
    patient.prescription = {press, pinch};
    patient.consent = true;
    patient.consent_date = "2026-01-05";
    patient.entry =
        EntryCheck{.flexion_deg = 61.5, .release_deg = 44.25, .date = "2026-01-05", .suitable = true};
    patient.note = "dominant hand & \"affected\" side";
  }

  ResultRow row_of(const char* exercise, bool assessment, double seconds, int trials) {
    ResultRow row;
    row.recording = fmt::format("{:06}-{}.mcap.enc", ++recordings_, exercise);
    row.exercise = exercise;
    row.assessment = assessment;
    row.date = std::floor(date_);
    row.seconds = seconds + std::abs(noise(10.0));
    row.repetitions = trials;
    row.conditions = {.device = "beihang (simulated participant)",
                      .serial = "0001",
                      .calibration_method = share_ < 0.6 ? "jig" : "goniometer+jig",
                      .contact_mode = "sliding",
                      .stabiliser = "smoothing",
                      .rendering = "1",
                      .protocol = assessment ? "3f0c9a2b7d1e4856" : ""};
    date_ += row.seconds + 60.0;
    return row;
  }

  /// Adds a rating before the last trial, which may be the largest, and one at the end: the row's.
  void add_ratings(nlohmann::ordered_json& detail, const ResultRow& row, GeneratedDetail& truth) {
    truth.pain = std::min(10, row.pain + (happens(0.3) ? 3 : 0));
    truth.fatigue = std::min(10, row.fatigue + (happens(0.2) ? 1 : 0));
    const auto add = [&](double time, const char* kind, int value) {
      detail["ratings"].push_back({{"time_s", time}, {"kind", kind}, {"value", value}});
    };
    add(200.0, "pain", truth.pain);
    add(201.0, "fatigue", truth.fatigue);
    add(330.0, "pain", row.pain);
    add(331.0, "fatigue", row.fatigue);
  }

  void finish(ResultRow row) {
    if (happens(0.02)) {
      row.interrupted = true;
    } else if (happens(0.01)) {
      row.valid = false;
      row.invalid = reason_text<Reason::kStepsMissingInRecording>(12);
      row.scores.clear();
    }
    nlohmann::ordered_json detail = {{"name", row.exercise},
                                     {"ended", row.interrupted ? reason_text<Reason::kPersonEnded>()
                                                               : reason_text<Reason::kAllTrialsDone>()},
                                     {"ratings", nlohmann::ordered_json::array()},
                                     {"trials", nlohmann::ordered_json::array()}};
    GeneratedDetail truth{.counted = row.repetitions, .pain = row.pain, .fatigue = row.fatigue};
    if (row.pain >= 0) add_ratings(detail, row, truth);
    for (int trial = 1; trial <= row.repetitions; ++trial) {
      nlohmann::ordered_json one = {
          {"number", trial}, {"begin_s", 30.0 + 10.0 * trial}, {"end_s", 36.0 + 10.0 * trial}};
      for (const Score& score : row.scores)
        one["scores"].push_back({{"name", score.name},
                                 {"unit", score.unit},
                                 {"value", score.value + noise(0.1)},
                                 {"origin", "rendered"}});
      if (happens(0.005)) {
        one["invalid"] = reason_text<Reason::kNoSample>();
        --truth.counted;
        ++truth.unscored;
      }
      detail["trials"].push_back(std::move(one));
    }
    if (!row.assessment) {
      if (happens(0.3)) --truth.counted;  // the last trial was paused
      row.successes = std::min(row.successes, truth.counted);
      detail["counted"] = truth.counted;
    }
    row.detail = detail.dump();
    made_.details[row.recording] = truth;
    made_.results.push_back(std::move(row));
  }

  void add_training(const char* exercise, int trials) {
    ResultRow row = row_of(exercise, false, 330.0, trials);
    difficulty_[exercise] = std::clamp(0.25 + 0.55 * learned_ + noise(0.03), 0.0, 1.0);
    row.difficulty = difficulty_[exercise];
    row.successes = std::binomial_distribution<>(trials, std::clamp(0.7 + noise(0.06), 0.0, 1.0))(random_);
    row.pain = happens(0.1) ? 2 : 0;
    row.fatigue = 2 + static_cast<int>(3.0 * std::abs(noise(0.6)));
    row.scores = {measured("time_in_target_share", "-", 0.55 + noise(0.08)),
                  rendered("mean_force_n", "N", 2.0 + learned_ + noise(0.2))};
    finish(std::move(row));
  }

  void add_force_assessments() {
    ResultRow own = row_of("own_force", true, 150.0, 15);
    for (const char* digit : {"thumb", "index", "middle", "little"})
      own.scores.push_back(
          rendered(fmt::format("{}_peak_force_n", digit), "N", 4.0 + 4.0 * learned_ + noise(0.5)));
    own.scores.push_back({.name = "ring_peak_force_n",
                          .unit = "N",
                          .invalid = reason_text<Reason::kNoForceOfDigitAlone>("ring")});
    finish(std::move(own));
    ResultRow press = row_of("press_and_hold", true, 80.0, 5);
    press.scores = {rendered("mean_force_n", "N", 2.0 + 1.5 * learned_ + noise(0.1)),
                    rendered("cv", "-", 0.2 - 0.1 * learned_ + noise(0.01)),
                    rendered("time_in_target_share", "-", 0.4 + 0.3 * learned_ + noise(0.05))};
    finish(std::move(press));
  }

  void add_assessments() {
    add_force_assessments();
    ResultRow range = row_of("range_of_motion", true, 60.0, 3);
    for (const char* digit : {"index", "middle", "little"})
      for (const char* joint : {"mcp_flexion", "pip_flexion"}) {
        const double least = 12.0 - 6.0 * learned_ + noise(1.0);
        const double most = 55.0 + 20.0 * learned_ + noise(2.0);
        const std::string name = fmt::format("{}_{}_deg", digit, joint);
        range.scores.push_back(measured("min_" + name, "deg", least));
        range.scores.push_back(measured("max_" + name, "deg", most));
        range.scores.push_back(measured("rom_" + name, "deg", most - least));
      }
    finish(std::move(range));
    ResultRow touch = row_of("opposition", true, 72.0, 8);
    for (const char* finger : {"index", "middle", "ring", "little"})
      touch.scores.push_back(measured(fmt::format("opposition_{}_mm", finger), "mm",
                                      35.0 - 20.0 * learned_ + std::abs(noise(3.0))));
    for (const char* finger : {"index", "middle", "ring", "little"})
      touch.scores.push_back(measured(fmt::format("opposition_held_{}_mm", finger), "mm",
                                      40.0 - 20.0 * learned_ + std::abs(noise(3.0))));
    finish(std::move(touch));
  }

  void add_tests() {
    const std::string day = report::iso_day(date_);
    const auto add = [&](TestKind kind, double value, TestSide side) {
      made_.tests.push_back(
          {.kind = kind, .value = std::round(value), .side = side, .date = day, .rater = "AB", .note = {}});
    };
    add(TestKind::kBoxAndBlock, 18.0 + 14.0 * learned_ + noise(1.0), TestSide::kMoreAffected);
    add(TestKind::kBoxAndBlock, 58.0 + noise(1.0), TestSide::kLessAffected);
    add(TestKind::kGrip, 9.0 + 2.0 * learned_ + noise(0.3), TestSide::kMoreAffected);
    add(TestKind::kNineHolePeg, 90.0 - 30.0 * learned_ + noise(2.0), TestSide::kMoreAffected);
    add(TestKind::kFuglMeyerHand, std::min(14.0, 6.0 + 5.0 * learned_), TestSide::kMoreAffected);
  }

  int sessions_;
  std::mt19937_64 random_;
  GeneratedPatient made_ = {};
  double date_ = 0.0;
  double learned_ = 0.0;
  double share_ = 0.0;
  int recordings_ = 0;
  std::map<std::string, double> difficulty_ = {};
};

}  // namespace

GeneratedPatient generated_patient(int sessions, std::uint64_t seed) { return Maker(sessions, seed).make(); }

std::string add_generated(Registry& registry, const GeneratedPatient& made) {
  const Actor owner = Actor::owner();
  const std::string record = registry.add_patient(owner, made.patient).record;
  for (const ResultRow& row : made.results) registry.add_result(owner, record, row);
  for (const EnteredTest& test : made.tests) registry.add_test(owner, record, test);
  for (const PatientNote& note : made.notes) registry.add_note(owner, record, note.text);
  return record;
}

}  // namespace phalanx::testing
