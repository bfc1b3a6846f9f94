// SPDX-License-Identifier: Apache-2.0

/// Length of a force's arrow: 12 mm for each newton, up to 15 N.
export const arrowMetresPerNewton = 0.012;
export const arrowLargestForce = 15;
