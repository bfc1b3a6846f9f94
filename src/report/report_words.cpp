// SPDX-License-Identifier: Apache-2.0
#include "report/report_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "report/score_names.h"

namespace phalanx {

ReportLanguage report_language(std::string_view name) {
  if (name == "en") return ReportLanguage::kEnglish;
  if (name == "de") return ReportLanguage::kGerman;
  throw std::invalid_argument(
      fmt::format("lang={}: there are reports in en and de; write one of them", name));
}

namespace report {
namespace {

constexpr Words kEnglish = {
    .language = "en",
    .report = "Report",
    .session_report = "Session report",
    .right_hand = "right hand",
    .left_hand = "left hand",
    .of_day = "of {}",
    .made_on = "made on {}",
    .record = "record",
    .no_device =
        "Phalanx is no medical device, and no benefit of exercises with it is proven. The device resists "
        "a movement and does not assist it. Results of different devices, calibrations or versions are "
        "not comparable, and a change within the error of measurement is no change.",
    .days_done = "days with exercises",
    .exercises_done = "exercises",
    .minutes_done = "active minutes",
    .trials_done = "trials",
    .to_note = "To note",
    .contraindication = "Contraindication",
    .warning = "Warning",
    .not_suitable = "Not suitable on this device: the entry check was not passed",
    .no_consent = "There is no consent to the recording of these data",
    .calibration_expired = "The calibration has expired on {}",
    .incomplete_one = "1 exercise was interrupted or is not valid; see Faults and interruptions",
    .incomplete_done = "{} exercises were interrupted or are not valid; see Faults and interruptions",
    .as_of = "{}, as of {}",
    .simulated =
        "Simulated: no person did these exercises, but a simulated participant, a part of this program. "
        "The results say nothing about a person.",
    .proven_better = "Proven improvements",
    .proven_worse = "Proven deteriorations",
    .proven_title = "Proven changes",
    .nothing_proven =
        "No change is proven: none reaches a published smallest real difference. Scores of this "
        "device have no published one.",
    .tests = "Entered tests",
    .test = "test",
    .tests_lead = "Clinical tests with real objects, made by a rater and entered by hand.",
    .assessments = "Assessments",
    .assessments_lead =
        "Assessments have fixed conditions and never adapt. Values are joined only if exercise, "
        "score, unit, origin and all conditions are equal. Trainings are not among them.",
    .band_is = "Band: \u00B1 {}, the smallest real difference, around the first value",
    .trainings = "Trainings",
    .trainings_lead =
        "A training adapts its difficulty to the person, so that its success says nothing about "
        "recovery. It shows whether the difficulty fits.",
    .success_share = "successful of the scored trials [%]",
    .difficulty = "difficulty, 0 to 1",
    .target_range = "range of success that the training steers to",
    .week_dose = "Dose by week",
    .minutes_a_week = "active minutes a week",
    .done = "What was done",
    .done_lead = "All exercises, also interrupted ones. Times are of UTC.",
    .done_key =
        "The numbered columns have the active minutes of each exercise; * was interrupted or is not valid.",
    .value_before = "value before",
    .date = "date",
    .exercise = "exercise",
    .minutes = "minutes",
    .trials = "trials",
    .successes = "successful",
    .of_counted = "{} of {}",
    .successes_of_counted = "successful of scored, trainings",
    .pain = "largest pain",
    .fatigue = "largest fatigue",
    .remark = "remark",
    .state = "state",
    .complete = "complete",
    .interrupted = "interrupted",
    .not_valid = "not valid",
    .score = "score",
    .value = "value",
    .origin = "origin",
    .measured = "measured",
    .rendered = "rendered",
    .side = "side",
    .more_affected = "more affected",
    .less_affected = "less affected",
    .rater = "rater",
    .note = "note",
    .notes = "Notes",
    .faults = "Faults and interruptions",
    .faults_lead =
        "Exercises that did not come to their end or are not valid, and trials that were not scored.",
    .no_faults = "None: all exercises came to their end, and all their trials were scored.",
    .not_measured = "Not measured",
    .not_measured_lead = "Scores without a value, and the reason.",
    .occurrences = "times",
    .reason = "reason",
    .conditions = "Conditions",
    .conditions_lead = "Each letter stands for one set of conditions.",
    .under_conditions = "conditions {}",
    .patient = "Patient",
    .limits = "limits",
    .force_limit = "force at most {} N",
    .stiffness_limit = "stiffness at most {} N/mm",
    .torque_limit = "torque at most {} Nm",
    .entry_check = "entry check",
    .entry_flexion = "flexion {}\u00B0",
    .entry_release = "release {}\u00B0",
    .suitable = "suitable",
    .calibration = "calibration",
    .until = "valid until {}",
    .none = "none",
    .prescription = "prescription",
    .trials_a_day = "{} trials a day",
    .most_minutes_a_day = "at most {} minutes a day",
    .own_force = "own force",
    .consent = "consent",
    .yes = "yes",
    .no = "no",
    .verdict = "verdict",
    .one_value = "one value only",
    .improved = "improved",
    .worse = "worse",
    .not_proven = "change not proven",
    .no_difference = "no smallest real difference is published",
    .within = "within \u00B1 {}",
    .beyond = "beyond \u00B1 {}",
    .other_conditions = "not joined with earlier values: other conditions",
    .how_to_read = "How to read this report",
    .how_measured =
        "Measured: from sensors of the device. Rendered: computed and sent to the device, not measured; "
        "the person feels less, since the transmission loses a part.",
    .how_proven =
        "A change is proven if it is at least the smallest real difference, published by Chen, Chen, Wu, "
        "Wu and Chang, Neurorehabilitation and Neural Repair 23(5), 2009, 435-440, for people with stroke. "
        "Without such a number no change is proven.",
    .how_trained =
        "Success of a training: successful trials of those that were scored, without paused and invalid "
        "ones. After ten sessions the last three are judged.",
    .how_dose = "Active minutes: warm-up, rest, trials and answers, without pauses.",
    .device = "device",
    .serial = "serial number",
    .method = "calibration",
    .contact = "contact",
    .stabiliser = "stabiliser",
    .rendering = "rendering version",
    .protocol = "protocol",
    .not_recorded = "not recorded",
    .trial_invalid = "trials not scored: {}",
};

constexpr Words kGerman = {
    .language = "de",
    .report = "Bericht",
    .session_report = "Sitzungsbericht",
    .right_hand = "rechte Hand",
    .left_hand = "linke Hand",
    .of_day = "vom {}",
    .made_on = "erstellt am {}",
    .record = "Datensatz",
    .no_device =
        "Phalanx ist kein Medizinprodukt, und ein Nutzen von \u00DCbungen damit ist nicht erwiesen. Das "
        "Ger\u00E4t setzt einer Bewegung Widerstand entgegen und unterst\u00FCtzt sie nicht. Ergebnisse "
        "verschiedener Ger\u00E4te, Kalibrierungen oder Versionen sind nicht vergleichbar, und eine "
        "\u00C4nderung innerhalb des Messfehlers ist keine \u00C4nderung.",
    .days_done = "Tage mit \u00DCbungen",
    .exercises_done = "\u00DCbungen",
    .minutes_done = "aktive Minuten",
    .trials_done = "Versuche",
    .to_note = "Zu beachten",
    .contraindication = "Gegenanzeige",
    .warning = "Warnung",
    .not_suitable = "F\u00FCr dieses Ger\u00E4t nicht geeignet: Die Eingangspr\u00FCfung ist nicht bestanden",
    .no_consent = "In die Aufzeichnung dieser Daten wurde nicht eingewilligt",
    .calibration_expired = "Die Kalibrierung ist am {} abgelaufen",
    .incomplete_one =
        "1 \u00DCbung wurde abgebrochen oder ist ung\u00FCltig; siehe St\u00F6rungen und Abbr\u00FCche",
    .incomplete_done =
        "{} \u00DCbungen wurden abgebrochen oder sind ung\u00FCltig; siehe St\u00F6rungen und Abbr\u00FCche",
    .as_of = "{}, Stand {}",
    .simulated =
        "Simuliert: Diese \u00DCbungen hat keine Person gemacht, sondern ein simulierter Teilnehmer, ein "
        "Teil "
        "dieses Programms. Die Ergebnisse sagen nichts \u00FCber eine Person.",
    .proven_better = "Nachgewiesene Verbesserungen",
    .proven_worse = "Nachgewiesene Verschlechterungen",
    .proven_title = "Nachgewiesene \u00C4nderungen",
    .nothing_proven =
        "Keine \u00C4nderung ist nachgewiesen: Keine erreicht einen ver\u00F6ffentlichten kleinsten "
        "echten Unterschied. F\u00FCr Werte dieses Ger\u00E4ts ist keiner ver\u00F6ffentlicht.",
    .tests = "Eingetragene Tests",
    .test = "Test",
    .tests_lead =
        "Klinische Tests mit echten Gegenst\u00E4nden, von einer pr\u00FCfenden Person eingetragen.",
    .assessments = "Messungen",
    .assessments_lead =
        "Messungen haben feste Bedingungen und passen sich nie an. Werte werden nur verbunden, wenn "
        "\u00DCbung, Gr\u00F6\u00DFe, Einheit, Herkunft und alle Bedingungen gleich sind. Trainings "
        "geh\u00F6ren nicht dazu.",
    .band_is = "Band: \u00B1 {}, der kleinste echte Unterschied, um den ersten Wert",
    .trainings = "Trainings",
    .trainings_lead =
        "Ein Training passt seine Schwierigkeit der Person an. Sein Erfolg sagt deshalb nichts \u00FCber "
        "die Genesung. Er zeigt, ob die Schwierigkeit passt.",
    .success_share = "erfolgreich von den gewerteten Versuchen [%]",
    .difficulty = "Schwierigkeit, 0 bis 1",
    .target_range = "Erfolgsbereich, auf den das Training steuert",
    .week_dose = "Umfang je Woche",
    .minutes_a_week = "aktive Minuten je Woche",
    .done = "Was getan wurde",
    .done_lead = "Alle \u00DCbungen, auch abgebrochene. Zeiten sind UTC.",
    .done_key =
        "Die nummerierten Spalten enthalten die aktiven Minuten jeder \u00DCbung; * wurde abgebrochen oder "
        "ist ung\u00FCltig.",
    .value_before = "Wert davor",
    .date = "Datum",
    .exercise = "\u00DCbung",
    .minutes = "Minuten",
    .trials = "Versuche",
    .successes = "erfolgreich",
    .of_counted = "{} von {}",
    .successes_of_counted = "erfolgreich von gewerteten, Trainings",
    .pain = "gr\u00F6\u00DFter Schmerz",
    .fatigue = "gr\u00F6\u00DFte M\u00FCdigkeit",
    .remark = "Bemerkung",
    .state = "Zustand",
    .complete = "vollst\u00E4ndig",
    .interrupted = "abgebrochen",
    .not_valid = "ung\u00FCltig",
    .score = "Gr\u00F6\u00DFe",
    .value = "Wert",
    .origin = "Herkunft",
    .measured = "gemessen",
    .rendered = "berechnet",
    .side = "Seite",
    .more_affected = "st\u00E4rker betroffen",
    .less_affected = "weniger betroffen",
    .rater = "gepr\u00FCft von",
    .note = "Notiz",
    .notes = "Notizen",
    .faults = "St\u00F6rungen und Abbr\u00FCche",
    .faults_lead =
        "\u00DCbungen, die nicht zu Ende kamen oder ung\u00FCltig sind, und Versuche ohne Wertung.",
    .no_faults = "Keine: Alle \u00DCbungen kamen zu Ende, und alle Versuche wurden gewertet.",
    .not_measured = "Nicht gemessen",
    .not_measured_lead = "Gr\u00F6\u00DFen ohne Wert, und der Grund.",
    .occurrences = "Anzahl",
    .reason = "Grund",
    .conditions = "Bedingungen",
    .conditions_lead = "Jeder Buchstabe steht f\u00FCr einen Satz von Bedingungen.",
    .under_conditions = "Bedingungen {}",
    .patient = "Patientin oder Patient",
    .limits = "Grenzen",
    .force_limit = "Kraft h\u00F6chstens {} N",
    .stiffness_limit = "Steifigkeit h\u00F6chstens {} N/mm",
    .torque_limit = "Drehmoment h\u00F6chstens {} Nm",
    .entry_check = "Eingangspr\u00FCfung",
    .entry_flexion = "Beugung {}\u00B0",
    .entry_release = "L\u00F6sen {}\u00B0",
    .suitable = "geeignet",
    .calibration = "Kalibrierung",
    .until = "g\u00FCltig bis {}",
    .none = "keine",
    .prescription = "Verordnung",
    .trials_a_day = "{} Versuche am Tag",
    .most_minutes_a_day = "h\u00F6chstens {} Minuten am Tag",
    .own_force = "eigene Kraft",
    .consent = "Einwilligung",
    .yes = "ja",
    .no = "nein",
    .verdict = "Urteil",
    .one_value = "nur ein Wert",
    .improved = "verbessert",
    .worse = "verschlechtert",
    .not_proven = "\u00C4nderung nicht nachgewiesen",
    .no_difference = "kein kleinster echter Unterschied ist ver\u00F6ffentlicht",
    .within = "innerhalb \u00B1 {}",
    .beyond = "au\u00DFerhalb \u00B1 {}",
    .other_conditions = "nicht mit fr\u00FCheren Werten verbunden: andere Bedingungen",
    .how_to_read = "Wie dieser Bericht zu lesen ist",
    .how_measured =
        "Gemessen: von Sensoren des Ger\u00E4ts. Berechnet: berechnet und an das Ger\u00E4t gesendet, nicht "
        "gemessen; die Person sp\u00FCrt weniger, weil die \u00DCbertragung einen Teil verliert.",
    .how_proven =
        "Eine \u00C4nderung ist nachgewiesen, wenn sie mindestens den kleinsten echten Unterschied erreicht, "
        "ver\u00F6ffentlicht von Chen, Chen, Wu, Wu und Chang, Neurorehabilitation and Neural Repair 23(5), "
        "2009, 435-440, f\u00FCr Menschen nach Schlaganfall. Ohne eine solche Zahl ist keine \u00C4nderung "
        "nachgewiesen.",
    .how_trained =
        "Erfolg eines Trainings: erfolgreiche Versuche von den gewerteten, ohne unterbrochene und "
        "ung\u00FCltige. Nach zehn Sitzungen werden die letzten drei beurteilt.",
    .how_dose =
        "Aktive Minuten: Aufw\u00E4rmen, Pause vor einem Versuch, Versuche und Antworten, ohne "
        "Unterbrechungen.",
    .device = "Ger\u00E4t",
    .serial = "Seriennummer",
    .method = "Kalibrierung",
    .contact = "Kontakt",
    .stabiliser = "Stabilisierung",
    .rendering = "Version der Kraftberechnung",
    .protocol = "Protokoll",
    .not_recorded = "nicht aufgezeichnet",
    .trial_invalid = "Versuche ohne Wertung: {}",
};

constexpr const char* kMinus = "\u2212";
constexpr const char* kNarrowSpace = "\u202F";

/// Writes a number's text as the language does.
std::string in_language(std::string text, ReportLanguage language) {
  if (language == ReportLanguage::kGerman) std::replace(text.begin(), text.end(), '.', ',');
  if (text.starts_with("-")) text = kMinus + text.substr(1);
  return text;
}

}  // namespace

const Words& words_of(ReportLanguage language) noexcept {
  return language == ReportLanguage::kGerman ? kGerman : kEnglish;
}

std::string number_label(double value, ReportLanguage language) {
  const double size = std::abs(value);
  const bool whole = size >= 9999.5 && size < 1e9;
  return in_language(whole ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value), language);
}

std::string value_label(double value, std::string_view unit, ReportLanguage language) {
  const std::string named = unit_label(unit);
  const char* gap = named.empty() || named == "\u00B0" ? "" : kNarrowSpace;
  return fmt::format("{}{}{}", number_label(value, language), gap, named);
}

std::string minutes_label(double seconds, ReportLanguage language) {
  const double minutes = seconds / 60.0;
  return in_language(minutes < 9.95 ? fmt::format("{:.1f}", minutes) : fmt::format("{:.0f}", minutes),
                     language);
}

std::string change_label(double change, std::string_view unit, ReportLanguage language) {
  const std::string named = value_label(change, unit, language);
  return change > 0.0 ? fmt::format("+{}", named) : named;
}

std::string exact_text(double value) { return fmt::format("{}", value); }

}  // namespace report
}  // namespace phalanx
