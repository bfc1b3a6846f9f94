// SPDX-License-Identifier: Apache-2.0
// Where an object ends, in sliding mode: the measured digit is clear of the object though a contact holds the shown
// one. It has passed the object's end, or gone through it. See docs/sliding.md.
#pragma once

#include "contact/gdp_digit.h"

namespace phalanx {

/// Brings a digit that is held though its measured one is clear of the object to where that is. Until then its forces
/// fade: DigitContacts::force_share(). Then it goes round the object, without contacts, if one of a few ways is free,
/// in the ticks that a millimetre in each millisecond needs; else it is shown where it is measured at once. A measured
/// digit that is not clear any more ends this.
/// @returns true if the digit has been dealt with for this tick, and has no contacts
/// Real-time: bounded, no allocation, lock, throw or I/O.
bool goes_round(const ContactModel& model, DigitTick& tick, GdpState& state) noexcept;

}  // namespace phalanx
