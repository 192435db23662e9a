// What holds of a whole FIBEX file, whoever reads which part of it: an ID names one element, and a reference leads to
// one. The parts are read as far as they are understood (schedules/exchange/fibex/file.h); a reference that nobody
// follows would else be passed over in silence, and with it what hangs on it.
#pragma once

#include "core/errors.h"
#include "schedules/exchange/fibex/xml.h"

namespace ttf::schedules::exchange::fibex {

// Adds to `wrong`, in the order of the file:
//   an ID that an element before has (xs:ID: one namespace for all kinds of element),
//   an ID-REF to an ID that no element has, or to one of another kind than CHANNEL-REF, PDU-REF, ... say,
//   one of these without ID-REF.
void check_references(const XmlFile& file, Findings& wrong);

}  // namespace ttf::schedules::exchange::fibex
