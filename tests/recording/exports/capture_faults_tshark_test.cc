// The same for a drive with many faults. The capture has the channels' contents with the right error flags,
// and is compared with the drive's schedule. Skipped without tshark.
#include <fmt/format.h>

#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "recording/capture/check.h"
#include "tests/recording/exports/tshark.h"

namespace ttf::recording::exports {
namespace {

// Expects, for a drive with faults, the sent frames and the changed bits of those on the channels.
class FaultyExpectation final : public Expectation {
 public:
  using Expectation::Expectation;
  using Expectation::on;
  struct Packet {
    CapturedLine line;
    Flags flags;
  };
  int nowhere = 0, foreign = 0, broken_off = 0;
  std::map<std::string, int> acts;  // faults, by kind

  void on(const records::SlotFrameSent& record) override {
    collector_.on(record);
    const std::vector<std::byte> bytes(record.bytes.begin(), record.bytes.end());
    const std::string text = comment(record.pdu, record.sequence, record.fragment, record.null_frame);
    sent_[{record.stamp.true_time.ns, record.channel, record.stamp.node}] = {
        {{record.stamp.true_time.ns, flexray_text(text, record.channel, bytes, {})}, {}}, text, bytes};
  }
  // A frame that does not leave at all is recorded as such before it is recorded as sent.
  void on(const records::ChannelFrame& record) override {
    collector_.on(record);
    on_channel_.push_back({record, {record.bytes.begin(), record.bytes.end()}});
  }
  void on(const records::FaultActivity& record) override {
    if (record.what == records::FaultAct::kActs) ++acts[std::string(record.kind)];
  }

  std::vector<Packet> packets() {
    for (OnChannel& there : on_channel_) {
      there.record.bytes = there.bytes;
      take(there.record);
    }
    std::vector<Packet> all = foreign_;
    for (const auto& [key, sent] : sent_) all.push_back(sent.packet);
    for (const CapturedLine& line : lines) all.push_back({line, {}});
    return all;
  }

 private:
  struct Sent {
    Packet packet;
    std::string comment;
    std::vector<std::byte> bytes;
  };
  struct OnChannel {
    records::ChannelFrame record;
    std::vector<std::byte> bytes;
  };
  void take(const records::ChannelFrame& record) {
    Flags flags;
    flags.coding = record.bytes.empty();
    if (record.slot == 0) {
      ++foreign;
      const std::string who = record.sender == kNoNode
                                  ? std::string("no node sent it")
                                  : fmt::format("the controller of {} did not send it", node(record.sender));
      foreign_.push_back({{record.start.ns, flexray_text(who, record.channel, record.bytes, flags)}, flags});
      return;
    }
    const auto found = sent_.find({record.sent.ns, record.sent_channel, record.sender});
    ASSERT_NE(found, sent_.end()) << record.sent.ns;
    Sent& sent = found->second;
    const std::string comment = fmt::format("slot {} of {}{}{}", record.slot, node(record.sender),
                                            sent.comment.empty() ? "" : "; ", sent.comment);
    if (record.state == records::ChannelState::kNothing) {
      ++nowhere;
      sent_.erase(found);
      return;
    }
    if (!record.bytes.empty() && record.bytes.size() < sent.bytes.size()) {
      ++broken_off;
      flags.coding = flags.frame_end = true;
      EXPECT_TRUE(std::equal(record.bytes.begin(), record.bytes.end(), sent.bytes.begin()));
    } else if (!record.bytes.empty()) {
      ASSERT_EQ(record.bytes.size(), sent.bytes.size());
      for (std::size_t bit = 0; bit < 8 * sent.bytes.size(); ++bit) {
        const std::byte changed = record.bytes[bit / 8] ^ sent.bytes[bit / 8];
        const bool inverted = (changed & static_cast<std::byte>(0x80 >> bit % 8)) != std::byte{};
        flags.frame_crc |= inverted;
        flags.header_crc |= inverted && in_header_crc(bit);
      }
      flags.frame_crc |= record.channel != record.sent_channel;
    }
    sent.packet = {{record.start.ns, flexray_text(comment, record.channel, record.bytes, flags)}, flags};
  }

  std::map<std::tuple<std::int64_t, int, NodeId>, Sent> sent_;
  std::vector<OnChannel> on_channel_;
  std::vector<Packet> foreign_;
};

faults::Fault fault(faults::FaultKind kind, const char* node, int from_ms, int for_ms) {
  faults::Fault fault;
  fault.kind = kind;
  fault.node_name = node;
  fault.from = Duration::milliseconds(from_ms);
  fault.duration = Duration::milliseconds(for_ms);
  return fault;
}

// When a node's first frame after `from` begins.
TrueTime next_frame(const sim::drives::Drive& drive, NodeId node, TrueTime from) {
  struct First final : records::Sink {
    using records::Sink::on;
    NodeId node{};
    TrueTime from{};
    std::optional<TrueTime> start;
    void on(const records::SlotFrameSent& record) override {
      if (!start && record.stamp.node == node && record.stamp.true_time >= from) start = record.stamp.true_time;
    }
  } first;
  first.node = node;
  first.from = from;
  drive.run(first);
  return first.start.value();
}

TEST(CaptureTshark, EveryFrameOfADriveWithFaultsIsAsItWasOnTheChannel) {
  if (!has_tshark()) GTEST_SKIP() << "tshark is not installed (tools/install_deps.sh)";
  using faults::FaultKind;
  sim::drives::Drive drive("scenarios/paper_scenario1.yaml", fusion::strategies::StrategyKind::kTt);
  // A node dies twenty microseconds, or some twenty bytes, into a frame.
  const NodeId camera_pre = *drive.cluster.find_node("camera_pre");
  const TrueTime dies = next_frame(drive, camera_pre, sim::engine::kFirstCycle + Duration::milliseconds(1'600));
  std::vector<faults::Fault> faults = {fault(FaultKind::kBitFlipHeader, "gateway", 1'000, 40),
                                       fault(FaultKind::kBitFlipPayload, "gateway", 1'200, 40),
                                       fault(FaultKind::kBitFlipTrailer, "gateway", 1'400, 40),
                                       fault(FaultKind::kCrash, "camera_pre", 0, 50),
                                       fault(FaultKind::kNoise, "", 2'000, 50),
                                       fault(FaultKind::kChannelSwap, "gateway", 2'200, 10),
                                       fault(FaultKind::kOmission, "gateway", 2'300, 10),
                                       fault(FaultKind::kMasquerading, "feature", 2'400, 50),
                                       fault(FaultKind::kSosTiming, "laser_pre", 2'500, 50),
                                       fault(FaultKind::kTransient, "", 2'600, 5)};
  faults[0].probability = faults[1].probability = faults[2].probability = 0.3;
  faults[0].flips = 2;
  faults[3].from = dies + Duration::microseconds(20) - sim::engine::kFirstCycle;
  faults[7].slot = drive.cluster.flexray.gNumberOfStaticSlots;
  faults[8].shift = Duration::microseconds(5);
  drive.scenario.faults.faults = faults;

  const std::string path = drive_log(drive);
  records::Sink nobody;
  const log::LogInfo info = log::read_log(path, nobody);
  std::vector<SensorId> sensors;
  for (const schedules::model::PduLayout& pdu : drive.cluster.pdus) sensors.push_back(pdu.sensor);
  FrameCollector collector;
  FaultyExpectation expected(collector, info.manifest, sensors, 0);
  log::read_log(path, expected);
  const std::string bytes = export_pcapng(collector, collector.in_order(), LogNames(info.manifest));
  const std::string file = log::scratch("faulty.pcapng");
  std::ofstream(file, std::ios::binary) << bytes;

  // Keyed by tshark's expected line; packets with equal lines are interchangeable.
  std::multimap<std::string, Flags> due;
  for (const FaultyExpectation::Packet& packet : expected.packets())
    due.emplace(seconds(packet.line.time_ns) + "\t" + packet.line.text, packet.flags);
  const std::vector<std::string> seen = tshark(file);
  EXPECT_EQ(seen.size(), due.size());
  std::vector<Flags> flags;  // by packet
  int strange = 0;
  for (const std::string& line : seen) {
    const auto found = due.find(line);
    if (found == due.end()) {
      EXPECT_GT(5, ++strange) << "packet " << flags.size() + 1 << ": " << line;
      flags.emplace_back();
      continue;
    }
    flags.push_back(found->second);
    due.erase(found);
  }
  for (const auto& [line, flag] : due) EXPECT_GT(5, ++strange) << "not in the capture: " << line;
  EXPECT_EQ(strange, 0);

  // The injector counts its acts; the capture shows them.
  int header = 0, frame = 0, coding = 0;
  for (const Flags& one : flags) header += one.header_crc, frame += one.frame_crc, coding += one.coding;
  EXPECT_GT(header, 20);
  EXPECT_EQ(frame, expected.acts["bit_flip_header"] + expected.acts["bit_flip_payload"] +
                       expected.acts["bit_flip_trailer"] + expected.acts["channel_swap"]);
  EXPECT_GT(expected.acts["bit_flip_trailer"], 20);
  EXPECT_EQ(expected.broken_off, 2) << "on both channels";
  EXPECT_EQ(expected.nowhere, expected.acts["omission"]);
  EXPECT_EQ(expected.foreign, expected.acts["noise"] + expected.acts["masquerading"]);
  EXPECT_GE(coding, expected.acts["noise"] + expected.acts["transient"]);

  // The schedule is compared with it, packet by packet.
  const capture::CaptureVerdict verdict =
      capture::check_capture(capture::parse_capture(bytes, "faulty.pcapng"), "faulty.pcapng", drive.cluster, {});
  ASSERT_LT(verdict.findings.size(), capture::kMostFindings);
  std::set<std::pair<capture::Contradiction, std::uint64_t>> found;
  for (const capture::CaptureFinding& finding : verdict.findings) found.emplace(finding.kind, finding.packet);
  for (std::size_t i = 0; i < flags.size(); ++i)
    for (const auto& [flagged, kind] : {std::pair{flags[i].header_crc, capture::Contradiction::kHeaderCrc},
                                        std::pair{flags[i].frame_crc, capture::Contradiction::kFrameCrc},
                                        std::pair{flags[i].coding, capture::Contradiction::kCoding}})
      EXPECT_EQ(found.count({kind, i + 1}) == 1, flagged)
          << "packet " << i + 1 << ": " << capture::kContradictionNames[static_cast<std::size_t>(kind)];
  EXPECT_EQ(verdict.counts[static_cast<std::size_t>(capture::Contradiction::kMalformed)], 0u);
  EXPECT_GE(verdict.counts[static_cast<std::size_t>(capture::Contradiction::kUnownedSlot)],
            static_cast<std::uint64_t>(expected.acts["masquerading"]));
}

}  // namespace
}  // namespace ttf::recording::exports
