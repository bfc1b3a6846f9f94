// SPDX-License-Identifier: Apache-2.0
// The texts of the page in the language in use. Another language is a second object of the type Strings.
import { en, type Strings } from "./en";

export type { Strings };
export const strings: Strings = en;
