// The duties of a real node in place of a simulated one: the frames that it must send, and the lists that it may
// read. They follow from cluster, node and time scale alone.
//
// Durations are in real time, on the cluster's clock: the schedule's, stretched. Instants count from the begin of
// their cycle. Each frame must be on the bus within the arrival window around its instant. Lengths are bytes, places
// in a list bits.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/ids.h"
#include "core/time.h"
#include "schedules/model/cluster.h"

namespace ttf::cli::launch::external {

// A frame of a static slot, in every cycle c with c mod repetition == base_cycle. Its identifier on a CAN is the slot.
struct SlotDuty {
  int slot = 0, base_cycle = 0, repetition = 1;
  schedules::model::Channels channels{};
  Duration due{};  // the action point of the slot
  int payload_bytes = 0;
  std::vector<std::size_t> can_lengths;  // its CAN FD frames' data; one, or fragments
  // The frame's header: indicators, slot, length and header CRC, the same in every cycle. The lower six bits of the last
  // byte are the cycle count, here 0. A null frame lacks the bit 0x20 of the first byte.
  std::array<std::uint8_t, 5> header{};
  bool sync = false, startup = false;
  PduId pdu = kNoPdu;  // none: a status frame, whose payload has no meaning
  int fragment = 0;
};

enum class CanDutyKind : std::uint8_t { kList, kTrigger, kStrobe };

// A frame on a private CAN.
struct CanDuty {
  CanDutyKind kind = CanDutyKind::kList;
  std::size_t can_bus = 0;
  std::uint32_t identifier = 0;
  bool flexible_data_rate = false;
  std::size_t length = 0;                                 // its data
  PduId pdu = kNoPdu;                                     // a list: one frame for each fragment
  SensorId sensor = kNoSensor;                            // the one whose trigger or strobe it is
  std::optional<Duration> shortest = {};                  // time between two lists
  std::optional<schedules::model::CycleInstant> at = {};  // a scheduled trigger
  Duration due{};                                         // the same, from the begin of its cycle
};

struct Reading {
  PduId pdu = kNoPdu;           // of a list
  SensorId sensor = kNoSensor;  // the one whose line it is
  std::string from;             // "slots 22..34, cycles 1 + 8n", "camera_can, identifier 0x110"
};

struct Duties {
  std::string node;
  Duration cycle{};
  schedules::model::ArrivalWindow window;
  std::vector<SlotDuty> slots;
  std::vector<CanDuty> cans;
  std::vector<Reading> reads;
  std::vector<PduId> lists;  // sent and read, each once
};

// The cluster must be fit for real time (schedules/check/real_time_rules.h).
Duties duties_of(const schedules::model::Cluster& cluster, NodeId node, std::int64_t time_scale_ppm);

// "all", "1 + 8n".
std::string cycles_text(int base_cycle, int repetition);

}  // namespace ttf::cli::launch::external
