// SPDX-License-Identifier: Apache-2.0
// The rigid parts of a hand, in the stream's order.

export const kSegments = 16;
export const kSegmentsPerDigit = 3;
export const kPalm = kSegments - 1;
