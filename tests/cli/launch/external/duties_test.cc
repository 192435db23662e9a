// The duties of real nodes, by the shipped clusters.
#include "cli/launch/external/duties.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <sstream>

#include "cli/launch/external/duties_text.h"
#include "schedules/check/real_time_rules.h"
#include "schedules/file/loader.h"

namespace ttf::cli::launch::external {
namespace {

constexpr std::int64_t kReal = schedules::check::kTimeScaleOne;

schedules::model::Cluster cluster_of(const std::string& name) {
  return schedules::file::load_cluster(TTF_SOURCE_DIR "/schedules/" + name + ".yaml");
}

struct DutiesOfAPaperNode : testing::Test {
  schedules::model::Cluster cluster = cluster_of("paper_synchronised");
  Duties of(const std::string& node, std::int64_t scale = kReal) const {
    return duties_of(cluster, *cluster.find_node(node), scale);
  }
};

TEST_F(DutiesOfAPaperNode, AKeySlotHasItsInstantAndItsHeader) {
  const Duties duties = of("camera_pre");
  ASSERT_EQ(duties.slots.size(), 1u);
  const SlotDuty& slot = duties.slots.front();
  EXPECT_EQ(slot.slot, 2);
  EXPECT_EQ(slot.due, Duration::microseconds(84 + 7));
  EXPECT_TRUE(slot.sync && slot.startup);
  EXPECT_EQ(slot.payload_bytes, 56);
  EXPECT_EQ(slot.can_lengths, std::vector<std::size_t>{64});
  // Valid payload, sync, startup, slot 2, 28 words, header CRC, cycle 0.
  EXPECT_EQ(slot.header[0], 0x38);
  EXPECT_EQ(slot.header[1], 0x02);
  EXPECT_EQ(slot.header[2] >> 1, 28);
  EXPECT_EQ(slot.header[4] & 0x3F, 0);
}

TEST_F(DutiesOfAPaperNode, AHostHasMessagesAndItsSensorsTrigger) {
  const Duties duties = of("camera_pre");
  ASSERT_EQ(duties.cans.size(), 2u);
  const CanDuty& list = duties.cans[0];
  EXPECT_EQ(list.kind, CanDutyKind::kList);
  EXPECT_EQ(list.identifier, 80u);
  EXPECT_TRUE(list.flexible_data_rate);
  EXPECT_EQ(list.length, 64u);  // 56, and CAN FD's next
  EXPECT_EQ(list.shortest, Duration::milliseconds(20));
  const CanDuty& trigger = duties.cans[1];
  EXPECT_EQ(trigger.kind, CanDutyKind::kTrigger);
  EXPECT_EQ(trigger.identifier, 4u);
  EXPECT_EQ(trigger.length, 0u);
  EXPECT_EQ(trigger.due, Duration::microseconds(900));
  ASSERT_TRUE(trigger.at);
  EXPECT_EQ(trigger.at->repetition, 8);
  ASSERT_EQ(duties.reads.size(), 2u);
  EXPECT_EQ(duties.reads[0].from, "camera strobe, camera_can, identifier 0x003");
  EXPECT_EQ(duties.reads[1].from, "camera_can, identifier 0x110");
}

TEST_F(DutiesOfAPaperNode, ADeviceStrobesAndAServiceReads) {
  const Duties laser = of("laser");
  ASSERT_EQ(laser.cans.size(), 2u);
  EXPECT_TRUE(laser.slots.empty());
  EXPECT_EQ(laser.cans[1].identifier, 1u);
  EXPECT_EQ(laser.cans[1].length, 4u);
  EXPECT_EQ(laser.reads.front().from, "laser trigger, laser_can, identifier 0x002");
  EXPECT_EQ(of("feature").reads.front().from, "slots 22..34, cycles 1 + 8n");
  EXPECT_EQ(of("gateway").slots.size(), 17u);
}

TEST_F(DutiesOfAPaperNode, SlotsOfAListMayLieApart) {
  std::vector<schedules::model::FrameSlot*> image;
  for (schedules::model::FrameSlot& frame : cluster.frames)
    if (frame.pdu == *cluster.find_pdu("image")) image.push_back(&frame);
  ASSERT_EQ(image.size(), 13u);
  image[5]->slot = 35;  // in place of 27
  EXPECT_EQ(of("feature").reads.front().from, "slots 22..26, 28..35, cycles 1 + 8n");
  for (schedules::model::FrameSlot* frame : image)
    frame->slot = frame == image.front() ? 20 : frame == image[1] ? 6 : 22;
  EXPECT_EQ(of("feature").reads.front().from, "slots 6, 20, 22, cycles 1 + 8n");
  for (schedules::model::FrameSlot* frame : image) frame->slot = 35;
  EXPECT_EQ(of("feature").reads.front().from, "slot 35, cycles 1 + 8n");
}

TEST_F(DutiesOfAPaperNode, AStretchedScheduleHasLaterInstants) {
  const Duties duties = of("camera_pre", 3 * kReal);
  EXPECT_EQ(duties.cycle, Duration::milliseconds(15));
  EXPECT_EQ(duties.slots.front().due, Duration::microseconds(3 * 91));
  EXPECT_EQ(duties.cans[0].shortest, Duration::milliseconds(60));
  EXPECT_EQ(duties.window.late, Duration::microseconds(500));  // real time
}

TEST_F(DutiesOfAPaperNode, ALongFrameTravelsInFragments) {
  cluster.flexray.gPayloadLengthStatic = 30;  // 68 bytes in all
  EXPECT_EQ(of("feature").slots.front().can_lengths, (std::vector<std::size_t>{64, 12}));
}

const std::string session = "launch-1234567-1774526400000000";

// Every node of a cluster can be left out, and all lines have at most 100 columns.
TEST(Duties, AreShownWithinAPageForEachNode) {
  const std::vector<std::string> interfaces{"vcan2", "vcan3", "vcan4", "vcan5", "vcan6", "vcan7", "vcan8"};
  for (const std::string name : {"paper_synchronised", "paper_unsynchronised", "two_lasers_synchronised"}) {
    const schedules::model::Cluster cluster = cluster_of(name);
    if (!cluster.arrival_window) continue;
    for (std::size_t n = 0; n < 2 * cluster.nodes.size(); ++n) {
      const Duties duties = duties_of(cluster, static_cast<NodeId>(n / 2), kReal);
      const live_media::Bus bus = live_media::Bus::parse(n % 2 == 0 ? "socketcan:vcan0,vcan1" : "dds");
      std::istringstream text(text_of(duties, {cluster, bus, interfaces, session}));
      for (std::string line; std::getline(text, line);) EXPECT_LE(line.size(), 100u) << name << ": " << line;
      const auto json = json_of(duties, {cluster, bus, interfaces, session});
      EXPECT_EQ(json["slots"].size(), duties.slots.size());
      EXPECT_EQ(json["can_frames"].size(), duties.cans.size());
    }
  }
}

TEST_F(DutiesOfAPaperNode, AreShownWithTheirBits) {
  const std::vector<std::string> interfaces{"vcan2", "vcan3", "vcan4"};
  const live_media::Bus bus = live_media::Bus::parse("socketcan:vcan0");
  const std::string text = text_of(of("camera_pre"), {cluster, bus, interfaces, session});
  EXPECT_NE(text.find("vcan0 is channel A"), std::string::npos) << text;
  EXPECT_NE(text.find("900 us into cycles 1 + 8n"), std::string::npos) << text;
  EXPECT_NE(text.find("-9 to 591"), std::string::npos) << text;
  const auto json = json_of(of("camera_pre"), {cluster, bus, interfaces, session});
  EXPECT_EQ(json["lists"][0]["element"][1]["name"], "y");
  EXPECT_EQ(json["lists"][0]["element"][1]["bit"], 64 + 16);
}

// On a medium without interfaces the topics and fields of samples stand for them.
TEST_F(DutiesOfAPaperNode, AreShownForSamples) {
  const live_media::Bus bus = live_media::Bus::parse("dds");
  const std::vector<std::string> interfaces;
  const std::string text = text_of(of("camera_pre"), {cluster, bus, interfaces, session});
  EXPECT_NE(text.find("ttf/flexray/A is channel A, ttf/flexray/B is channel B"), std::string::npos) << text;
  EXPECT_NE(text.find("ttf/can/observation_can  050"), std::string::npos) << text;
  EXPECT_NE(text.find(session), std::string::npos) << text;
  EXPECT_EQ(text.find("interface"), std::string::npos) << text;
  const auto json = json_of(of("camera_pre"), {cluster, bus, interfaces, session});
  EXPECT_EQ(json["samples"]["partition"], session);
  EXPECT_EQ(json["samples"]["fields"].size(), 12u);
  EXPECT_EQ(json["samples"]["fields"][0]["of_slot"], "3");
  EXPECT_EQ(json["can_frames"][1]["topic"], "ttf/can/camera_can");
  EXPECT_FALSE(json["slots"][0].contains("can_identifier"));
}

}  // namespace
}  // namespace ttf::cli::launch::external
