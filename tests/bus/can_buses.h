// Two CANs for tests, each of 1 Mbit/s: a nominal bit is a microsecond.
#pragma once

#include "schedules/model/cluster.h"

namespace ttf::bus {

inline schedules::model::CanBus classic() {
  schedules::model::CanBus bus;
  bus.name = "classic";
  bus.nominal_bit_rate = bus.data_bit_rate = 1'000'000;
  return bus;
}

// CAN FD, with data of 5 Mbit/s.
inline schedules::model::CanBus fast() {
  schedules::model::CanBus bus = classic();
  bus.name = "fast";
  bus.flexible_data_rate = true;
  bus.data_bit_rate = 5'000'000;
  return bus;
}

}  // namespace ttf::bus
