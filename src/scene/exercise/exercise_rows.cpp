// SPDX-License-Identifier: Apache-2.0
#include "scene/exercise/exercise_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "phalanx/core/index.h"
#include "phalanx/core/nearest_name.h"
#include "phalanx/scene/scene_file.h"

namespace phalanx {
namespace {

using Applies = std::function<bool(const ExerciseDescription&)>;
namespace allowed = exercise_ranges;

constexpr double kPerMm = 1e3;  ///< [N/m] in 1 N/mm

NumberRange range_in(NumberRange range, double unit) {
  const auto rounded = [](double value) { return std::round(value * 1e9) / 1e9; };
  range.min = rounded(range.min / unit);
  range.max = rounded(range.max / unit);
  return range;
}

/// Writer of rows.
class Rows {
 public:
  explicit Rows(std::vector<ExerciseRow>& rows) : rows_(rows) {}

  /// A text that is not required and empty is not written.
  void text(const char* path, std::string ExerciseDescription::* field, bool required, const char* meaning) {
    add(
        path, "text", "", "", "", meaning, required, {},
        [field](TomlTable& table, std::string_view name, ExerciseDescription& exercise) {
          exercise.*field = table.text(name);
        },
        [field, required](const ExerciseDescription& exercise) -> std::optional<std::string> {
          if (!required && (exercise.*field).empty()) return std::nullopt;
          return toml_string(exercise.*field);
        });
  }

  /// @param at  makes a pointer to the number
  template <typename At>
  void number(const char* path, const char* unit_name, double unit, const NumberRange& range, At at,
              const char* meaning, Applies applies = {}) {
    const ExerciseDescription defaults;
    const NumberRange shown = range_in(range, unit);
    add(
        path, "number", unit_name, shown.text(), fmt::format("{:.12g}", *at(defaults) / unit), meaning, false,
        std::move(applies),
        [at, unit, shown](TomlTable& table, std::string_view name, ExerciseDescription& exercise) {
          *at(exercise) = table.number(name, shown) * unit;
        },
        [at, unit](const ExerciseDescription& exercise) {
          return std::optional(number_in_unit(*at(exercise), unit));
        });
  }

  template <typename At>
  void integer(const char* path, const NumberRange& range, At at, const char* meaning, Applies applies = {}) {
    const ExerciseDescription defaults;
    add(
        path, "integer", "", range.text(), fmt::format("{}", *at(defaults)), meaning, false,
        std::move(applies),
        [at, range](TomlTable& table, std::string_view name, ExerciseDescription& exercise) {
          const double value = table.number(name, range);
          if (value != std::floor(value)) table.fail(name, "write a whole number");
          *at(exercise) = static_cast<int>(value);
        },
        [at](const ExerciseDescription& exercise) {
          return std::optional(fmt::format("{}", *at(exercise)));
        });
  }

  template <typename At>
  void optional_number(const char* path, const char* unit_name, double unit, const NumberRange& range, At at,
                       const char* meaning) {
    const NumberRange shown = range_in(range, unit);
    add(
        path, "number", unit_name, shown.text(), "", meaning, false, {},
        [at, unit, shown](TomlTable& table, std::string_view name, ExerciseDescription& exercise) {
          *at(exercise) = table.number(name, shown) * unit;
        },
        [at, unit](const ExerciseDescription& exercise) -> std::optional<std::string> {
          if (!*at(exercise)) return std::nullopt;
          return number_in_unit(**at(exercise), unit);
        });
  }

  void span(const char* path, const NumberRange& range, std::optional<DifficultySpan> Difficulty::* field,
            const char* meaning, Applies applies) {
    add(
        path, "pair", "", range.text(), "", meaning, false, std::move(applies),
        [field, range](TomlTable& table, std::string_view name, ExerciseDescription& exercise) {
          const auto [easy, hard] = table.pair(name, range);
          (*exercise.difficulty).*field = DifficultySpan{.easy = easy, .hard = hard};
        },
        [field](const ExerciseDescription& exercise) -> std::optional<std::string> {
          if (!exercise.difficulty || !((*exercise.difficulty).*field)) return std::nullopt;
          const DifficultySpan& span = *((*exercise.difficulty).*field);
          return fmt::format("[{}, {}]", shortest_text(span.easy), shortest_text(span.hard));
        });
  }

  void add(const char* path, const char* type, const char* unit, std::string range, std::string fallback,
           std::string meaning, bool required, Applies applies,
           std::function<void(TomlTable&, std::string_view, ExerciseDescription&)> read,
           std::function<std::optional<std::string>(const ExerciseDescription&)> write) {
    rows_.push_back({.key = {.path = path,
                             .type = type,
                             .unit = unit,
                             .range = std::move(range),
                             .default_value = std::move(fallback),
                             .meaning = std::move(meaning)},
                     .required = required,
                     .applies = std::move(applies),
                     .read = std::move(read),
                     .write = std::move(write)});
  }

 private:
  std::vector<ExerciseRow>& rows_;
};

bool is_training(const ExerciseDescription& exercise) { return exercise.kind == ExerciseKind::kTraining; }
bool has_force_target(const ExerciseDescription& exercise) { return needs_own_force(exercise.measure); }
bool has_target(const ExerciseDescription& exercise) {
  return needs_own_force(exercise.measure) || needs_own_range(exercise.measure);
}
Applies only(ExerciseMeasure measure) {
  return [measure](const ExerciseDescription& exercise) { return exercise.measure == measure; };
}

void add_general(Rows& rows) {
  rows.text("title", &ExerciseDescription::title, true, "one line for people");
  rows.text("title_de", &ExerciseDescription::title_de, false, "the title in German, for page and report");
  std::vector<std::string_view> measures;
  for (int i = 0; i < kExerciseMeasures; ++i)
    measures.push_back(exercise_measure_name(static_cast<ExerciseMeasure>(i)));
  rows.add(
      "kind", "choice", "", "training, assessment", "",
      "a training adapts from session to session; an assessment has fixed conditions and makes trends", true,
      {},
      [](TomlTable& table, std::string_view name, ExerciseDescription& exercise) {
        const std::string kind = table.text(name);
        if (kind != "training" && kind != "assessment") table.fail(name, "write training or assessment");
        exercise.kind = kind == "training" ? ExerciseKind::kTraining : ExerciseKind::kAssessment;
      },
      [](const ExerciseDescription& exercise) {
        return std::optional(toml_string(std::string(exercise_kind_name(exercise.kind))));
      });
  rows.add(
      "measure", "choice", "", fmt::format("{}", fmt::join(measures, ", ")), "",
      "what is measured; it decides what a trial is", true, {},
      [measures](TomlTable& table, std::string_view name, ExerciseDescription& exercise) {
        const std::string measure = table.text(name);
        const auto found = find_exercise_measure(measure);
        if (!found)
          table.fail(name, fmt::format("{}write one of {}", did_you_mean(measure, measures),
                                       fmt::join(measures, ", ")));
        exercise.measure = *found;
      },
      [](const ExerciseDescription& exercise) {
        return std::optional(toml_string(std::string(exercise_measure_name(exercise.measure))));
      });
  rows.text("scene", &ExerciseDescription::scene, true, "name of the scene that is felt");
  rows.add(
      "digits", "list", "", "thumb index middle ring little", "\"thumb index middle ring little\"",
      "instructed digits, with blanks between them; pinch and opposition: the fingers beside the thumb",
      false, {},
      [](TomlTable& table, std::string_view name, ExerciseDescription& exercise) {
        exercise.digits = read_digits(table, name);
      },
      [](const ExerciseDescription& exercise) { return std::optional(digits_text(exercise.digits)); });
  rows.text("instruction", &ExerciseDescription::instruction, true, "for the participant, during a trial");
}

void add_trials(Rows& rows) {
  rows.integer(
      "trials", allowed::kTrials, [](auto& e) { return &e.trials; },
      "number of trials; of each digit or object, if these come in turn");
  rows.number(
      "trial_s", "s", 1.0, allowed::kTrialSeconds, [](auto& e) { return &e.trial_s; }, "length of a trial");
  rows.number("rest_s", "s", 1.0, allowed::kRest, [](auto& e) { return &e.rest_s; }, "before each trial");
  rows.number(
      "warm_up_s", "s", 1.0, allowed::kWarmUp, [](auto& e) { return &e.warm_up_s; },
      "free movement before the first trial");
  rows.number(
      "target", "", 1.0, allowed::kShare, [](auto& e) { return &e.target; },
      "(press_and_hold force_tracking pinch smoothness) share of the person's own maximal force, or of "
      "the own range",
      has_target);
  rows.number(
      "tolerance", "", 1.0, allowed::kTolerance, [](auto& e) { return &e.tolerance; },
      "(press_and_hold force_tracking pinch) half width of the band around the target, as a share of it",
      has_force_target);
  rows.number(
      "rate_hz", "Hz", 1.0, allowed::kRate, [](auto& e) { return &e.rate_hz; },
      "(force_tracking) frequency of the moving target", only(ExerciseMeasure::kForceTracking));
}

void add_training(Rows& rows) {
  rows.add(
      "success.score", "text", "", "", "", "(training) score that decides whether a trial is successful",
      false, is_training,
      [](TomlTable& table, std::string_view name, ExerciseDescription& exercise) {
        exercise.success->score = table.text(name);
      },
      [](const ExerciseDescription& exercise) -> std::optional<std::string> {
        if (!exercise.success) return std::nullopt;
        return toml_string(exercise.success->score);
      });
  for (const bool at_most : {false, true})
    rows.add(
        at_most ? "success.at_most" : "success.at_least", "number", "", allowed::kBound.text(), "",
        at_most ? "(training) largest value of a success, instead of at_least"
                : "(training) least value of a success, in the score's unit",
        false, is_training,
        [at_most](TomlTable& table, std::string_view name, ExerciseDescription& exercise) {
          if (at_most && table.has("at_least"))
            table.fail(name, "at_least is stated, too; remove one of them");
          exercise.success->bound = table.number(name, allowed::kBound);
          exercise.success->at_most = at_most;
        },
        [at_most](const ExerciseDescription& exercise) -> std::optional<std::string> {
          if (!exercise.success || exercise.success->at_most != at_most) return std::nullopt;
          return shortest_text(exercise.success->bound);
        });
  const auto of_difficulty = [&](const char* path, const NumberRange& range, double Difficulty::* field,
                                 const char* meaning) {
    rows.add(
        path, "number", "", range.text(), shortest_text(Difficulty{}.*field), meaning, false, is_training,
        [range, field](TomlTable& table, std::string_view name, ExerciseDescription& exercise) {
          (*exercise.difficulty).*field = table.number(name, range);
        },
        [field](const ExerciseDescription& exercise) -> std::optional<std::string> {
          if (!exercise.difficulty) return std::nullopt;
          return shortest_text((*exercise.difficulty).*field);
        });
  };
  of_difficulty("difficulty.start", allowed::kDifficulty, &Difficulty::start,
                "(training) difficulty of the first session");
  of_difficulty("difficulty.target_success", allowed::kTargetSuccess, &Difficulty::target_success,
                "(training) share of successful trials that the difficulty steers to");
  rows.span("difficulty.target", allowed::kShare, &Difficulty::target,
            "(training) target at difficulty 0 and 1, instead of `target`",
            [](const ExerciseDescription& e) { return is_training(e) && has_target(e); });
  rows.span("difficulty.tolerance", allowed::kTolerance, &Difficulty::tolerance,
            "(training) tolerance at difficulty 0 and 1, instead of `tolerance`",
            [](const ExerciseDescription& e) { return is_training(e) && has_force_target(e); });
  rows.span("difficulty.rate_hz", allowed::kRate, &Difficulty::rate_hz,
            "(training, force_tracking) frequency at difficulty 0 and 1, instead of `rate_hz`",
            [](const ExerciseDescription& e) {
              return is_training(e) && e.measure == ExerciseMeasure::kForceTracking;
            });
  rows.span("difficulty.success", allowed::kBound, &Difficulty::success,
            "(training) bound of the success at difficulty 0 and 1, instead of at_least or at_most",
            is_training);
}

void add_care(Rows& rows) {
  rows.integer(
      "dose.most_repetitions", allowed::kRepetitions, [](auto& e) { return &e.dose.repetitions; },
      "trials a day");
  rows.number(
      "dose.most_minutes", "min", 1.0, allowed::kMinutes, [](auto& e) { return &e.dose.minutes; },
      "active minutes a day");
  rows.integer(
      "ratings.pain_limit", allowed::kRating, [](auto& e) { return &e.ratings.pain; },
      "a pain from 0 to 10 at which the exercise ends");
  rows.integer(
      "ratings.fatigue_limit", allowed::kRating, [](auto& e) { return &e.ratings.fatigue; },
      "a fatigue from 0 to 10 at which the exercise ends");
  rows.optional_number(
      "limits.stiffness_n_per_mm", "N/mm", kPerMm, allowed::kStiffness,
      [](auto& e) { return &e.limits.stiffness; },
      "lowers the scene's stiffness; a larger value changes nothing");
  rows.optional_number(
      "limits.force_n", "N", 1.0, allowed::kForce, [](auto& e) { return &e.limits.force; },
      "lowers the scene's fingertip force; a larger value changes nothing");
  rows.optional_number(
      "limits.torque_nm", "Nm", 1.0, allowed::kTorque, [](auto& e) { return &e.limits.torque; },
      "lowers the scene's joint torque; a larger value changes nothing");
}

void add_stimuli(Rows& rows) {
  const Applies feel = only(ExerciseMeasure::kFeelAndFind);
  rows.number(
      "feel.softest_n_per_mm", "N/mm", kPerMm, allowed::kStiffness, [](auto& e) { return &e.feel.softest; },
      "(feel_and_find) least stiffness of a sponge", feel);
  rows.number(
      "feel.stiffest_n_per_mm", "N/mm", kPerMm, allowed::kStiffness, [](auto& e) { return &e.feel.stiffest; },
      "(feel_and_find) largest stiffness of a sponge", feel);
  rows.number(
      "feel.largest_force_n", "N", 1.0, allowed::kForce, [](auto& e) { return &e.feel.largest_force; },
      "(feel_and_find) no end position needs more", feel);
  rows.number(
      "feel.deep_mm", "mm", kMm, allowed::kDepth, [](auto& e) { return &e.feel.deep; },
      "(feel_and_find) deeper one of the two end positions", feel);
  const Applies entry = only(ExerciseMeasure::kEntryCheck);
  rows.number(
      "entry.least_flexion_deg", "deg", kDeg, allowed::kEntryAngle, [](auto& e) { return &e.entry.flexion; },
      "(entry_check) least active flexion of each digit, summed over its joints", entry);
  rows.number(
      "entry.least_release_deg", "deg", kDeg, allowed::kEntryAngle, [](auto& e) { return &e.entry.release; },
      "(entry_check) least active release after the largest flexion", entry);
}

}  // namespace

std::string ExerciseRow::table() const {
  const std::size_t dot = key.path.find('.');
  return dot == std::string::npos ? std::string() : key.path.substr(0, dot);
}

std::string ExerciseRow::name() const {
  const std::size_t dot = key.path.find('.');
  return dot == std::string::npos ? key.path : key.path.substr(dot + 1);
}

std::string number_in_unit(double value, double unit) {
  const double exact = value / unit;
  const double rounded = std::stod(fmt::format("{:.12g}", exact));
  if (rounded * unit == value) return shortest_text(rounded);
  for (double near = exact, far = exact; std::abs(near - exact) <= 4e-15 * std::abs(exact);
       near = std::nextafter(near, -kInfinity), far = std::nextafter(far, kInfinity)) {
    if (near * unit == value) return shortest_text(near);
    if (far * unit == value) return shortest_text(far);
    if (exact == 0.0) break;
  }
  return shortest_text(exact);
}

std::array<bool, kDigits> read_digits(TomlTable& table, std::string_view key) {
  std::array<bool, kDigits> digits = {};
  const std::string text = table.text(key);
  std::array<std::string_view, kDigits> names;
  for (int digit = 0; digit < kDigits; ++digit) names[idx(digit)] = digit_name(digit);
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string_view part = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    if (part.empty()) continue;
    const auto found = std::find(names.begin(), names.end(), part);
    if (found == names.end())
      table.fail(key, fmt::format("{}write digits with blanks between them: {}", did_you_mean(part, names),
                                  fmt::join(names, " ")));
    digits[static_cast<std::size_t>(found - names.begin())] = true;
  }
  return digits;
}

std::string digits_text(const std::array<bool, kDigits>& digits) {
  std::string text;
  for (int digit = 0; digit < kDigits; ++digit) {
    if (!digits[idx(digit)]) continue;
    if (!text.empty()) text.append(" ");
    text.append(digit_name(digit));
  }
  return toml_string(text);
}

const std::vector<ExerciseRow>& exercise_rows() {
  static const std::vector<ExerciseRow> kTable = [] {
    std::vector<ExerciseRow> table;
    Rows rows(table);
    add_general(rows);
    add_trials(rows);
    add_training(rows);
    add_care(rows);
    add_stimuli(rows);
    return table;
  }();
  return kTable;
}

const std::vector<ObjectRow>& object_rows() {
  static const NumberRange kSize = range_in(allowed::kObjectSize, kMm);
  static const std::vector<ObjectRow> kTable = {
      {.key = {.path = "objects[].title",
               .type = "text",
               .unit = "",
               .range = "",
               .default_value = "",
               .meaning = "(object_in_hand) the answer that names it"},
       .read = [](TomlTable& table, ObjectChoice& object) { object.title = table.text("title"); },
       .write = [](const ObjectChoice& object) { return toml_string(object.title); }},
      {.key = {.path = "objects[].kind",
               .type = "choice",
               .unit = "",
               .range = "sphere, box, cylinder",
               .default_value = "",
               .meaning = "(object_in_hand) kind of the scene's first object"},
       .read = [](TomlTable& table, ObjectChoice& object) { object.kind = table.text("kind"); },
       .write = [](const ObjectChoice& object) { return toml_string(object.kind); }},
      {.key = {.path = "objects[].size_mm",
               .type = "number",
               .unit = "mm",
               .range = kSize.text(),
               .default_value = "50",
               .meaning = "(object_in_hand) diameter, or edge of a box"},
       .read =
           [](TomlTable& table, ObjectChoice& object) {
             object.size = table.number_or("size_mm", kSize, object.size / kMm) * kMm;
           },
       .write = [](const ObjectChoice& object) { return number_in_unit(object.size, kMm); }}};
  return kTable;
}

}  // namespace phalanx
