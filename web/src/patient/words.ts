// SPDX-License-Identifier: Apache-2.0
// The texts of the patient's screen in the language in use.
import { de } from "../strings/patient_de";
import { en, type PatientStrings } from "../strings/patient_en";
import { optionsOf } from "./options";

/// By the code of the language.
export const patientLanguages: Readonly<Record<string, PatientStrings>> = { en, de };

export const words: PatientStrings = patientLanguages[optionsOf(location.search).language] ?? en;

/// Code of the language in use.
export const languageCode: string = Object.keys(patientLanguages).find((code) => patientLanguages[code] === words) ?? "";
