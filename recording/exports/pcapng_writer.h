// Writes a pcapng capture, little endian, with stamps in nanoseconds (draft-ietf-opsawg-pcapng): one section,
// its interfaces, then the packets as enhanced packet blocks. The same packets give the same bytes: no dates,
// no machine's name.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "recording/capture/packet.h"

namespace ttf::recording::exports {

struct CaptureInterface {
  capture::LinkType link_type{};
  std::string name;
};

class CaptureWriter {
 public:
  // Appends to `out`, which must outlive the writer. `comment` describes the section; empty: no comment.
  CaptureWriter(std::string& out, std::span<const CaptureInterface> interfaces, std::string_view comment);

  // `interface` indexes the list above. Instants before the epoch become 0, as stamps of the format are
  // unsigned. An empty `comment` is left out; control characters in it become '?', and a very long one is cut.
  void packet(std::size_t interface, std::int64_t time_ns, std::string_view data, std::string_view comment);

 private:
  std::string& out_;
  std::size_t interfaces_;
};

}  // namespace ttf::recording::exports
