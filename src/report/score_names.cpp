// SPDX-License-Identifier: Apache-2.0
#include "report/score_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

namespace phalanx::report {
namespace {

/// Text in all languages.
struct Label {
  std::string_view name;
  std::string_view english;
  std::string_view german;
};

constexpr std::array kScores = {
    Label{"mean_force_n", "mean force", "mittlere Kraft"},
    Label{"sd_force_n", "standard deviation of the force", "Standardabweichung der Kraft"},
    Label{"cv", "coefficient of variation of the force", "Variationskoeffizient der Kraft"},
    Label{"time_in_target_s", "time in the target", "Zeit im Ziel"},
    Label{"time_in_target_share", "share of time in the target", "Anteil der Zeit im Ziel"},
    Label{"rise_time_s", "rise time, 10 to 90 %", "Anstiegszeit, 10 bis 90 %"},
    Label{"rmse_n", "error of the force (root mean square)", "Fehler der Kraft (quadratisches Mittel)"},
    Label{"rrmse", "relative error of the force", "relativer Fehler der Kraft"},
    Label{"lag_s", "delay behind the target", "Verzug hinter dem Ziel"},
    Label{"correlation", "correlation with the target", "Korrelation mit dem Ziel"},
    Label{"peak_force_n", "largest force", "gr\u00F6\u00DFte Kraft"},
    Label{"release_time_s", "release time, 90 to 10 %", "L\u00F6sezeit, 90 bis 10 %"},
    Label{"release_delay_s", "delay until released", "Verzug bis zum Loslassen"},
    Label{"hold_time_s", "longest hold", "l\u00E4ngstes Halten"},
    Label{"grip_force_n", "grip force", "Griffkraft"},
    Label{"force_ratio", "force of the finger over that of the thumb",
          "Kraft des Fingers durch die des Daumens"},
    Label{"slips", "slips", "Abrutscher"},
    Label{"instructed_range_deg", "movement of the instructed digit", "Bewegung des aufgeforderten Fingers"},
    Label{"individuation_index", "individuation index", "Index der Einzelbewegung"},
    Label{"sparc", "smoothness (SPARC)", "Gleichm\u00E4\u00DFigkeit (SPARC)"},
    Label{"movement_time_s", "movement time", "Bewegungszeit"},
    Label{"peak_speed_deg_per_s", "largest speed", "gr\u00F6\u00DFte Geschwindigkeit"},
    Label{"speed_peaks", "peaks of the speed", "Spitzen der Geschwindigkeit"},
    Label{"stiffness_threshold_percent", "smallest felt difference of stiffness",
          "kleinster f\u00FChlbarer Unterschied der Steifigkeit"},
    Label{"stiffness_threshold_low_percent", "smallest felt difference, lower bound",
          "kleinster f\u00FChlbarer Unterschied, untere Grenze"},
    Label{"stiffness_threshold_high_percent", "smallest felt difference, upper bound",
          "kleinster f\u00FChlbarer Unterschied, obere Grenze"},
    Label{"stiffness_right_percent", "right answers", "richtige Antworten"},
    Label{"identified_percent", "objects recognised", "erkannte Gegenst\u00E4nde"},
    Label{"identified_low_percent", "objects recognised, lower bound",
          "erkannte Gegenst\u00E4nde, untere Grenze"},
    Label{"identified_high_percent", "objects recognised, upper bound",
          "erkannte Gegenst\u00E4nde, obere Grenze"},
    Label{"transmitted_bit", "transmitted information", "\u00FCbertragene Information"},
    Label{"transmitted_plain_bit", "transmitted information, not corrected",
          "\u00FCbertragene Information, nicht korrigiert"},
};

/// Names with a digit or joint between prefix and suffix; longer prefixes first.
struct Pattern {
  std::string_view prefix;
  std::string_view suffix;
  std::string_view english;  ///< {} is the digit or joint
  std::string_view german;
};
constexpr std::array kPatterns = {
    Pattern{"entry_flexion_", "_deg", "{}: active flexion", "{}: aktive Beugung"},
    Pattern{"entry_release_", "_deg", "{}: active release", "{}: aktives L\u00F6sen"},
    Pattern{"opposition_held_", "_mm", "distance of the thumb to the {}, held for 1 s",
            "Abstand Daumen \u2013 {}, 1 s lang gehalten"},
    Pattern{"opposition_", "_mm", "distance of the thumb to the {}", "Abstand Daumen \u2013 {}"},
    Pattern{"enslaving_", "", "{}: moves along", "{}: Mitbewegung"},
    Pattern{"flexion_", "_deg", "{}: flexion", "{}: Beugung"},
    Pattern{"deficit_", "_deg", "{}: extension deficit", "{}: Streckdefizit"},
    Pattern{"tam_", "_deg", "{}: total active motion", "{}: gesamte aktive Bewegung"},
    Pattern{"rom_", "_deg", "{}: range of motion", "{}: Bewegungsumfang"},
    Pattern{"min_", "_deg", "{}: smallest angle", "{}: kleinster Winkel"},
    Pattern{"max_", "_deg", "{}: largest angle", "{}: gr\u00F6\u00DFter Winkel"},
};

constexpr std::array kDigitLabels = {
    Label{"thumb", "thumb", "Daumen"},
    Label{"index", "index finger", "Zeigefinger"},
    Label{"middle", "middle finger", "Mittelfinger"},
    Label{"ring", "ring finger", "Ringfinger"},
    Label{"little", "little finger", "Kleinfinger"},
};
constexpr std::array kMovements = {
    Label{"flexion", "flexion", "Beugung"},
    Label{"abduction", "abduction", "Abspreizung"},
};
constexpr std::array kExercises = {
    Label{"entry_check", "", "Eingangspr\u00FCfung: aktive Beugung und aktives L\u00F6sen"},
    Label{"own_force", "", "Eigene gr\u00F6\u00DFte Kraft jedes Fingers"},
    Label{"range_of_motion", "", "Bewegungsumfang jedes Gelenks"},
    Label{"total_active_motion", "", "Gesamte aktive Bewegung der Finger"},
    Label{"press_and_hold", "", "Mit dem Zeigefinger dr\u00FCcken und halten"},
    Label{"force_tracking", "", "Mit der Kraft einem Ziel folgen"},
    Label{"squeeze_release", "", "Rasch dr\u00FCcken und rasch loslassen"},
    Label{"pinch", "", "Einen Ball zwischen Daumen und Zeigefinger halten"},
    Label{"opposition", "", "Jede Fingerspitze mit dem Daumen ber\u00FChren"},
    Label{"independence", "", "Einen Finger allein bewegen"},
    Label{"smoothness", "", "Den Zeigefinger in einer gleichm\u00E4\u00DFigen Bewegung beugen"},
    Label{"feel_and_find", "", "Welcher von zwei Schw\u00E4mmen ist weicher?"},
    Label{"object_in_hand", "", "Welcher Gegenstand liegt in der Hand?"},
    Label{"train_press", "", "Training: mit dem Zeigefinger dr\u00FCcken und halten"},
    Label{"train_tracking", "", "Training: mit der Kraft des Zeigefingers einem Ziel folgen"},
    Label{"train_pinch", "", "Training: einen Ball zwischen Daumen und Zeigefinger halten"},
    Label{"train_opposition", "", "Training: die Fingerspitzen mit dem Daumen ber\u00FChren"},
};
constexpr std::array kSymbolLabels = {
    Label{"sun", "sun", "Sonne"},    Label{"tree", "tree", "Baum"},    Label{"boat", "boat", "Boot"},
    Label{"star", "star", "Stern"},  Label{"fish", "fish", "Fisch"},   Label{"house", "house", "Haus"},
    Label{"leaf", "leaf", "Blatt"},  Label{"moon", "moon", "Mond"},    Label{"bird", "bird", "Vogel"},
    Label{"bell", "bell", "Glocke"}, Label{"apple", "apple", "Apfel"}, Label{"kite", "kite", "Drachen"},
};
constexpr std::array kTestLabels = {
    Label{"fugl_meyer_hand", "", "Fugl-Meyer-Test, Hand"},
    Label{"box_and_block", "", "Box-and-Block-Test"},
    Label{"nine_hole_peg", "", "Neun-Loch-Steckbrett-Test"},
    Label{"grip", "", "Greifkraft, gemessen mit einem Dynamometer"},
    Label{"ashworth", "", "Modifizierte Ashworth-Skala"},
};

std::string_view find_label(std::span<const Label> labels, std::string_view name, ReportLanguage language) {
  const auto found =
      std::find_if(labels.begin(), labels.end(), [&](const Label& each) { return each.name == name; });
  if (found == labels.end()) return {};
  return language == ReportLanguage::kGerman ? found->german : found->english;
}

/// @returns "index finger, MCP flexion" for "index_mcp_flexion"; a digit's name for a digit; else nothing
std::string part_label(std::string_view part, ReportLanguage language) {
  if (const std::string_view digit = find_label(kDigitLabels, part, language); !digit.empty())
    return std::string(digit);
  const std::size_t first = part.find('_');
  const std::size_t second = first == std::string_view::npos ? first : part.find('_', first + 1);
  if (second == std::string_view::npos) return {};
  const std::string_view digit = find_label(kDigitLabels, part.substr(0, first), language);
  const std::string_view movement = find_label(kMovements, part.substr(second + 1), language);
  if (digit.empty() || movement.empty()) return {};
  std::string joint(part.substr(first + 1, second - first - 1));
  std::transform(joint.begin(), joint.end(), joint.begin(),
                 [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
  return fmt::format("{} {}, {}", digit, joint, movement);
}

std::string with_capital(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

std::string pattern_label(std::string_view name, ReportLanguage language) {
  for (const Pattern& each : kPatterns) {
    if (!name.starts_with(each.prefix) || !name.ends_with(each.suffix) ||
        name.size() <= each.prefix.size() + each.suffix.size())
      continue;
    const std::string part = part_label(
        name.substr(each.prefix.size(), name.size() - each.prefix.size() - each.suffix.size()), language);
    if (part.empty()) continue;
    return fmt::format(fmt::runtime(language == ReportLanguage::kGerman ? each.german : each.english), part);
  }
  return {};
}

std::string known_label(std::string_view name, ReportLanguage language) {
  if (const std::string_view found = find_label(kScores, name, language); !found.empty())
    return std::string(found);
  return pattern_label(name, language);
}

}  // namespace

std::string score_label(std::string_view name, ReportLanguage language) {
  if (std::string label = known_label(name, language); !label.empty()) return with_capital(std::move(label));
  const std::size_t at = name.find('_');
  if (at != std::string_view::npos) {
    const std::string_view digit = find_label(kDigitLabels, name.substr(0, at), language);
    const std::string rest = known_label(name.substr(at + 1), language);
    if (!digit.empty() && !rest.empty()) return with_capital(fmt::format("{}: {}", digit, rest));
  }
  std::string words(name);
  std::replace(words.begin(), words.end(), '_', ' ');
  return with_capital(std::move(words));
}

std::string exercise_label(std::string_view name, std::string_view title, ReportLanguage language) {
  if (language == ReportLanguage::kGerman)
    if (const std::string_view german = find_label(kExercises, name, language); !german.empty())
      return std::string(german);
  return std::string(title.empty() ? name : title);
}

std::string symbol_label(std::string_view symbol, ReportLanguage language) {
  const std::string_view found = find_label(kSymbolLabels, symbol, language);
  return std::string(found.empty() ? symbol : found);
}

std::string test_label(TestKind kind, ReportLanguage language) {
  const TestKindInfo& info = test_kind(kind);
  if (language == ReportLanguage::kGerman)
    if (const std::string_view german = find_label(kTestLabels, info.name, language); !german.empty())
      return std::string(german);
  return std::string(info.title);
}

std::string digit_label(std::string_view digit, ReportLanguage language) {
  const std::string_view found = find_label(kDigitLabels, digit, language);
  return std::string(found.empty() ? digit : found);
}

std::string unit_label(std::string_view unit) {
  if (unit == "-") return {};
  if (unit == "deg") return "\u00B0";
  if (unit == "deg/s") return "\u00B0/s";
  return std::string(unit);
}

}  // namespace phalanx::report
