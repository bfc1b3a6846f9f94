// SPDX-License-Identifier: Apache-2.0
// Which calibration of the station is offered to be bound to a patient: only files that have changed since the therapist opened the cockpit's
// dialog for that patient, and only if no exercise has begun since. An exercise brings the calibration of its own patient.
import type { CalibrationFiles } from "../wire/calibration_channel";
import { isUnderWay, type ExerciseNow } from "./exercise_now";

export interface OfferedFiles extends CalibrationFiles {
  readonly isNew: boolean; // the calibration has changed; else it only tells which one a new range belongs to
}

const kAnswers = 2;

interface Begun {
  readonly record: string;
  before: CalibrationFiles | undefined; // absent: no cockpit has told anything yet
  number: number | undefined; // of the newest exercise; absent: not known yet
}

export class CalibrationOffer {
  private newest: CalibrationFiles | undefined;
  private begun: Begun | undefined;
  private answers = 0; // since the newest files: the first one may have been asked for before them
  private checked: CalibrationFiles | undefined; // the files of which it is known that no exercise brought them

  /// @param watches  exercises are watched: files are offered after the next answers about them
  constructor(private readonly watches: () => boolean) {}

  /// The dialog is opened for a patient. @param now  the newest answer about the exercise
  begin(record: string, now: ExerciseNow | undefined): void {
    this.begun = now && isUnderWay(now) ? undefined : { record, before: this.newest, number: now?.number };
    this.checked = undefined;
  }

  end(): void {
    this.begun = this.checked = undefined;
  }

  /// A cockpit has told what the station uses.
  told(files: CalibrationFiles): void {
    this.newest = files;
    this.answers = 0;
    const { begun } = this;
    if (!begun) return;
    if (!begun.before) begun.before = files; // of a cockpit that has just been opened: from before its dialog
    else if (!this.watches()) this.checked = files;
  }

  /// The station has answered which exercise runs. @returns whether something else is offered now
  heard(now: ExerciseNow): boolean {
    const { begun, checked } = this;
    if (!begun) return false;
    begun.number ??= now.number;
    if (isUnderWay(now) || now.number !== begun.number) {
      this.end();
      return checked !== undefined;
    }
    if (++this.answers < kAnswers) return false;
    this.checked = this.newest === begun.before ? undefined : this.newest;
    return this.checked !== checked;
  }

  /// What is offered for a patient; a range that has not changed is left out. undefined: nothing
  of(record: string): OfferedFiles | undefined {
    const { begun, checked } = this;
    if (!begun?.before || !checked || begun.record !== record) return undefined;
    const { calibration, range } = checked;
    return { calibration, isNew: calibration !== begun.before.calibration, range: range === begun.before.range ? "" : range };
  }
}
