#include "schedules/model/pdu.h"

namespace ttf::schedules::model {

std::optional<std::size_t> find_signal(const std::vector<Signal>& signals, std::string_view name) {
  for (std::size_t i = 0; i < signals.size(); ++i)
    if (signals[i].name == name) return i;
  return std::nullopt;
}

}  // namespace ttf::schedules::model
