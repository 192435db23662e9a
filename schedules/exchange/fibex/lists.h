// Converts our lists (schedules/model/pdu.h) to FIBEX and back.
//
// A list NAME is a multiplexed PDU of fragment_bytes bytes. Its static part is the PDU NAME_header with the
// header signals; its switch is the header signal "fragment". For each fragment the dynamic part is the same PDU
// NAME_elements. This PDU has the signals of the first element (x_0, y_0, ...), of the second (x_1, y_1, ...),
// and so on. All are most significant bit first, without gaps ("spare" signals included); the elements follow
// the header's last byte.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "schedules/exchange/fibex/file.h"
#include "schedules/model/pdu.h"

namespace ttf::schedules::exchange::fibex {

struct ListFound {
  std::optional<model::PduLayout> layout;  // complete except for the sensor
  std::string reason;                      // without a layout: why the PDU is not a list
};

ListFound as_list(const FibexPdu& pdu, const std::map<std::string, const FibexPdu*>& by_id);

}  // namespace ttf::schedules::exchange::fibex
