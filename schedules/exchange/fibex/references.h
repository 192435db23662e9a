// Checks the identifiers of a whole FIBEX file: each ID names one element, and each FIBEX reference leads to
// one. The readers (schedules/exchange/fibex/file.h) skip unknown parts; without this check a broken reference
// in them, and all that depends on it, would be dropped silently.
#pragma once

#include "core/errors.h"
#include "schedules/exchange/fibex/xml.h"

namespace ttf::schedules::exchange::fibex {

// Adds to `wrong`, in the order of the file:
//   an ID that an earlier element has (xs:ID: one namespace for all kinds of element),
//   an ID-REF without its element, or to an element of another kind than CHANNEL-REF, PDU-REF, ... require,
//   a CHANNEL-REF, PDU-REF, ... without ID-REF.
void check_references(const XmlFile& file, Findings& wrong);

}  // namespace ttf::schedules::exchange::fibex
