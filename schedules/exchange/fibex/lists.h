// Lists of ours (schedules/model/pdu.h) in FIBEX, and back.
//
// A list NAME is a multiplexed PDU of fragment_bytes bytes. Its static part is the PDU NAME_header with the
// header signals; its switch is the header signal "fragment"; for each fragment the dynamic part is one and
// the same PDU NAME_elements, with the signals of the first element (x_0, y_0, ...), of the second (x_1, y_1,
// ...), and so on. All lie most significant bit first, without gaps ("spare" signals included), the elements
// behind the header's last byte.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "schedules/exchange/fibex/file.h"
#include "schedules/model/pdu.h"

namespace ttf::schedules::exchange::fibex {

struct ListFound {
  std::optional<model::PduLayout> layout;  // complete but for the sensor
  std::string reason;                      // why the PDU is no list, else
};

ListFound as_list(const FibexPdu& pdu, const std::map<std::string, const FibexPdu*>& by_id);

}  // namespace ttf::schedules::exchange::fibex
