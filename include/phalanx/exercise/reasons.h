// SPDX-License-Identifier: Apache-2.0
// The closed set of reasons of results: why a score has no value, a trial does not count, and an exercise ended.
// Recordings and registries store the English text. It is also the key of the German one: german_reason().
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace phalanx {

/// Number of a reason. The names follow the English texts.
enum class Reason : std::uint8_t {
  // Steps of a trial.
  kTooFewSteps,
  kStepsMissingBefore,
  kTimeNotFinite,
  kTimeNotIncreasing,
  kTrialTooLong,
  kNoSample,
  kStationFault,
  kStepsMissing,
  kStepsMissingBeforeIt,
  kObservationNotFinite,
  kValueNotFinite,
  kUnknownStepFault,
  kUnknownFault,
  // Forces.
  kNoForceOfDigitAlone,
  kTorquesOffAt,
  kTorquesRampedAt,
  kForceSensorGaps,
  kForceNotFinite,
  kScoreNotFinite,
  kRiseNotReached,
  kRiseBeganHigh,
  kNotLongerThanSettling,
  kMeanForceNotPositive,
  kTargetAllZero,
  kPeakBelowLeast,
  kNotReleased,
  kReleasedBeforeCue,
  kLagBelowStep,
  kShorterThanLag,
  kTargetDoesNotMove,
  kForceDoesNotChange,
  kSlippedOnce,
  kSlippedOften,
  kNeverHeld,
  kNoSlidingContacts,
  // Angles.
  kAngleNotMeasured,
  kAngleNotFinite,
  kPadNotFinite,
  kSampleTimeNotKnown,
  kSampleTimeGoesBack,
  kTooFewSamples,
  kCalibrationDependsByMethod,
  kCalibrationDepends,
  kShorterThanHold,
  kInstructedMovedLittle,
  kShorterThanSpeed,
  kSpeedBelowLeast,
  kMovementTooShort,
  kNoFlexionSensor,
  kEntryAngleNotFinite,
  kDigitFollows,
  kMixedOrigins,
  // Stimuli.
  kNotFinished,
  kTooFewPairs,
  kTooFewObjects,
  kMoreWrongThanGuessed,
  kNoThresholdShown,
  kThresholdTooSmall,
  kNoStiffnessWhilePressed,
  kNoStiffness,
  kSentStiffnessDiffers,
  kPressFault,
  kPressRamped,
  kPressTooShort,
  kPressTooFast,
  // Ends of trials and exercises.
  kTorqueNotFullyOn,
  kTouchedTooShortly,
  kEndPositionNotReached,
  kTrialPaused,
  kTrialSkipped,
  kAllTrialsDone,
  kDoseOfRepetitionsDone,
  kDoseOfMinutesDone,
  kPersonEnded,
  kPainLimit,
  kFatigueLimit,
  kNotEnded,
  // Results that are made from recordings.
  kOneStepMissingInRecording,
  kStepsMissingInRecording,
  kRecordingEndsBefore,
  kNoResultFromRecording,
  kNoRecordedValue,
  kOtherResult,
  kOtherResultOneMissing,
  kOtherResultMissing,
  kOtherResultBits,
  kOtherResultVersion,
  kOtherResultMachine,
  // Last, since a part of them is a reason of its own.
  kStepFaultAt,
  kNotCounted,
  kNotProven,
  kCount,
};

/// Texts of a reason. Placeholders of the English text are fmt's; {0}, {1}, ... of the German one are the texts
/// between its words, which german_reason() translates.
struct ReasonWords {
  Reason reason = Reason::kCount;
  std::string_view code = {};  ///< in FHIR bundles: "torques-off-at"
  std::string_view english = {};
  std::string_view german = {};
};

/// All reasons in the order of their numbers.
inline constexpr std::array<ReasonWords, static_cast<std::size_t>(Reason::kCount)> kReasons = {{
    {Reason::kTooFewSteps, "too-few-steps", "not scored: the trial has {:d} steps; two are needed at least",
     "nicht gewertet: Der Versuch hat {0} Abtastschritte; mindestens zwei sind n\u00F6tig"},
    {Reason::kStepsMissingBefore, "steps-missing-before",
     "not scored: steps are missing before {:.3f} s; repeat the trial",
     "nicht gewertet: Vor {0} s fehlen Abtastschritte; bitte den Versuch wiederholen"},
    {Reason::kTimeNotFinite, "time-not-finite", "not scored: a time is not a finite number; repeat the trial",
     "nicht gewertet: Eine Zeit ist keine endliche Zahl; bitte den Versuch wiederholen"},
    {Reason::kTimeNotIncreasing, "time-not-increasing",
     "not scored: time does not increase at {:.3f} s; repeat the trial",
     "nicht gewertet: Die Zeit l\u00E4uft bei {0} s nicht weiter; bitte den Versuch wiederholen"},
    {Reason::kTrialTooLong, "trial-too-long",
     "not scored: the trial lasts {:.0f} s; {:.0f} s are allowed at most",
     "nicht gewertet: Der Versuch dauert {0} s; h\u00F6chstens {1} s sind erlaubt"},
    {Reason::kNoSample, "no-sample", "the device sent no sample",
     "Das Ger\u00E4t hat keinen Messwert gesendet"},
    {Reason::kStationFault, "station-fault", "the station was in a fault, or the device was lost",
     "Die Station hatte eine St\u00F6rung, oder die Verbindung zum Ger\u00E4t war unterbrochen"},
    {Reason::kStepsMissing, "steps-missing", "steps are missing", "Abtastschritte fehlen"},
    {Reason::kStepsMissingBeforeIt, "steps-missing-before-it", "steps are missing before",
     "Davor fehlen Abtastschritte"},
    {Reason::kObservationNotFinite, "observation-not-finite",
     "an angle, force or time was not a finite number",
     "Ein Winkel, eine Kraft oder eine Zeit war keine endliche Zahl"},
    {Reason::kValueNotFinite, "value-not-finite", "a value is not a finite number",
     "Ein Messwert ist keine endliche Zahl"},
    {Reason::kUnknownStepFault, "unknown-step-fault", "the step has an unknown fault",
     "unbekannte St\u00F6rung eines Abtastschritts"},
    {Reason::kUnknownFault, "unknown-fault", "the station reported a fault",
     "Die Station hat eine St\u00F6rung gemeldet"},

    {Reason::kNoForceOfDigitAlone, "no-force-of-digit-alone",
     "not measured: the device has no sensor and motor of the digit {} alone",
     "nicht gemessen: Das Ger\u00E4t hat keinen eigenen Sensor und Motor f\u00FCr diesen Finger ({0})"},
    {Reason::kTorquesOffAt, "torques-off-at", "not scored: the torques were off at {:.3f} s",
     "nicht gewertet: Die Drehmomente waren bei {0} s abgeschaltet"},
    {Reason::kTorquesRampedAt, "torques-ramped-at",
     "not scored: the torques were ramped at {:.3f} s (factor {:.2f})",
     "nicht gewertet: Die Drehmomente liefen bei {0} s noch hoch oder herunter (Faktor {1})"},
    {Reason::kForceSensorGaps, "force-sensor-gaps",
     "not scored: the force sensor of the digit {} has no value in {:d} of {:d} steps",
     "nicht gewertet: Der Kraftsensor ({0}) hat in {1} von {2} Abtastschritten keinen Wert"},
    {Reason::kForceNotFinite, "force-not-finite",
     "not scored: the force of the digit {} is not finite at {:.3f} s",
     "nicht gewertet: Die Kraft ({0}) ist bei {1} s keine endliche Zahl"},
    {Reason::kScoreNotFinite, "score-not-finite", "not scored: the value is not finite",
     "nicht gewertet: Der Wert ist keine endliche Zahl"},
    {Reason::kRiseNotReached, "rise-not-reached", "not scored: the force never reached 90 % of {:.2f} N",
     "nicht gewertet: Die Kraft hat 90 % von {0} N nie erreicht"},
    {Reason::kRiseBeganHigh, "rise-began-high",
     "not scored: the force was above 10 % of {:.2f} N when the trial began",
     "nicht gewertet: Die Kraft lag zu Beginn des Versuchs schon \u00FCber 10 % von {0} N"},
    {Reason::kNotLongerThanSettling, "not-longer-than-settling",
     "not scored: the trial is not longer than the {:.2f} s to settle",
     "nicht gewertet: Der Versuch ist nicht l\u00E4nger als die Einschwingzeit von {0} s"},
    {Reason::kMeanForceNotPositive, "mean-force-not-positive", "not scored: the mean force is not above 0",
     "nicht gewertet: Die mittlere Kraft liegt nicht \u00FCber 0"},
    {Reason::kTargetAllZero, "target-all-zero", "not scored: the target is 0 all the time",
     "nicht gewertet: Das Ziel ist die ganze Zeit 0"},
    {Reason::kPeakBelowLeast, "peak-below-least", "not scored: the peak of {:.2f} N is below {:.2f} N",
     "nicht gewertet: Die gr\u00F6\u00DFte Kraft von {0} N liegt unter {1} N"},
    {Reason::kNotReleased, "not-released",
     "not scored: the force did not fall below 10 % of its peak before the trial ended",
     "nicht gewertet: Die Kraft ist bis zum Ende des Versuchs nicht unter 10 % ihres gr\u00F6\u00DFten "
     "Wertes gefallen"},
    {Reason::kReleasedBeforeCue, "released-before-cue", "not scored: the force was released before the cue",
     "nicht gewertet: Die Kraft wurde schon vor dem Signal gel\u00F6st"},
    {Reason::kLagBelowStep, "lag-below-step",
     "not scored: the longest lag is below the signals' step of 0.01 s",
     "nicht gewertet: Der gr\u00F6\u00DFte Verzug liegt unter der Schrittweite der Signale von 0,01 s"},
    {Reason::kShorterThanLag, "shorter-than-lag",
     "not scored: the trial is shorter than twice the longest lag of {:.2f} s",
     "nicht gewertet: Der Versuch ist k\u00FCrzer als das Doppelte des gr\u00F6\u00DFten Verzugs von {0} s"},
    {Reason::kTargetDoesNotMove, "target-does-not-move", "not scored: the target does not move",
     "nicht gewertet: Das Ziel bewegt sich nicht"},
    {Reason::kForceDoesNotChange, "force-does-not-change", "not scored: the force does not change",
     "nicht gewertet: Die Kraft \u00E4ndert sich nicht"},
    {Reason::kSlippedOnce, "slipped-once",
     "not scored: the object slipped once, first at {:.3f} s; repeat the trial",
     "nicht gewertet: Der Gegenstand ist einmal abgerutscht, bei {0} s; bitte den Versuch wiederholen"},
    {Reason::kSlippedOften, "slipped-often",
     "not scored: the object slipped {:d} times, first at {:.3f} s; repeat the trial",
     "nicht gewertet: Der Gegenstand ist {0}-mal abgerutscht, zuerst bei {1} s; bitte den Versuch "
     "wiederholen"},
    {Reason::kNeverHeld, "never-held", "not scored: both digits never held with {:.2f} N",
     "nicht gewertet: Daumen und Finger haben nie gleichzeitig mit {0} N gehalten"},
    {Reason::kNoSlidingContacts, "no-sliding-contacts",
     "not measured: contacts of this scene cannot slide, so that a slip is not seen; set "
     "contact.mode = \"sliding\"",
     "nicht gemessen: Kontakte dieser Szene k\u00F6nnen nicht gleiten, so dass ein Abrutschen nicht erkannt "
     "wird; "
     "contact.mode = \"sliding\" einstellen"},

    {Reason::kAngleNotMeasured, "angle-not-measured", "not measured: the angle of {} is {}",
     "nicht gemessen: Der Winkel ist {1} ({0})"},
    {Reason::kAngleNotFinite, "angle-not-finite", "not scored: the angle of {} is not finite at {:.3f} s",
     "nicht gewertet: Der Winkel ({0}) ist bei {1} s keine endliche Zahl"},
    {Reason::kPadNotFinite, "pad-not-finite", "not scored: a pad's position is not finite at {:.3f} s",
     "nicht gewertet: Die Lage einer Fingerkuppe ist bei {0} s keine endliche Zahl"},
    {Reason::kSampleTimeNotKnown, "sample-time-not-known",
     "not scored: the time of the sample at {:.3f} s is not known",
     "nicht gewertet: Der Zeitpunkt des Messwerts bei {0} s ist nicht bekannt"},
    {Reason::kSampleTimeGoesBack, "sample-time-goes-back",
     "not scored: the device's time goes back at {:.3f} s; repeat the trial",
     "nicht gewertet: Die Uhr des Ger\u00E4ts springt bei {0} s zur\u00FCck; bitte den Versuch wiederholen"},
    {Reason::kTooFewSamples, "too-few-samples",
     "not measured: the device gave {:.1f} samples a second in the trial; speeds need {:.0f} at least",
     "nicht gemessen: Das Ger\u00E4t lieferte im Versuch {0} Messwerte je Sekunde; Geschwindigkeiten "
     "brauchen "
     "mindestens {1}"},
    {Reason::kCalibrationDependsByMethod, "calibration-depends-by-method",
     "not measured: the calibration depends on what the person can reach; calibrate by jig, stops or "
     "goniometer",
     "nicht gemessen: Die Kalibrierung h\u00E4ngt davon ab, wie weit die Person bewegen kann; bitte mit "
     "Lehre, "
     "Anschl\u00E4gen oder Goniometer kalibrieren"},
    {Reason::kCalibrationDepends, "calibration-depends",
     "not measured: the calibration depends on what the person can reach; calibrate by a method that does "
     "not",
     "nicht gemessen: Die Kalibrierung h\u00E4ngt davon ab, wie weit die Person bewegen kann; bitte mit "
     "einem "
     "davon unabh\u00E4ngigen Verfahren kalibrieren"},
    {Reason::kShorterThanHold, "shorter-than-hold",
     "not scored: the trial is shorter than the hold of {:.2f} s",
     "nicht gewertet: Der Versuch ist k\u00FCrzer als die Haltezeit von {0} s"},
    {Reason::kInstructedMovedLittle, "instructed-moved-little",
     "not scored: the instructed digit moved by {:.1f} deg, less than {:.1f} deg",
     "nicht gewertet: Der aufgeforderte Finger bewegte sich um {0}\u00B0, weniger als {1}\u00B0"},
    {Reason::kShorterThanSpeed, "shorter-than-speed", "not scored: the trial is shorter than {:.2f} s",
     "nicht gewertet: Der Versuch ist k\u00FCrzer als {0} s"},
    {Reason::kSpeedBelowLeast, "speed-below-least",
     "not scored: the largest speed of {:.1f} deg/s is below {:.1f} deg/s",
     "nicht gewertet: Die gr\u00F6\u00DFte Geschwindigkeit von {0}\u00B0/s liegt unter {1}\u00B0/s"},
    {Reason::kMovementTooShort, "movement-too-short", "not scored: the movement is shorter than 0.03 s",
     "nicht gewertet: Die Bewegung ist k\u00FCrzer als 0,03 s"},
    {Reason::kNoFlexionSensor, "no-flexion-sensor",
     "not measured: the device has no sensor of the flexion of the {}",
     "nicht gemessen: Das Ger\u00E4t hat keinen Sensor f\u00FCr die Beugung ({0})"},
    {Reason::kEntryAngleNotFinite, "entry-angle-not-finite", "an angle is not a finite number",
     "Ein Winkel ist keine endliche Zahl"},
    {Reason::kDigitFollows, "digit-follows", "not measured: the {} follows another digit of this device",
     "nicht gemessen: {0}: folgt bei diesem Ger\u00E4t einem anderen Finger"},
    {Reason::kMixedOrigins, "mixed-origins",
     "the trials have scores of different origins; repeat the exercise",
     "Die Werte der Versuche sind verschiedener Herkunft; bitte die \u00DCbung wiederholen"},

    {Reason::kNotFinished, "not-finished", "not finished: {:d} of {:d} trials",
     "nicht beendet: {0} von {1} Versuchen"},
    {Reason::kTooFewPairs, "too-few-pairs",
     "too few trials: {:d} of {:d} counted, {:d} were discarded; let the participant press more slowly, and "
     "repeat the assessment",
     "zu wenige Versuche: {0} von {1} wurden gewertet, {2} verworfen; bitte langsamer dr\u00FCcken lassen "
     "und die "
     "Messung wiederholen"},
    {Reason::kTooFewObjects, "too-few-objects",
     "too few trials: {:d} of {:d} counted, {:d} were discarded; remove their cause and repeat the "
     "assessment",
     "zu wenige Versuche: {0} von {1} wurden gewertet, {2} verworfen; bitte die Ursache beheben und die "
     "Messung "
     "wiederholen"},
    {Reason::kMoreWrongThanGuessed, "more-wrong-than-guessed",
     "{:d} of {:d} answers were wrong, more than guesses are: the question may have been understood the "
     "other "
     "way round; explain it, and repeat the assessment",
     "{0} von {1} Antworten waren falsch, mehr als bei Raten: Vielleicht wurde die Frage umgekehrt "
     "verstanden; "
     "bitte erkl\u00E4ren und die Messung wiederholen"},
    {Reason::kNoThresholdShown, "no-threshold-shown",
     "{:d} of {:d} answers were right: no threshold below {:.0f} % can be shown",
     "{0} von {1} Antworten waren richtig: Eine Schwelle unter {2} % l\u00E4sst sich nicht zeigen"},
    {Reason::kThresholdTooSmall, "threshold-too-small",
     "{:d} of {:d} answers were right: the threshold is below {:.1f} %, less than this assessment can "
     "measure",
     "{0} von {1} Antworten waren richtig: Die Schwelle liegt unter {2} %, weniger als diese Messung "
     "erfassen "
     "kann"},
    {Reason::kNoStiffnessWhilePressed, "no-stiffness-while-pressed",
     "no stiffness was sent while it was pressed", "Beim Dr\u00FCcken wurde keine Steifigkeit gesendet"},
    {Reason::kNoStiffness, "no-stiffness", "no stiffness was sent", "Es wurde keine Steifigkeit gesendet"},
    {Reason::kSentStiffnessDiffers, "sent-stiffness-differs",
     "the stiffness that was sent differs from the commanded one by more than 10 %; press more slowly",
     "Die gesendete Steifigkeit weicht um mehr als 10 % von der vorgegebenen ab; bitte langsamer "
     "dr\u00FCcken"},
    {Reason::kPressFault, "press-fault", "the press does not count: a fault or a missing sample during it",
     "Das Dr\u00FCcken z\u00E4hlt nicht: St\u00F6rung oder fehlender Messwert w\u00E4hrenddessen"},
    {Reason::kPressRamped, "press-ramped", "the press does not count: the torque was off or ramped during it",
     "Das Dr\u00FCcken z\u00E4hlt nicht: Das Drehmoment war w\u00E4hrenddessen aus oder lief hoch oder "
     "herunter"},
    {Reason::kPressTooShort, "press-too-short",
     "the press does not count: {:d} samples of the sent stiffness instead of {:d}; press longer",
     "Das Dr\u00FCcken z\u00E4hlt nicht: {0} Werte der gesendeten Steifigkeit statt {1}; bitte l\u00E4nger "
     "dr\u00FCcken"},
    {Reason::kPressTooFast, "press-too-fast",
     "the press does not count: {:.0f} % of the samples were not within 10 % of the commanded stiffness; "
     "press "
     "more slowly",
     "Das Dr\u00FCcken z\u00E4hlt nicht: {0} % der Werte lagen nicht innerhalb von 10 % der vorgegebenen "
     "Steifigkeit; "
     "bitte langsamer dr\u00FCcken"},

    {Reason::kTorqueNotFullyOn, "torque-not-fully-on", "the torque was not fully on",
     "Das Drehmoment war nicht voll eingeschaltet"},
    {Reason::kTouchedTooShortly, "touched-too-shortly", "the object was touched for less than {} s",
     "Der Gegenstand wurde k\u00FCrzer als {0} s ber\u00FChrt"},
    {Reason::kEndPositionNotReached, "end-position-not-reached",
     "the end position was not reached within {} s",
     "Die Endstellung wurde nicht innerhalb von {0} s erreicht"},
    {Reason::kTrialPaused, "trial-paused", "it was paused", "durch eine Pause unterbrochen"},
    {Reason::kTrialSkipped, "trial-skipped", "a person has skipped it", "von einer Person \u00FCbersprungen"},
    {Reason::kAllTrialsDone, "all-trials-done", "all trials are done", "Alle Versuche sind gemacht"},
    {Reason::kDoseOfRepetitionsDone, "dose-of-repetitions-done", "the day's dose of {:d} repetitions is done",
     "Die Tagesdosis von {0} Wiederholungen ist erreicht"},
    {Reason::kDoseOfMinutesDone, "dose-of-minutes-done", "the day's dose of {} minutes is done",
     "Die Tagesdosis von {0} Minuten ist erreicht"},
    {Reason::kPersonEnded, "person-ended", "a person has ended it", "von einer Person beendet"},
    {Reason::kPainLimit, "pain-limit", "pain {:d} of 10 has reached the limit {:d}",
     "Schmerz {0} von 10 hat die Grenze {1} erreicht"},
    {Reason::kFatigueLimit, "fatigue-limit", "fatigue {:d} of 10 has reached the limit {:d}",
     "Erm\u00FCdung {0} von 10 hat die Grenze {1} erreicht"},
    {Reason::kNotEnded, "not-ended", "it has not ended", "nicht zu Ende gef\u00FChrt"},

    {Reason::kOneStepMissingInRecording, "one-step-missing-in-recording",
     "not scored: 1 step is missing in the recording",
     "nicht gewertet: In der Aufzeichnung fehlt 1 Abtastschritt"},
    {Reason::kStepsMissingInRecording, "steps-missing-in-recording",
     "not scored: {:d} steps are missing in the recording",
     "nicht gewertet: In der Aufzeichnung fehlen {0} Abtastschritte"},
    {Reason::kRecordingEndsBefore, "recording-ends-before",
     "not scored: the recording ends before the exercise",
     "nicht gewertet: Die Aufzeichnung endet vor der \u00DCbung"},
    {Reason::kNoResultFromRecording, "no-result-from-recording",
     "not scored: no result could be made from the recording",
     "nicht gewertet: Aus der Aufzeichnung lie\u00DF sich kein Ergebnis bilden"},
    {Reason::kNoRecordedValue, "no-recorded-value", "the recorded result has no value",
     "Das aufgezeichnete Ergebnis hat keinen Wert"},
    {Reason::kOtherResult, "other-result",
     "the same steps and inputs give another result; first difference at byte {:d}: recorded \"{}\", now "
     "\"{}\"",
     "Dieselben Abtastschritte und Eingaben ergeben ein anderes Ergebnis; erster Unterschied bei Byte {0}"},
    {Reason::kOtherResultOneMissing, "other-result-one-missing",
     "1 step is missing in the recording; first difference at byte {:d}: recorded \"{}\", now \"{}\"",
     "In der Aufzeichnung fehlt 1 Abtastschritt; erster Unterschied bei Byte {0}"},
    {Reason::kOtherResultMissing, "other-result-missing",
     "{:d} steps are missing in the recording; first difference at byte {:d}: recorded \"{}\", now \"{}\"",
     "In der Aufzeichnung fehlen {0} Abtastschritte; erster Unterschied bei Byte {1}"},
    {Reason::kOtherResultBits, "other-result-bits",
     "{:d} steps have other bits ({}); first difference at byte {:d}: recorded \"{}\", now \"{}\"",
     "{0} Abtastschritte sind nicht bitgleich; erster Unterschied bei Byte {2}"},
    {Reason::kOtherResultVersion, "other-result-version",
     "another version recorded it: {}; first difference at byte {:d}: recorded \"{}\", now \"{}\"",
     "mit einer anderen Version aufgezeichnet ({0}); erster Unterschied bei Byte {1}"},
    {Reason::kOtherResultMachine, "other-result-machine",
     "it was recorded on {}, whose mathematical functions round otherwise; first difference at byte {:d}: "
     "recorded \"{}\", now \"{}\"",
     "auf {0} aufgezeichnet, dessen mathematische Funktionen anders runden; erster Unterschied bei Byte {1}"},

    {Reason::kStepFaultAt, "step-fault-at", "not scored: {} at {:.3f} s; repeat the trial",
     "nicht gewertet: {0} (bei {1} s); bitte den Versuch wiederholen"},
    {Reason::kNotCounted, "not-counted", "not counted: {}", "nicht gewertet: {0}"},
    {Reason::kNotProven, "not-proven", "not proven: {}", "nicht belegt: {0}"},
}};

static_assert([] {
  for (std::size_t i = 0; i < kReasons.size(); ++i)
    if (kReasons[i].reason != static_cast<Reason>(i) || kReasons[i].german.empty()) return false;
  return true;
}());

/// Makes the English text of a reason, which is stored. The compiler checks the arguments.
template <Reason kReason, typename... Args>
[[nodiscard]] std::string reason_text(const Args&... args) {
  static constexpr std::string_view kFormat = kReasons[static_cast<std::size_t>(kReason)].english;
  return fmt::format(fmt::format_string<const Args&...>(kFormat), args...);
}

/// @returns the reason with this English text; nothing if there is none
[[nodiscard]] std::optional<Reason> find_reason(std::string_view english);
/// @returns the reasons of a stored text that "; " joins; none if a part of it is not in kReasons
[[nodiscard]] std::vector<Reason> find_reasons(std::string_view english);
/// @returns ReasonWords::code
[[nodiscard]] constexpr std::string_view reason_code(Reason reason) noexcept {
  return kReasons[static_cast<std::size_t>(reason)].code;
}

/// @returns a word between those of a reason in German: name of a digit, joint or origin of an angle
using ReasonWord = std::function<std::string(std::string_view)>;

/// Translates a stored reason, also several that "; " joins. Numbers have a decimal comma; any other text between
/// the words of a reason is a reason itself, or it is given to `word`.
/// @returns an empty text if it is not made of kReasons
[[nodiscard]] std::string german_reason(std::string_view english, const ReasonWord& word);

}  // namespace phalanx
