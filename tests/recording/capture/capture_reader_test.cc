// Reads captures: our own, other programs' in every byte order and resolution, and damaged ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/errors.h"
#include "tests/recording/capture_fixture.h"
#include "tests/support/refusals.h"

namespace ttf::recording::capture {
namespace {

using testing::HasSubstr;
using testing::StartsWith;

std::string text_of(const Capture& capture, const CapturedPacket& packet) {
  const auto data = capture.data(packet);
  return {reinterpret_cast<const char*>(data.data()), data.size()};
}

// Numbers in a chosen byte order.
struct Bytes {
  bool big = false;
  std::string out;
  template <class Int> Bytes& put(Int value) {
    for (std::size_t i = 0; i < sizeof(Int); ++i)
      out.push_back(static_cast<char>(value >> 8 * (big ? sizeof(Int) - 1 - i : i)));
    return *this;
  }
  Bytes& u16(std::uint32_t value) { return put(static_cast<std::uint16_t>(value)); }
  Bytes& u32(std::uint32_t value) { return put(value); }
  Bytes& text(const std::string& value) {
    out += value;
    out.append((4 - value.size() % 4) % 4, '\0');
    return *this;
  }
  Bytes& block(std::uint32_t type, const Bytes& body) {
    const auto size = static_cast<std::uint32_t>(body.out.size() + 12);
    u32(type).u32(size);
    out += body.out;
    return u32(size);
  }
  Bytes body() const { return {big, ""}; }
};

Bytes section(bool big) {
  Bytes file{big, ""};
  return file.block(0x0a0d0d0a, file.body().u32(0x1a2b3c4d).u16(1).u16(0).u32(0xffffffff).u32(0xffffffff));
}

std::string refusal(const std::string& bytes) {
  return support::refusal_of([&] { parse_capture(bytes, "bus.pcapng"); });
}

std::string two_packets() {
  const std::vector<exports::CaptureInterface> interfaces{{LinkType::kFlexRay, "FlexRay"},
                                                          {LinkType::kCan, "laser_can"}};
  std::string bytes;
  exports::CaptureWriter writer(bytes, interfaces, "a run");
  writer.packet(0, 1, "abc", "");
  writer.packet(1, 1'700'000'000'123'456'789, "defgh", "measurement laser 12");
  return bytes;
}

TEST(CaptureReader, ReadsWhatTheWriterWrote) {
  const Capture capture = parse_capture(two_packets(), "bus.pcapng");
  EXPECT_EQ(capture.warning, "");
  ASSERT_EQ(capture.interfaces.size(), 2u);
  EXPECT_EQ(capture.interfaces[0].link_type, 210u);
  EXPECT_EQ(capture.interfaces[1].link_type, 227u);
  EXPECT_EQ(capture.interfaces[1].name, "laser_can");
  ASSERT_EQ(capture.packets.size(), 2u);
  EXPECT_EQ(capture.packets[0].number, 1u);
  EXPECT_EQ(capture.packets[0].time_ns, 1);
  EXPECT_EQ(text_of(capture, capture.packets[0]), "abc");
  EXPECT_EQ(capture.packets[0].comment, "");
  EXPECT_EQ(capture.packets[1].number, 2u);
  EXPECT_EQ(capture.packets[1].interface, 1u);
  EXPECT_EQ(capture.packets[1].time_ns, 1'700'000'000'123'456'789);
  EXPECT_EQ(text_of(capture, capture.packets[1]), "defgh");
  EXPECT_EQ(capture.packets[1].comment, "measurement laser 12");
}

TEST(CaptureReader, CommentsAreKeptPrintableAndShort) {
  const exports::CaptureInterface interface { LinkType::kCan, "a\nb" };
  std::string bytes;
  exports::CaptureWriter writer(bytes, {&interface, 1}, "");
  writer.packet(0, -5, "", "one\ttwo");
  writer.packet(0, 0, "", std::string(999, 'x') + "\xc3\xa4");
  const Capture capture = parse_capture(bytes, "bus.pcapng");
  EXPECT_EQ(capture.interfaces[0].name, "a?b");
  EXPECT_EQ(capture.packets[0].comment, "one?two");
  EXPECT_EQ(capture.packets[0].time_ns, 0);
  EXPECT_EQ(capture.packets[1].comment, std::string(999, 'x'));
}

TEST(CaptureReader, ReadsPcapOfEitherByteOrderAndResolution) {
  for (const bool big : {false, true})
    for (const bool nano : {false, true}) {
      Bytes file{big, ""};
      file.u32(nano ? 0xa1b23c4d : 0xa1b2c3d4).u16(2).u16(4).u32(0).u32(0).u32(65535).u32(210);
      file.u32(1'700'000'000).u32(123'456).u32(3).u32(9).out += "abc";
      file.u32(1'700'000'001).u32(7).u32(0).u32(0);
      const Capture capture = parse_capture(file.out, "bus.pcap");
      EXPECT_EQ(capture.warning, "");
      ASSERT_EQ(capture.packets.size(), 2u);
      EXPECT_EQ(capture.link_type(capture.packets[0]), 210u);
      EXPECT_EQ(text_of(capture, capture.packets[0]), "abc");
      EXPECT_EQ(capture.packets[0].original_size, 9u);
      EXPECT_EQ(capture.packets[0].time_ns, 1'700'000'000'000'000'000 + 123'456 * (nano ? 1 : 1000));
      EXPECT_EQ(capture.packets[1].time_ns, 1'700'000'001'000'000'000 + 7 * (nano ? 1 : 1000));
    }
}

TEST(CaptureReader, ReadsEveryKindOfPacketBlockInEitherByteOrderAndSkipsTheOthers) {
  for (const bool big : {false, true}) {
    Bytes file = section(big);
    file.block(1, file.body().u16(210).u16(0).u32(2));  // microseconds, cuts to 2 bytes
    file.block(0xbad, file.body().text("unknown"));
    file.block(6, file.body().u32(0).u32(0).u32(1'500'000).u32(1).u32(1).text("a"));           // enhanced
    file.block(3, file.body().u32(5).text("bc"));                                              // simple: 2 of 5 bytes
    file.block(2, file.body().u16(0).u16(7).u32(0).u32(2'000'000).u32(3).u32(3).text("def"));  // obsolete
    const Capture capture = parse_capture(file.out, "bus.pcapng");
    EXPECT_EQ(capture.warning, "");
    ASSERT_EQ(capture.packets.size(), 3u);
    EXPECT_EQ(text_of(capture, capture.packets[0]), "a");
    EXPECT_EQ(capture.packets[0].time_ns, 1'500'000'000);
    EXPECT_EQ(text_of(capture, capture.packets[1]), "bc");
    EXPECT_EQ(capture.packets[1].time_ns, std::nullopt);
    EXPECT_EQ(capture.packets[1].original_size, 5u);
    EXPECT_EQ(text_of(capture, capture.packets[2]), "def");
    EXPECT_EQ(capture.packets[2].time_ns, 2'000'000'000);
  }
}

TEST(CaptureReader, TimeStampsCountInWhatTheInterfaceSays) {
  const auto time_of = [](int resolution, std::uint64_t ticks, std::int64_t offset_s) {
    Bytes file = section(false);
    Bytes body = file.body().u16(210).u16(0).u32(0);
    body.u16(9).u16(1).text(std::string(1, static_cast<char>(resolution)));
    body.u16(14).u16(8).put(offset_s);
    file.block(1, body.u32(0));
    file.block(6, file.body()
                      .u32(0)
                      .u32(static_cast<std::uint32_t>(ticks >> 32))
                      .u32(static_cast<std::uint32_t>(ticks))
                      .u32(0)
                      .u32(0));
    return parse_capture(file.out, "bus.pcapng").packets.at(0).time_ns;
  };
  EXPECT_EQ(time_of(9, 1'234'567'890'123, 0), 1'234'567'890'123);
  EXPECT_EQ(time_of(6, 1'234'567, 0), 1'234'567'000);
  EXPECT_EQ(time_of(0, 17, 0), 17'000'000'000);
  EXPECT_EQ(time_of(12, 1'234'999, 0), 1234);
  EXPECT_EQ(time_of(0x80 | 10, 1025, 0), 1'000'976'562);
  EXPECT_EQ(time_of(3, 5, 1000), 1'000'005'000'000);
  EXPECT_EQ(time_of(19, 10'000'000'000'000'000'000u, -1), 0);
  EXPECT_THROW(time_of(0, 0xffff'ffff'ffff'ffffu, 0), InputError);
  EXPECT_THROW(time_of(9, 1, -1), InputError);
  EXPECT_THROW(time_of(20, 1, 0), InputError);
}

TEST(CaptureReader, ASectionHasItsOwnByteOrderAndInterfaces) {
  Bytes first = section(false), second = section(true);
  first.block(1, first.body().u16(227).u16(0).u32(0));
  second.block(1, second.body().u16(210).u16(0).u32(0));
  second.block(6, second.body().u32(0).u32(0).u32(1).u32(1).u32(1).text("x"));
  const Capture capture = parse_capture(first.out + second.out, "bus.pcapng");
  ASSERT_EQ(capture.packets.size(), 1u);
  EXPECT_EQ(capture.link_type(capture.packets[0]), 210u);
  // The first section's interface is not the second's.
  second.block(6, second.body().u32(1).u32(0).u32(1).u32(1).u32(1).text("x"));
  EXPECT_THAT(refusal(first.out + second.out), HasSubstr("bus.pcapng: packet 2 = interface 1: "));
}

TEST(CaptureReader, DamageIsOneSentenceThatNamesFileAndPacket) {
  const auto in_block = [](std::uint32_t type, const Bytes& body) {
    Bytes file = section(false);
    file.block(1, file.body().u16(210).u16(0).u32(0));
    return refusal(file.block(type, body).out);
  };
  const Bytes empty;
  EXPECT_THAT(in_block(6, empty.body().u32(3).u32(0).u32(0).u32(0).u32(0)),
              StartsWith("bus.pcapng: packet 1 = interface 3: must be of one of the section's 1 interfaces"));
  EXPECT_THAT(in_block(6, empty.body().u32(0).u32(0).u32(0).u32(5).u32(5).u32(0)),
              StartsWith("bus.pcapng: packet 1 = 5 bytes: must fit its block"));
  EXPECT_THAT(in_block(6, empty.body().u32(0).u32(0)),
              StartsWith("bus.pcapng: packet 1 = 20 bytes: must have at least"));
  EXPECT_THAT(in_block(6, empty.body().u32(0).u32(0).u32(0).u32(0).u32(0).u16(1).u16(100)),
              StartsWith("bus.pcapng: packet 1 = option of 100 bytes: must fit its block"));
  EXPECT_THAT(in_block(3, empty.body().u32(9).text("bc")),
              StartsWith("bus.pcapng: packet 1 = 9 bytes: must fit its block"));
  EXPECT_THAT(in_block(1, empty.body().u32(9)), HasSubstr("interface 1 before packet 1 = 16 bytes"));

  std::string bytes = two_packets();
  bytes[bytes.size() - 4] ^= 4;  // the last block's second length
  EXPECT_THAT(refusal(bytes), StartsWith("bus.pcapng: block before packet 2 = "));
  EXPECT_THAT(refusal(bytes), HasSubstr("must state the same length at both ends"));
  EXPECT_EQ(refusal("GIF89a"), "bus.pcapng: is not a capture: neither pcap nor pcapng");
  EXPECT_EQ(refusal(""), "bus.pcapng: is not a capture: neither pcap nor pcapng");

  Bytes pcap;
  pcap.u32(0xa1b2c3d4).u16(2).u16(4).u32(0).u32(0).u32(65535).u32(210).u32(0).u32(1'000'000).u32(0).u32(0);
  EXPECT_EQ(refusal(pcap.out), "bus.pcapng: packet 1 = 1000000 us: must be a fraction of a second");
  EXPECT_EQ(refusal(pcap.out.substr(0, 24) + Bytes().u32(0).u32(0).u32(0x7fffffff).u32(1).out),
            "bus.pcapng: packet 1 = 2147483647 bytes: must have at most 262144 bytes");
}

TEST(CaptureReader, AFileCutAnywhereIsReadUpToTheCut) {
  const std::string whole = two_packets();
  const Capture all = parse_capture(whole, "bus.pcapng");
  std::size_t most = 0;
  for (std::size_t size = 12; size < whole.size(); ++size) {
    const Capture cut = parse_capture(whole.substr(0, size), "bus.pcapng");
    ASSERT_LE(cut.packets.size(), all.packets.size());
    most = std::max(most, cut.packets.size());
    const bool at_a_block = cut.warning.empty();
    EXPECT_TRUE(at_a_block || cut.warning.starts_with("bus.pcapng: block before packet ")) << cut.warning;
    for (std::size_t i = 0; i < cut.packets.size(); ++i)
      EXPECT_EQ(text_of(cut, cut.packets[i]), text_of(all, all.packets[i]));
  }
  EXPECT_EQ(most, 1u);
}

TEST(CaptureReader, AnyChangedByteIsReadOrRefusedWithASentence) {
  const std::string sound = two_packets();
  int refused = 0;
  for (std::size_t at = 0; at < sound.size(); ++at)
    for (const int change : {0x01, 0x80, 0xff}) {
      std::string bytes = sound;
      bytes[at] = static_cast<char>(bytes[at] ^ change);
      try {
        const Capture capture = parse_capture(bytes, "bus.pcapng");
        for (const CapturedPacket& packet : capture.packets) {
          ASSERT_LT(packet.interface, capture.interfaces.size());
          EXPECT_LE(packet.data_begin + packet.data_size, bytes.size());
        }
      } catch (const InputError& error) {
        ++refused;
        EXPECT_THAT(error.what(), StartsWith("bus.pcapng: "));
        EXPECT_EQ(error.findings().size(), 1u);
      }
    }
  EXPECT_GT(refused, 60);
}

}  // namespace
}  // namespace ttf::recording::capture
