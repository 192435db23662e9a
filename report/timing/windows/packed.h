// The windows of a drive's timing diagram in few bytes, for the page's script (report/page/timing_windows.js).
//
// Windows travel as pictures, not as records: records would need a second painter, in the script, and the C++ one also serves
// pictures without a page.
//
// Pictures of one drive have the same lines again and again, with other numbers. So several windows make a chunk: each
// line once, with marks for its numbers, and the numbers of the same place in a column. A chunk is JSON, deflated
// (zlib), in base64:
//
//   lines    the lines; "\u0001" marks a number
//   order    for each window, its lines by their index
//   columns  for each mark, in the order of lines and marks: the decimals, then the first number and the steps from
//            number to number, in units of the last decimal
//
// 160 ms of a cluster with two sensors take 0.4 MB as SVG, and 3 kB here. The pictures come back byte by byte.
#pragma once

#include <cstddef>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/time.h"

namespace ttf::report::timing::windows {

// Returns the windows' pictures as one chunk.
std::string packed_chunk(const std::vector<std::string>& svgs);

class WindowPacker {
 public:
  // Takes windows until their chunks have so many bytes.
  explicit WindowPacker(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  // Takes windows in the order of time. Returns whether there is room for another one.
  bool add(TrueTime from, TrueTime to, const std::string& svg);

  // Returns {"windows": [[from, to], ...] in ms, "each": windows of a chunk, "chunks": [...]}; null without windows.
  nlohmann::ordered_json finish();

  // Returns the end of the last window if it was the last one with room.
  std::optional<TrueTime> full_at() const { return full_at_; }

 private:
  static constexpr std::size_t kEach = 6;  // a second, usually: unpacked in some 10 ms

  void close_chunk();

  std::size_t most_bytes_, bytes_ = 0;
  std::vector<std::string> pending_;
  nlohmann::ordered_json windows_ = nlohmann::ordered_json::array(), chunks_ = nlohmann::ordered_json::array();
  std::optional<TrueTime> full_at_;
};

}  // namespace ttf::report::timing::windows
