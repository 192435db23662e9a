#include "recording/exports/pcapng_writer.h"

#include <algorithm>
#include <cstring>

#include "core/check.h"
#include "recording/capture/blocks.h"
#include "recording/mcap/bytes.h"

namespace ttf::recording::exports {
namespace {

constexpr std::size_t kLongestText = 1000;
constexpr std::uint8_t kNanoseconds = 9;  // if_tsresol: 10^-9 s

std::string printable(std::string_view text) {
  std::size_t end = std::min(text.size(), kLongestText);
  // Cut between characters of UTF-8.
  while (end < text.size() && end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
  std::string out(text.substr(0, end));
  std::replace_if(
      out.begin(), out.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; }, '?');
  return out;
}

void pad(std::string& out, std::size_t bytes) { out.append(capture::padded(bytes) - bytes, '\0'); }

// A block, from its type to the second copy of its length.
class Block {
 public:
  Block(std::string& out, capture::BlockType type) : out_(out), start_(out.size()) {
    mcap::put(out_, static_cast<std::uint32_t>(type));
    mcap::put(out_, std::uint32_t{0});
  }
  void option(capture::BlockOption code, std::string_view value) {
    mcap::put(out_, static_cast<std::uint16_t>(code));
    mcap::put(out_, static_cast<std::uint16_t>(value.size()));
    out_.append(value);
    pad(out_, value.size());
    any_option_ = true;
  }
  void close() {
    if (any_option_) mcap::put(out_, std::uint32_t{0});  // end of options
    const auto length = static_cast<std::uint32_t>(out_.size() - start_ + sizeof(std::uint32_t));
    std::memcpy(out_.data() + start_ + sizeof(std::uint32_t), &length, sizeof length);
    mcap::put(out_, length);
  }

 private:
  std::string& out_;
  std::size_t start_;
  bool any_option_ = false;
};

}  // namespace

CaptureWriter::CaptureWriter(std::string& out, std::span<const CaptureInterface> interfaces, std::string_view comment)
    : out_(out), interfaces_(interfaces.size()) {
  Block section(out_, capture::BlockType::kSection);
  mcap::put(out_, capture::kByteOrderMagic);
  mcap::put(out_, std::uint16_t{1});  // version 1.0
  mcap::put(out_, std::uint16_t{0});
  mcap::put(out_, std::int64_t{-1});  // length of the section: unspecified
  if (!comment.empty()) section.option(capture::BlockOption::kComment, printable(comment));
  section.close();
  for (const CaptureInterface& interface : interfaces) {
    Block block(out_, capture::BlockType::kInterface);
    mcap::put(out_, static_cast<std::uint16_t>(interface.link_type));
    mcap::put(out_, std::uint16_t{0});
    mcap::put(out_, std::uint32_t{0});  // packets of any length
    block.option(capture::BlockOption::kInterfaceName, printable(interface.name));
    block.option(capture::BlockOption::kTimeResolution, std::string(1, static_cast<char>(kNanoseconds)));
    block.close();
  }
}

void CaptureWriter::packet(std::size_t interface, std::int64_t time_ns, std::string_view data,
                           std::string_view comment) {
  TTF_CHECK(interface < interfaces_ && data.size() <= capture::kMostPacketBytes, "interface {} of {}, {} bytes",
            interface, interfaces_, data.size());
  const auto stamp = static_cast<std::uint64_t>(std::max<std::int64_t>(time_ns, 0));
  Block block(out_, capture::BlockType::kEnhancedPacket);
  mcap::put(out_, static_cast<std::uint32_t>(interface));
  mcap::put(out_, static_cast<std::uint32_t>(stamp >> 32));
  mcap::put(out_, static_cast<std::uint32_t>(stamp));
  mcap::put(out_, static_cast<std::uint32_t>(data.size()));
  mcap::put(out_, static_cast<std::uint32_t>(data.size()));
  out_.append(data);
  pad(out_, data.size());
  if (!comment.empty()) block.option(capture::BlockOption::kComment, printable(comment));
  block.close();
}

}  // namespace ttf::recording::exports
