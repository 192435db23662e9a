// The lists that a trial's hosts write: full, and all fragments different.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "bus/cni/list_buffer.h"
#include "schedules/model/pdu.h"

namespace ttf::experiments::campaign {

// Writes the list of this number into `bytes`, which the returned list refers to.
bus::cni::ListView full_list(const schedules::model::PduLayout& layout, std::uint32_t number,
                             std::vector<std::byte>& bytes);

}  // namespace ttf::experiments::campaign
