// SPDX-License-Identifier: Apache-2.0
#include "report/score_names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <span>

#include "phalanx/exercise/reasons.h"
#include "phalanx/registry/result_detail.h"

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
constexpr std::array kSymbolLabels = {
    Label{"sun", "sun", "Sonne"},    Label{"tree", "tree", "Baum"},    Label{"boat", "boat", "Boot"},
    Label{"star", "star", "Stern"},  Label{"fish", "fish", "Fisch"},   Label{"house", "house", "Haus"},
    Label{"leaf", "leaf", "Blatt"},  Label{"moon", "moon", "Mond"},    Label{"bird", "bird", "Vogel"},
    Label{"bell", "bell", "Glocke"}, Label{"apple", "apple", "Apfel"}, Label{"kite", "kite", "Drachen"},
};
/// Origins of angles, between the words of a reason.
constexpr std::array kAngleOrigins = {
    Label{"unknown", "", "unbekannt"},      Label{"measured", "", "gemessen"},
    Label{"completed", "", "erg\u00E4nzt"}, Label{"fixed", "", "fest"},
    Label{"scripted", "", "vorgegeben"},
};
constexpr std::array kConditionLabels = {
    Label{"jig", "jig", "Lehre"},
    Label{"stops", "stops", "Anschl\u00E4ge"},
    Label{"goniometer", "goniometer", "Goniometer"},
    Label{"poses", "poses", "Posen"},
    Label{"static", "static", "haftend (static)"},
    Label{"sliding", "sliding", "gleitend (sliding)"},
    Label{"none", "none", "keiner (none)"},
    Label{"smoothing", "smoothing", "gegl\u00E4ttet (smoothing)"},
    Label{"rise_only", "rise only", "Anstieg begrenzt (rise_only)"},
    Label{"direction", "direction", "Richtung begrenzt (direction)"},
    Label{"low_pass", "low-pass", "Tiefpass (low_pass)"},
    Label{"kelvin_voigt", "Kelvin-Voigt", "Kelvin-Voigt"},
    Label{"virtual_coupling", "virtual coupling", "virtuelle Kopplung (virtual_coupling)"},
    Label{"passivity", "passivity", "Passivit\u00E4t (passivity)"},
    Label{"energy_bounding", "energy bounding", "Energie begrenzt (energy_bounding)"},
    Label{"local_wall", "local wall", "lokale Wand (local_wall)"},
};
constexpr std::array kPrescriptionLabels = {
    Label{"trials", "trials", "Versuche"},
    Label{"target_success", "success aimed at", "angestrebter Erfolg"},
    Label{"difficulty", "difficulty", "Schwierigkeit"},
    Label{"pain_limit", "ends at pain", "Abbruch bei Schmerz"},
    Label{"fatigue_limit", "ends at fatigue", "Abbruch bei Erm\u00FCdung"},
    Label{"most_repetitions", "trials a day at most", "h\u00F6chstens Versuche am Tag"},
    Label{"most_minutes", "minutes a day at most", "h\u00F6chstens Minuten am Tag"},
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

std::string reason_label(std::string_view reason, ReportLanguage language) {
  if (language == ReportLanguage::kEnglish || reason.empty()) return std::string(reason);
  std::string german = german_reason(reason, [](std::string_view word) {
    std::string part = part_label(word, ReportLanguage::kGerman);
    if (part.empty()) part = find_label(kAngleOrigins, word, ReportLanguage::kGerman);
    return part.empty() ? std::string(word) : part;
  });
  return german.empty() ? fmt::format("im Wortlaut: \u201E{}\u201C", reason) : german;
}

std::string condition_label(std::string_view code, ReportLanguage language) {
  std::string label;
  for (std::size_t from = 0; from <= code.size();) {
    const std::size_t end = std::min(code.find('+', from), code.size());
    const std::string_view one = code.substr(from, end - from);
    const std::string_view known = find_label(kConditionLabels, one, language);
    if (from > 0) label.append(" + ");
    label.append(known.empty() ? one : known);
    from = end + 1;
  }
  return label;
}

std::string device_label(std::string_view device, ReportLanguage language) {
  if (language == ReportLanguage::kEnglish || !device.ends_with(kSimulatedDevice)) return std::string(device);
  device.remove_suffix(kSimulatedDevice.size());
  return fmt::format("{} (simulierter Teilnehmer)", device);
}

std::string prescription_key_label(std::string_view key, ReportLanguage language) {
  const std::string_view found = find_label(kPrescriptionLabels, key, language);
  return std::string(found.empty() ? key : found);
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
