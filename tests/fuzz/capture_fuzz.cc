// Any bytes as a capture, and any capture against a schedule. Laws: only InputError ends the reading, with
// one sentence. Packets lie within the file and are numbered from 1. Packets written again are read the same.
// The verdict on a capture counts its own list.
#include "core/check.h"
#include "recording/capture/check.h"
#include "recording/capture/packet.h"
#include "recording/capture/reader.h"
#include "recording/exports/pcapng_writer.h"
#include "schedules/file/loader.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace ttf;
using recording::capture::Capture;
using recording::capture::CapturedPacket;

constexpr char kFile[] = "bus.pcapng";

const schedules::model::Cluster& cluster() {
  static const schedules::model::Cluster kCluster =
      schedules::file::parse_cluster(fuzz::shipped_cluster("paper_synchronised"), "cluster.yaml");
  return kCluster;
}

void check_packets(const Capture& capture, std::size_t size) {
  TTF_CHECK(capture.bytes.size() == size, "{} bytes are {}", size, capture.bytes.size());
  std::uint64_t number = 0;
  for (const CapturedPacket& packet : capture.packets) {
    TTF_CHECK(packet.number == ++number && packet.interface < capture.interfaces.size(), "packet {} of interface {}",
              packet.number, packet.interface);
    TTF_CHECK(packet.data_begin + packet.data_size <= size, "packet at {} of {} bytes", packet.data_begin,
              packet.data_size);
    TTF_CHECK(!packet.time_ns || *packet.time_ns >= 0, "packet at {} ns", packet.time_ns.value_or(0));
    recording::capture::parse_flexray_packet(capture.data(packet));
  }
}

void check_written_again(const Capture& capture) {
  if (capture.interfaces.empty()) return;
  std::vector<recording::exports::CaptureInterface> interfaces;
  for (const recording::capture::CaptureSource& source : capture.interfaces)
    interfaces.push_back({static_cast<recording::capture::LinkType>(source.link_type), ""});
  std::string bytes;
  recording::exports::CaptureWriter writer(bytes, interfaces, "");
  for (const CapturedPacket& packet : capture.packets) {
    const auto data = capture.data(packet);
    writer.packet(packet.interface, packet.time_ns.value_or(0),
                  {reinterpret_cast<const char*>(data.data()), data.size()}, "");
  }
  const Capture again = recording::capture::parse_capture(bytes, kFile);
  TTF_CHECK(again.warning.empty() && again.packets.size() == capture.packets.size(), "{} packets are {}: {}",
            capture.packets.size(), again.packets.size(), again.warning);
  for (std::size_t i = 0; i < again.packets.size(); ++i) {
    const auto a = capture.data(capture.packets[i]), b = again.data(again.packets[i]);
    TTF_CHECK(a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size()) == 0 &&
                  again.packets[i].time_ns == capture.packets[i].time_ns.value_or(0) &&
                  again.packets[i].interface == capture.packets[i].interface,
              "packet {} changed", i + 1);
  }
}

void check_verdict(const Capture& capture) {
  recording::capture::CaptureVerdict verdict;
  const bool said =
      fuzz::accepted(kFile, [&] { verdict = recording::capture::check_capture(capture, kFile, cluster(), {}); });
  if (!said) return;
  TTF_CHECK(verdict.frames > 0 && verdict.cycles > 0, "{} frames, {} cycles", verdict.frames, verdict.cycles);
  TTF_CHECK(verdict.frames + verdict.symbols + verdict.other_packets == capture.packets.size(), "{} of {} packets",
            verdict.frames, capture.packets.size());
  TTF_CHECK(verdict.findings.size() <= verdict.contradictions() &&
                verdict.findings.empty() == (verdict.contradictions() == 0),
            "{} findings, {} contradictions", verdict.findings.size(), verdict.contradictions());
  std::uint64_t before = 0;
  for (const recording::capture::CaptureFinding& finding : verdict.findings) {
    TTF_CHECK(finding.packet >= before && finding.packet <= capture.packets.size() && !finding.text.empty(),
              "packet {} after {}: {}", finding.packet, before, finding.text);
    before = finding.packet;
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Capture capture;
  if (!fuzz::accepted(kFile, [&] { capture = recording::capture::parse_capture(fuzz::text_of(data, size), kFile); }))
    return 0;
  fuzz::check_lines(capture.warning, kFile);
  check_packets(capture, size);
  check_written_again(capture);
  check_verdict(capture);
  return 0;
}
