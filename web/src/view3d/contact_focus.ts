// SPDX-License-Identifier: Apache-2.0
// The contact that a camera follows: the strongest one, which it leaves only for one that is clearly stronger for a while.
import type { Mark } from "./contact_marks";

const kStronger = 1.3; // times as strong as the followed one
const kAtLeast = 0.1; // and by so much [N]
const kPatience = 0.6; // [s] so long another one is stronger, or there is none, before the camera turns to it

export class ContactFocus {
  private segment = -1; // of the followed contact
  private point: readonly [number, number, number] | null = null;
  private doubt = 0; // [s] for which another one has been better

  /// @param seconds  since the call before  @returns the followed contact's place; null: there is none
  update(marks: readonly Mark[], seconds: number): readonly [number, number, number] | null {
    const pressing = marks.filter((mark) => mark.touching);
    const followed = pressing.find((mark) => mark.segment === this.segment);
    const strongest = pressing.reduce<Mark | undefined>((best, mark) => (best && best.force >= mark.force ? best : mark), undefined);
    const better = followed ? strongest!.force > kStronger * followed.force + kAtLeast : this.point !== null || strongest !== undefined;
    this.doubt = better ? this.doubt + seconds : 0;
    if (followed) this.point = followed.point;
    if (better && (this.point === null || this.doubt >= kPatience)) {
      this.segment = strongest?.segment ?? -1;
      this.point = strongest?.point ?? null;
      this.doubt = 0;
    }
    return this.point;
  }

  /// Of another hand or object.
  forget(): void {
    this.segment = -1;
    this.point = null;
    this.doubt = 0;
  }
}
