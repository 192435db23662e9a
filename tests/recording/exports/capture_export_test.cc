// Exports, line by line, from records with an exactly known result.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "recording/exports/captures.h"
#include "tests/recording/capture_fixture.h"

namespace ttf::recording::exports {
namespace {

using testing::HasSubstr;

struct Exported {
  FrameCollector collector;
  log::LogManifest manifest;
  Exported() {
    const schedules::model::Cluster cluster = shipped_cluster();
    manifest.scenario_name = "drive";
    for (const schedules::model::Node& node : cluster.nodes) manifest.node_names.push_back(node.name);
    for (const schedules::model::PduLayout& pdu : cluster.pdus) manifest.pdu_names.push_back(pdu.name);
    for (const schedules::model::Sensor& sensor : cluster.sensors) manifest.sensor_names.push_back(sensor.name);
    manifest.can_bus_names = {"laser_can", "a name with spaces", "odd,\"name\""};
    nodes = cluster;
  }
  void can(std::uint8_t bus, std::int64_t end_ns, std::uint32_t id, bool fd, const char* pdu, std::uint32_t sequence) {
    const std::byte data[]{std::byte{0xde}, std::byte{0xad}, std::byte{0x07}};
    collector.on(can_record(bus, end_ns, id, fd, *nodes.find_pdu(pdu), sequence, data));
  }
  records::CanFrameSent can_record(std::uint8_t bus, std::int64_t end_ns, std::uint32_t id, bool fd, PduId pdu,
                                   std::uint32_t sequence, std::span<const std::byte> data) const {
    records::CanFrameSent sent;
    sent.bus = bus;
    sent.end = {{end_ns}, {}, {}, *nodes.find_node("laser")};
    sent.identifier = id;
    sent.flexible_data_rate = fd;
    sent.pdu = pdu;
    sent.sensor = nodes.pdu(pdu).sensor;
    sent.sequence = sequence;
    sent.fragment = 2;
    sent.data = data;
    return sent;
  }
  void flexray(std::int64_t start_ns, int slot, std::uint8_t channel, PduId pdu, bool null_frame,
               int flipped_bit = -1) {
    bus::wire::FrameHeader header;
    header.frame_id = static_cast<std::uint16_t>(slot);
    header.cycle = 9;
    header.null_frame = null_frame;
    header.sync = header.startup = slot == 1;
    const std::byte payload[]{std::byte{1}, std::byte{0xab}};
    std::array<std::byte, 10> bytes{};
    bus::wire::encode_frame(header, static_cast<Channel>(channel), payload, bytes);
    if (flipped_bit >= 0)
      bytes[static_cast<std::size_t>(flipped_bit / 8)] ^= static_cast<std::byte>(0x80 >> flipped_bit % 8);
    records::SlotFrameSent sent;
    sent.stamp = {{start_ns}, {}, {}, *nodes.find_node("gateway")};
    sent.cycle = 73;
    sent.slot = header.frame_id;
    sent.channel = channel;
    sent.null_frame = null_frame;
    sent.pdu = pdu;
    if (pdu != kNoPdu) sent.sensor = nodes.pdu(pdu).sensor;
    sent.sequence = 12;
    sent.bytes = bytes;
    collector.on(sent);
  }
  // The channel's record of a frame of the gateway, sent at `sent_ns`; slot 0: no frame of its controller.
  void on_channel(std::int64_t start_ns, std::int64_t sent_ns, int slot, std::uint8_t channel,
                  records::ChannelState state, std::span<const std::byte> bytes) {
    records::ChannelFrame frame;
    frame.start = frame.end = {start_ns};
    frame.sender = *nodes.find_node("gateway");
    frame.channel = channel;
    frame.state = state;
    frame.slot = static_cast<std::uint16_t>(slot);
    frame.sent = {sent_ns};
    frame.bytes = bytes;
    collector.on(frame);
  }
  void symbol(std::int64_t start_ns, std::int64_t duration_ns, std::uint8_t channel, records::Symbol kind) {
    const NodeId node = *nodes.find_node("gateway");
    const records::Stamp start{{start_ns}, {}, {}, node}, end{{start_ns + duration_ns}, {}, {}, node};
    collector.on(records::SymbolSent{start, end, channel, kind});
  }
  std::string csv() const { return export_csv(collector, collector.in_order(), LogNames(manifest)); }
  std::string candump() const { return export_candump(collector, collector.in_order(), LogNames(manifest)); }
  capture::Capture capture() const {
    return capture::parse_capture(export_pcapng(collector, collector.in_order(), LogNames(manifest)), "drive.pcapng");
  }
  schedules::model::Cluster nodes;
};

TEST(CaptureExport, CandumpLinesAreThoseCanplayerReads) {
  Exported log;
  log.can(0, 1'234'567'891, 0x100, true, "laser_scan", 12);
  log.can(1, 1'000'000'999, 0x7ff, false, "camera_frame", 3);
  log.can(2, -1, 0x800, false, "camera_frame", 4);
  log.flexray(0, 1, 0, kNoPdu, false);
  EXPECT_EQ(log.candump(),
            "(1000000000.000000) odd,\"name\" 00000800#DEAD07\n"
            "(1000000001.000000) can1 7FF#DEAD07\n"
            "(1000000001.234567) laser_can 100##1DEAD07\n");
}

// Errors are as SocketCAN's drivers report them: a bit error of the transmitter with 8 errors, a wrong CRC at a receiver,
// an error-passive transmitter, bus off.
TEST(CaptureExport, ErrorsOnACanAreErrorFrames) {
  Exported log;
  const NodeId laser = *log.nodes.find_node("laser");
  const auto at = [&](std::int64_t ns) { return records::Stamp{{ns}, {}, {}, laser}; };
  log.collector.on(records::CanErrorFrame{at(1'000), 0, records::CanError::kBit, true, 8, 0});
  log.collector.on(records::CanErrorFrame{at(2'000), 0, records::CanError::kCrc, false, 0, 1});
  log.collector.on(
      records::CanStateChanged{at(3'000), 0, records::CanState::kActive, records::CanState::kPassive, 128, 0});
  log.collector.on(
      records::CanStateChanged{at(4'000), 0, records::CanState::kPassive, records::CanState::kBusOff, 256, 0});
  EXPECT_EQ(log.candump(),
            "(1000000000.000001) laser_can 20000288#0000810000000800\n"
            "(1000000000.000002) laser_can 20000288#0000000800000001\n"
            "(1000000000.000003) laser_can 20000204#0020000000008000\n"
            "(1000000000.000004) laser_can 20000240#000000000000FF00\n");
  EXPECT_EQ(log.csv(), csv_header() +
                           "1000,laser_can,,,536871560,laser,can_error,bit error,,,,,0000810000000800\n"
                           "2000,laser_can,,,536871560,laser,can_error,CRC error,,,,,0000000800000001\n"
                           "3000,laser_can,,,536871428,laser,can_error,error passive,,,,,0020000000008000\n"
                           "4000,laser_can,,,536871488,laser,can_error,bus off,,,,,000000000000FF00\n");
  const capture::Capture capture = log.capture();
  ASSERT_EQ(capture.packets.size(), 4u);
  const auto head = capture.data(capture.packets[0]).first(8);
  constexpr std::array kHead{0x20, 0x00, 0x02, 0x88, 0x08, 0x00, 0x00, 0x00};  // the identifier, the length
  for (std::size_t b = 0; b < kHead.size(); ++b) EXPECT_EQ(static_cast<int>(head[b]), kHead[b]) << b;
}

// A damaged log may have a number without words.
TEST(CaptureExport, ErrorsAndStatesHaveWords) {
  EXPECT_EQ(to_text(CanTrouble(records::CanError::kStuff)), "stuff error");
  EXPECT_EQ(to_text(CanTrouble(records::CanState::kActive)), "error active");
  EXPECT_EQ(to_text(CanTrouble(static_cast<records::CanError>(9))), "error 9");
  EXPECT_EQ(to_text(CanTrouble(static_cast<records::CanState>(9))), "state 9");
}

TEST(CaptureExport, RowsNameEverythingAFrameIs) {
  Exported log;
  log.flexray(5, 1, 0, kNoPdu, false);
  log.flexray(6, 6, 1, *log.nodes.find_pdu("laser_objects"), false);
  log.flexray(7, 7, 1, *log.nodes.find_pdu("laser_objects"), true);
  log.flexray(8, 22, 0, *log.nodes.find_pdu("image"), false, 20);
  log.can(0, 9, 0x100, true, "laser_scan", 12);
  log.can(2, 10, 0x110, false, "camera_frame", 3);
  EXPECT_EQ(log.csv(), csv_header() +
                           "5,FlexRay,A,73,1,gateway,frame,sync+startup,,,,,01AB\n"
                           "6,FlexRay,B,73,6,gateway,frame,,laser_objects,12,0,laser 12,01AB\n"
                           "7,FlexRay,B,73,7,gateway,null,,laser_objects,12,0,,01AB\n"
                           "8,FlexRay,A,73,22,gateway,frame,header_crc_error+frame_crc_error,image,12,0,,01AB\n"
                           "9,laser_can,,,256,laser,can_fd,brs,laser_scan,12,2,laser 12,DEAD07\n"
                           "10,\"odd,\"\"name\"\"\",,,272,laser,can,,camera_frame,3,2,camera 3,DEAD07\n");
}

TEST(CaptureExport, PacketsCarryTheMeasurementInTheirComments) {
  Exported log;
  log.flexray(5, 1, 0, kNoPdu, false);
  log.flexray(6, 6, 1, *log.nodes.find_pdu("laser_objects"), false);
  log.flexray(7, 7, 1, *log.nodes.find_pdu("laser_objects"), true);
  log.flexray(8, 22, 0, *log.nodes.find_pdu("image"), false);
  log.can(0, 4, 0x100, true, "laser_scan", 12);
  const capture::Capture capture = log.capture();
  ASSERT_EQ(capture.interfaces.size(), 4u);
  EXPECT_EQ(capture.interfaces[0].link_type, 210u);
  EXPECT_EQ(capture.interfaces[2].link_type, 227u);
  EXPECT_EQ(capture.interfaces[2].name, "a name with spaces");
  std::vector<std::string> comments;
  for (const capture::CapturedPacket& packet : capture.packets) comments.push_back(packet.comment);
  EXPECT_THAT(comments,
              testing::ElementsAre("measurement laser 12: laser_scan, fragment 2", "",
                                   "measurement laser 12: laser_objects, fragment 0", "", "image 12, fragment 0"));
  EXPECT_EQ(capture.packets[0].time_ns, 4);
  EXPECT_EQ(capture.packets[0].interface, 1u);
}

// Five frames lost or changed on the way, and two that no controller sent.
Exported disturbed() {
  Exported log;
  const PduId list = *log.nodes.find_pdu("laser_objects");
  for (const int slot : {6, 7, 8, 9, 10}) log.flexray(slot, slot, 0, list, false);
  bus::wire::FrameHeader header;
  header.frame_id = 6;
  header.cycle = 9;
  const std::array payload{std::byte{1}, std::byte{0xab}};
  std::array<std::byte, 10> bytes{};
  bus::wire::encode_frame(header, Channel::kA, payload, bytes);
  log.on_channel(16, 6, 6, 0, {}, bytes);  // late
  bytes[6] = std::byte{0xaa};
  log.on_channel(7, 7, 7, 0, records::ChannelState::kFrameCrc, bytes);
  log.on_channel(8, 8, 8, 0, records::ChannelState::kCoding | records::ChannelState::kCut, std::span(bytes).first(6));
  log.on_channel(9, 9, 9, 0, records::ChannelState::kNothing, {});
  log.on_channel(10, 10, 10, 0, records::ChannelState::kCoding, {});
  bytes[6] = std::byte{0xab};
  log.on_channel(11, 0, 0, 0, {}, bytes);
  log.on_channel(12, 0, 0, 1, records::ChannelState::kCoding, {});
  return log;
}

TEST(CaptureExport, FramesAreAsTheyWereOnTheChannel) {
  EXPECT_EQ(disturbed().csv(),
            csv_header() +
                "7,FlexRay,A,73,7,gateway,frame,frame_crc_error,laser_objects,12,0,laser 12,01AA\n"
                "8,FlexRay,A,73,8,gateway,frame,coding_error+frame_end_error,laser_objects,12,0,laser 12,01\n"
                "10,FlexRay,A,73,10,gateway,frame,coding_error,laser_objects,12,0,laser 12,\n"
                "11,FlexRay,A,,6,gateway,frame,,,,,,01AB\n"
                "12,FlexRay,B,,,gateway,noise,coding_error,,,,,\n"
                "16,FlexRay,A,73,6,gateway,frame,,laser_objects,12,0,laser 12,01AB\n");
}

TEST(CaptureExport, PacketsOfFramesThatWereNotAsTheyWereSentSayWhoseTheyAre) {
  const capture::Capture capture = disturbed().capture();
  std::vector<std::string> comments;
  std::vector<int> errors;
  std::vector<std::size_t> sizes;
  for (const capture::CapturedPacket& packet : capture.packets) {
    comments.push_back(packet.comment);
    errors.push_back(capture::parse_flexray_packet(capture.data(packet)).errors);
    sizes.push_back(packet.data_size);
  }
  const std::string list = "measurement laser 12: laser_objects, fragment 0";
  EXPECT_THAT(comments,
              testing::ElementsAre("slot 7 of gateway; " + list, "slot 8 of gateway; " + list,
                                   "slot 10 of gateway; " + list, "the controller of gateway did not send it",
                                   "the controller of gateway did not send it", "slot 6 of gateway; " + list));
  EXPECT_THAT(errors, testing::ElementsAre(capture::kFrameCrcError, capture::kCodingError | capture::kFrameEndError,
                                           capture::kCodingError, 0, capture::kCodingError, 0));
  EXPECT_THAT(sizes, testing::ElementsAre(9u, 8u, 2u, 9u, 2u, 9u));
}

Exported with_symbols() {
  Exported log;
  log.flexray(9'000, 1, 0, kNoPdu, false);
  log.symbol(5'000, 3'900, 0, records::Symbol::kCas);
  log.symbol(5'000, 3'904, 1, records::Symbol::kCas);
  log.symbol(1'000, 792'000, 0, records::Symbol::kWakeup);
  log.symbol(10'000, 3'900, 1, records::Symbol::kMediaTest);
  return log;
}

TEST(CaptureExport, SymbolsHaveRowsAndNoneInCandump) {
  const Exported log = with_symbols();
  EXPECT_EQ(log.csv(), csv_header() +
                           "1000,FlexRay,A,,,gateway,symbol,wakeup,,,,,\n"
                           "5000,FlexRay,A,,,gateway,symbol,cas,,,,,\n"
                           "5000,FlexRay,B,,,gateway,symbol,cas,,,,,\n"
                           "9000,FlexRay,A,73,1,gateway,frame,sync+startup,,,,,01AB\n"
                           "10000,FlexRay,B,,,gateway,symbol,media_test,,,,,\n");
  EXPECT_EQ(log.candump(), "");
}

TEST(CaptureExport, SymbolsArePacketsOfTheirOwnKind) {
  for (const std::int64_t bit_ps : {0, 100'000, 200'000}) {
    Exported log = with_symbols();
    log.manifest.bit_ps = bit_ps;
    const capture::Capture capture = log.capture();
    ASSERT_EQ(capture.packets.size(), 5u);
    std::vector<int> bits;
    std::vector<std::string> comments;
    for (const capture::CapturedPacket& packet : capture.packets) {
      const capture::FlexRayPacket parsed = capture::parse_flexray_packet(capture.data(packet));
      if (parsed.kind != capture::FlexRayPacket::Kind::kSymbol) continue;
      bits.push_back(parsed.symbol_bits);
      comments.push_back(packet.comment);
      EXPECT_EQ(packet.data_size, 2u);
      EXPECT_EQ(packet.interface, 0u);
    }
    const int low = bit_ps == 200'000 ? 20 : 39;  // 39 bits at 10 Mbit/s, which is taken for granted
    EXPECT_THAT(bits, testing::ElementsAre(127, low, low, low));
    EXPECT_THAT(comments, testing::ElementsAre("wake-up pattern of gateway, 792.0 us",
                                               "collision avoidance symbol of gateway, 3.9 us",
                                               "collision avoidance symbol of gateway, 3.9 us",
                                               "media access test symbol of gateway, 3.9 us"));
  }
}

TEST(CaptureExport, NumbersWithoutANameAreWrittenOut) {
  Exported log;
  log.manifest = {};
  log.flexray(6, 6, 1, *log.nodes.find_pdu("laser_objects"), false);
  log.can(0, 9, 0x100, true, "laser_scan", 12);
  EXPECT_THAT(log.csv(), HasSubstr("6,FlexRay,B,73,6,node 4,frame,,pdu 2,12,0,sensor 0 12,01AB\n"));
  EXPECT_THAT(log.candump(), HasSubstr(" can0 100##1"));
  EXPECT_EQ(log.capture().interfaces.at(1).name, "can 0");
}

}  // namespace
}  // namespace ttf::recording::exports
