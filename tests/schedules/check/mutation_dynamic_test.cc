// Mistakes about the dynamic segment, channels and key slots, in the cluster that uses them.
#include <gtest/gtest.h>

#include "tests/schedules/check/mutation.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::check {
namespace {

TEST(Mutations, OfDynamicSlots) {
  expect_named(
      {
          {"slot_beyond_the_minislots",
           "slot: 23, ",
           "slot: 100, ",
           {"slot: 100", "frames[8] (slot 101)", "101",
            "must be 1..100 (gNumberOfStaticSlots and a dynamic one per minislot)"}},
          {"slot_beyond_all", "slot: 23, ", "slot: 2048, ", {"slot: 2048", "frames[8].slot", "2048", "1..2047"}},
          {"fragments_beyond_all",
           "slot: 23, (.*)fragments: 2",
           "slot: 2047, $01fragments: 2",
           {"slot: 2047", "frames[8].fragments", "2", "at most 1: dynamic slots end at 2047"}},
          {"no_pdu",
           "(slot: 23, .*), pdu: camera_objects, fragments: 2",
           "$01",
           {"slot: 23", "frames[8] (slot 23)", "camera_pre", "needs a PDU in the dynamic segment (slots above 20)"}},
          {"vector",
           "(pdu: camera_objects, fragments: 2)",
           "$01, network_management: true",
           {"slot: 23", "frames[8] (slot 23)", "network_management: true", "needs a static slot, 1..20"}},
          {"owned_twice",
           "slot: 23, ",
           "slot: 22, ",
           {"slot: 22", "frames[8] (slot 22)", "camera_pre on AB", "owned twice: laser_pre on AB"}},
          {"list_in_both_segments",
           "slot: 7, ",
           "slot: 18, ",
           {"slot: 18", "frames[6] (slot 21)", "21",
            "must be 1..20 (gNumberOfStaticSlots) as slot 18 is: a list is sent in one segment"}},
          {"latest_tx",
           "pLatestTx: 69",
           "pLatestTx: 70",
           {"pLatestTx: 70", "nodes.laser_pre.flexray.pLatestTx", "70",
            "must be at most 69: slot 21 with 28 words takes 12 of 80 minislots"}},
          {"never_its_turn",
           "slot: 23, ",
           "slot: 90, ",
           {"slot: 90", "frames[8] (slot 90)", "90", "must be at most 89: its earliest turn is in minislot 70"}},
          {"segment_too_short",
           "gNumberOfMinislots: 80",
           "gNumberOfMinislots: 11",
           {"slot: 21", "frames[7] (slot 21)", "laser_objects",
            "must fit the dynamic segment: slot 21 with 28 words takes 12 of 11 minislots"}},
          {"minislot_action_point",
           "gdMinislotActionPointOffset: 3",
           "gdMinislotActionPointOffset: 2",
           {"gdMinislotActionPointOffset: 2", "flexray.gdMinislotActionPointOffset", "2",
            "must be at least 3 macroticks"}},
          {"minislot",
           "gdMinislot: 7",
           "gdMinislot: 6",
           {"gdMinislot: 6", "flexray.gdMinislot", "6",
            "must be at least 7 macroticks if the dynamic segment is used"}},
          {"idle_phase",
           "gdDynamicSlotIdlePhase: 1",
           "gdDynamicSlotIdlePhase: 0",
           {"gdDynamicSlotIdlePhase: 0", "flexray.gdDynamicSlotIdlePhase", "0", "must be at least 1 minislots"}},
          // The laser's two frames may take minislots 1 to 24; the camera's first may begin in 25, its second
          // in 37.
          {"age_without_bound",
           "pLatestTx: 69 ",
           "pLatestTx: 36 ",
           {"slot: 23", "frames[8] (slot 24)", "camera_objects",
            "by minislot 36 (pLatestTx of camera_pre) in every cycle, but has it in minislot 37 if all slots before it "
            "are used: the age of measurements of camera would have no bound"}},
          {"image_without_bound",
           "slot: 7, ",
           "slot: 85, ",
           {"slot: 85", "frames[6] (slot 85)", "image", "fusion computes it from measurements"}},
          {"symbol_window",
           "gdSymbolWindow: 13([^~]*gdNIT: )427",
           "gdSymbolWindow: 12$01428",
           {"gdSymbolWindow: 12", "flexray.gdSymbolWindow", "12",
            "must be 0 (none) or at least 13 macroticks (constraint 16)"}},
          {"guardian",
           "topology: star",
           "topology: bus",
           {"guardian: true", "guardian", "true", "needs topology: star"}},
          {"vector_without_length",
           "gNetworkManagementVectorLength: 4",
           "gNetworkManagementVectorLength: 0",
           {"slot: 1,", "frames[0] (slot 1)", "network_management: true", "gNetworkManagementVectorLength is 0"}},
          {"vector_without_room",
           "(pdu: image, fragments: 4)",
           "$01, network_management: true",
           {"slot: 7", "frames[6] (slot 7)", "network_management: true (36 bytes)", "payload of 32 bytes"}},
      },
      "flexray_demo");
}

// A list that activates a task needs a bound, regardless of its content.
TEST(Mutations, OfAListThatActivatesATask) {
  const std::string text = support::replaced(
      support::replaced(shipped_text("flexray_demo"), "pLatestTx: 69", "pLatestTx: 36"),
      "\\{kind: time, base_cycle: 0, repetition: 8, offset: 1600\\}", "{kind: message, port: camera}");
  ASSERT_NE(text, shipped_text("flexray_demo"));
  EXPECT_NE(sentences(findings_of(support::replaced(text, "    sensor: camera\n    fragment_bytes: 56",
                                                    "    fragment_bytes: 56")))
                .find("it activates nodes.fusion.tasks.fuse"),
            std::string::npos);
}

TEST(Mutations, OfChannels) {
  const std::string own = "(camera_pre:\n    flexray: \\{)";
  expect_named(
      {
          {"not_attached",
           own,
           "$01pChannels: A, ",
           {"slot: 2,", "frames[1] (slot 2)", "camera_pre on AB",
            "must be sent on A only: camera_pre is not attached to more (pChannels)"}},
          {"wakeup_channel",
           own,
           "$01pChannels: A, ",
           {"pChannels: A, pKeySlotId: 2", "nodes.camera_pre.flexray.pWakeupChannel", "B",
            "must be a channel that camera_pre is attached to (pChannels = A)"}},
          {"channels", "pChannels: AB", "pChannels: C", {"pChannels: C", "node_parameters.pChannels", "C", "A, B, AB"}},
          {"wakeup_channel_name",
           "pWakeupChannel: A\n",
           "pWakeupChannel: AB\n",
           {"pWakeupChannel: AB", "node_parameters.pWakeupChannel", "AB", "A, B"}},
          {"key_slot_on_one_channel",
           "slot: 2, channels: AB",
           "slot: 2, channels: A",
           {"pKeySlotId: 2", "nodes.camera_pre.flexray.pKeySlotId", "2",
            "a static slot that camera_pre owns on both channels in every cycle"}},
          {"key_slot_dynamic",
           "pKeySlotId: 2",
           "pKeySlotId: 23",
           {"pKeySlotId: 23", "nodes.camera_pre.flexray.pKeySlotId", "23", "a static slot that camera_pre owns"}},
          {"reader_not_attached",
           "(fusion:\n    flexray: \\{)([^~]*slot: 23, channels: )AB",
           "$01pChannels: A, $02B",
           {"reads: {laser: laser_objects on flexray, camera", "nodes.fusion.tasks.fuse.reads.camera",
            "camera_objects on flexray",
            "must be sent on A: fusion is attached to no other channel (pChannels), and slot 23 (line"}},
          {"key_slot_only",
           own,
           "$01pKeySlotOnlyEnabled: true, ",
           {"pKeySlotOnlyEnabled: true", "nodes.camera_pre.flexray.pKeySlotOnlyEnabled", "true",
            "must be false: camera_pre also has slot 23"}},
      },
      "flexray_demo");
}

}  // namespace
}  // namespace ttf::schedules::check
