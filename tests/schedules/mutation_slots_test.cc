#include <gtest/gtest.h>

#include "tests/schedules/mutation.h"

namespace ttf::schedules {
namespace {

TEST(Mutations, OfSlotsPdusAndCans) {
  expect_named({
      {"slot_owned_twice", "slot: 6,", "slot: 5,", {"pdu: laser_objects, fragments: 9", "frames.slot 5",
       "gateway on AB", "owned twice"}},
      {"slot_beyond", "slot: 22,", "slot: 32,", {"pdu: image, fragments: 13", "frames.slot 41", "41", "1..40"}},
      {"repetition", "repetition: 8, pdu: image", "repetition: 6, pdu: image", {"pdu: image, fragments: 13",
       "frames[7].repetition", "6", "1, 2, 4, 8, 16, 32, 64"}},
      {"base_cycle", "base_cycle: [0-9], repetition: 8, pdu: image", "base_cycle: 8, repetition: 8, pdu: image",
       {"pdu: image, fragments: 13", "frames[7].base_cycle", "8", "0..7"}},
      {"fragment_without_slot", "pdu: image, fragments: 13", "pdu: image, fragments: 12",
       {"pdu: image, fragments: 12", "frames.image", "", "fragment 12 has none"}},
      {"fragments_beyond", "pdu: image, fragments: 13", "pdu: image, fragments: 1010",
       {"pdu: image, fragments: 1010", "frames[7].fragments", "1010", "at most 1002: static slots end at 1023"}},
      {"fragment_too_many", "pdu: image, fragments: 13", "pdu: image, fragments: 14", {"pdu: image, fragments: 14",
       "frames.slot 35", "fragment 13", "0..12"}},
      {"payload", "gPayloadLengthStatic: 28", "gPayloadLengthStatic: 27", {"pdu: laser_objects, fragments: 9",
       "frames.slot 6", "laser_objects (56 bytes)", "54 bytes"}},
      {"network_management_without_vector", "(slot: 5, .*)\\}", "$01, network_management: true}",
       {"slot: 5", "frames.slot 5", "network_management: true", "gNetworkManagementVectorLength is 0"}},
      {"network_management_without_room",
       "(gNetworkManagementVectorLength: )0([^~]*pdu: laser_objects, fragments: 9)\\}",
       "$012$02, network_management: true}",
       {"pdu: laser_objects, fragments: 9", "frames.slot 6", "network_management: true (58 bytes)",
        "payload of 56 bytes (gPayloadLengthStatic): the vector's 2 bytes and the fragment's 56"}},
      {"sender_off_flexray", "(slot: 5, channels: AB, sender: )feature", "$01camera", {"slot: 5", "frames.slot 5",
       "camera", "FlexRay controller"}},
      {"slots_of_another", "(slot: 22, channels: AB, sender: )fusion", "$01gateway",
       {"writes: {image: image on flexray}", "nodes.fusion.tasks.publish.writes.image", "image on flexray",
       "slots that fusion owns"}},
      {"pdu_too_long", "(image:\\s+fragment_bytes: )56", "$0148", {"fragment_bytes: 48", "pdus.image.fragment_bytes",
       "48", "at least 56"}},
      {"pdu_without_sequence", "\\{name: sequence, bits: 16\\}", "{name: sequel, bits: 16}", {"name: sequel",
       "pdus.laser_scan.header", "", "sequence"}},
      {"pdu_count_bits", "\\{name: count, bits: 16\\}", "{name: count, bits: 10}", {"name: sequence",
       "pdus.laser_scan.header", "", "enough bits for 1300"}},
      {"signal_range", "high: 200,", "high: 2000,", {"name: range", "pdus.laser_scan.element[2].high", "2000",
       "does not fit 16 bits"}},
      {"can_identifier", "(pdu: camera_objects, identifier: )[0-9]+(.*)",
       "$01999$2\n      - {pdu: laser_scan, identifier: 999, sender: laser, shortest_period: 79 ms}",
       {"pdu: laser_scan, identifier: 999", "can.observation_can.messages.laser_scan", "identifier 999", "unique"}},
      {"can_length", inside("laser_can", "flexible_data_rate") + "true\n.*\n.*data_bit_rate.*",
       "$01false\n    nominal_bit_rate: 1000000", {"pdu: laser_scan, identifier: 256",
       "can.laser_can.messages.laser_scan", "64 bytes", "at most 8 bytes"}},
      {"can_load", inside("laser_can", "other_load") + "0.0", "$010.7", {"flexible_data_rate: true", "can.laser_can",
       "worst-case load 89.8 %", "at most 80 %"}},
      {"can_sender", "(pdu: laser_scan.*sender: )laser", "$01camera", {"writes: {raw: laser_scan on laser_can}",
       "nodes.laser.tasks.measure.writes.raw", "laser_scan on laser_can", "a message that laser sends"}},
      {"two_senders", "pdu: camera_objects, fragments: 7\\}",
       "pdu: camera_objects, fragments: 6}\n"
       "  - {slot: 21, channels: AB, sender: feature, base_cycle: 0, repetition: 1"
       ", pdu: camera_objects, fragments: 1, first_fragment: 6}",
       {"pdu: camera_objects, fragments: 1", "frames.slot 21", "feature", "one sender"}},
      {"fragment_twice", "(.*pdu: camera_objects, fragments: 7\\})",
       "$01\n"
       "  - {slot: 36, channels: AB, sender: gateway, base_cycle: 0, repetition: 1"
       ", pdu: camera_objects, fragments: 1}",
       {"pdu: camera_objects, fragments: 1", "frames.slot 36", "camera_objects, fragment 0",
       "above fragment 6 of slot 21"}},
      {"fragments_out_of_order", "slot: 15,(.*), pdu: camera_objects, fragments: 7\\}",
       "slot: 15,$01, pdu: camera_objects, fragments: 1, first_fragment: 6}\n"
       "  - {slot: 16,$01, pdu: camera_objects, fragments: 6}",
       {"pdu: camera_objects, fragments: 6", "frames.slot 16", "camera_objects, fragment 0",
       "above fragment 6 of slot 15"}},
      {"list_twice_in_a_cycle", "(.*)slot: 15,(.*), pdu: camera_objects, fragments: 7\\}",
       "$01slot: 15,$02, pdu: camera_objects, fragments: 7}\n"
       "  - {slot: 35, channels: AB, sender: gateway, base_cycle: 1, repetition: 2"
       ", pdu: camera_objects, fragments: 7}",
       {"pdu: camera_objects, fragments: 7", "frames.slot 35", "camera_objects, fragment 0",
       "slot 15 begins the list too (base cycle 0, repetition 1"}},
      {"fragments_in_a_byte", "elements_per_fragment: 14", "elements_per_fragment: 5", {"max_elements: 1300",
       "pdus.laser_scan.max_elements", "1300", "at most 1280: 256 fragments of 5 elements"}},
      {"signal_twice", "\\{name: layer, bits: 2\\}", "{name: range, bits: 2}", {"name: range",
       "pdus.laser_scan.element[2].name", "range", "earlier signal"}},
      {"can_message_twice", "(pdu: laser_scan, identifier: )256(.*)",
       "$01256$2\n      - {pdu: laser_scan, identifier: 257, sender: laser, shortest_period: 79 ms}",
       {"pdu: laser_scan, identifier: 257", "can.laser_can.messages.laser_scan", "laser_scan",
       "one message of its CAN only"}},
      {"can_period_of_a_slow_clock", "(pdu: laser_scan.*shortest_period: )[0-9]+ ms", "$0180 ms",
       {"pdu: laser_scan, identifier: 256", "can.laser_can.messages.laser_scan.shortest_period", "80 ms",
       "must be at most 79.78005 ms: the shortest time between two lists of nodes.laser.tasks.measure"}},
      {"can_period_of_a_stage", "(pdu: laser_objects.*shortest_period: )[0-9]+ ms", "$0180 ms",
       {"pdu: laser_objects, identifier: 64", "can.observation_can.messages.laser_objects.shortest_period", "80 ms",
       "shortest time between two lists of nodes.laser_pre.tasks.preprocess"}},
      {"can_response", "(pdu: camera_objects, identifier.*shortest_period: )[0-9]+ ms", "$012500 us",
       {"pdu: camera_objects, identifier: 80", "can.observation_can.messages.camera_objects.shortest_period",
       "2.5 ms", "must be at least 2.6976 ms"}},
  });
}

}  // namespace
}  // namespace ttf::schedules
