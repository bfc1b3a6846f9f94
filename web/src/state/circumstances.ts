// SPDX-License-Identifier: Apache-2.0
// What the steps of a session were made with, numbered, so that a history of numbers holds it. The stiffness is a channel of its own.

/// Empty: not known.
export interface Circumstances {
  readonly scene: string;
  readonly law: string;
  readonly stabiliser: string;
  readonly rate: string; // steps a second [Hz]
  readonly device: string;
  readonly simulated: boolean | undefined; // the device
}

export class CircumstanceNumbers {
  readonly all: Circumstances[] = [];
  private readonly known = new Map<string, number>();

  of(circumstances: Circumstances): number {
    const content = JSON.stringify(circumstances);
    const number = this.known.get(content) ?? this.all.push(circumstances) - 1;
    this.known.set(content, number);
    return number;
  }
}
