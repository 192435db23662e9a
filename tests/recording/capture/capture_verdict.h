// The check's verdicts on captures of the paper's cluster, in comparable form.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "recording/capture/check.h"
#include "tests/recording/capture_fixture.h"

namespace ttf::recording::capture {

using Counts = std::array<std::uint64_t, kContradictions>;

inline const schedules::model::Cluster& paper() {
  static const schedules::model::Cluster kCluster = shipped_cluster();
  return kCluster;
}

inline CaptureVerdict verdict_on(const std::vector<BusFrame>& frames, const CaptureCheckOptions& options = {}) {
  return check_capture(capture_of(frames), "bus.pcapng", paper(), options);
}

inline Counts counts(std::initializer_list<std::pair<Contradiction, std::uint64_t>> some) {
  Counts all{};
  for (const auto& [kind, count] : some) all[static_cast<std::size_t>(kind)] = count;
  return all;
}

inline std::vector<std::string> texts(const CaptureVerdict& verdict) {
  std::vector<std::string> lines;
  for (const CaptureFinding& finding : verdict.findings)
    lines.push_back(std::to_string(finding.packet) + ": " + finding.text);
  return lines;
}

// The frame of a slot and channel in the n-th cycle; its packet's number is its place plus one.
inline std::size_t place_of(const std::vector<BusFrame>& frames, int slot, Channel channel, int counter) {
  const auto found = std::find_if(frames.begin(), frames.end(), [&](const BusFrame& frame) {
    return frame.header.frame_id == slot && frame.channel == channel && frame.header.cycle == counter;
  });
  EXPECT_NE(found, frames.end());
  return static_cast<std::size_t>(found - frames.begin());
}

inline std::string packet(std::size_t place) { return std::to_string(place + 1) + ": "; }

// Simple packet blocks have no stamps: only the counter gives the cycles.
inline Capture without_stamps(const std::vector<BusFrame>& frames) {
  std::string bytes = capture_bytes({});
  for (const BusFrame& frame : frames) {
    const std::string data = frame.packet();
    const auto put = [&](std::size_t value) {
      for (int i = 0; i < 4; ++i) bytes.push_back(static_cast<char>(value >> 8 * i));
    };
    const std::size_t padded = (data.size() + 3) / 4 * 4;
    put(3), put(16 + padded), put(data.size());
    bytes += data + std::string(padded - data.size(), '\0');
    put(16 + padded);
  }
  return parse_capture(bytes, "bus.pcapng");
}

}  // namespace ttf::recording::capture
