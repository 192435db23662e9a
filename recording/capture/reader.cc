#include "recording/capture/reader.h"

#include "core/file_bytes.h"
#include "recording/capture/parser.h"

namespace ttf::recording::capture {
namespace {

bool is_pcap(std::uint32_t magic) { return magic == kPcapMicroseconds || magic == kPcapNanoseconds; }

}  // namespace

Capture parse_capture(std::string bytes, const std::string& name) {
  Capture capture;
  capture.bytes = std::move(bytes);
  const bool any = capture.bytes.size() >= sizeof(std::uint32_t);
  const auto magic = any ? number_at<std::uint32_t>(capture.bytes, 0, false) : 0;
  if (any && magic == static_cast<std::uint32_t>(BlockType::kSection))
    parse_pcapng(capture, name);
  else if (any && (is_pcap(magic) || is_pcap(number_at<std::uint32_t>(capture.bytes, 0, true))))
    parse_pcap(capture, name);
  else
    throw InputError({name, 0, "", "", "is not a capture: neither pcap nor pcapng"});
  return capture;
}

Capture read_capture(const std::string& path) { return parse_capture(read_file(path), path); }

}  // namespace ttf::recording::capture
