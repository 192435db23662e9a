// Small logs to test with.
#pragma once

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <numeric>
#include <string>

#include <unistd.h>

#include "recording/log/writer.h"
#include "tests/recording/record_text.h"

namespace ttf::recording::log {

// A path for this process alone, in a folder removed at the end.
inline std::string scratch(const std::string& name) {
  struct Folder {
    std::filesystem::path path =
        std::filesystem::temp_directory_path() / ("ttf_test_recording." + std::to_string(::getpid()));
    Folder() { std::filesystem::create_directories(path); }
    ~Folder() { std::filesystem::remove_all(path); }
  };
  static const Folder folder;
  return (folder.path / name).string();
}

inline LogManifest sample_manifest() {
  LogManifest manifest;
  manifest.version = "0.1.0";
  manifest.seed = 0xffff'ffff'ffff'ffffu;
  manifest.scenario_name = "leading car";
  manifest.cluster_name = "paper, synchronised";
  manifest.strategy = "tt";
  manifest.recording_name = "street.txt";
  manifest.cycle_ns = 5'000'000;
  manifest.bit_ps = 200'000;
  manifest.hashes = {{"cluster", "00ff"}, {"scenario", "dead.beef"}};
  manifest.node_names = {"laser", "camera", "fusion"};
  manifest.task_names = {{"preprocess", "send"}, {}, {"fuse"}};
  manifest.pdu_names = {"laser_objects", "camera.objects", std::string("odd\0name", 8)};
  manifest.pdu_sensors = {SensorId{0}, SensorId{254}, kNoSensor};
  manifest.sensor_names = {"laser"};
  manifest.can_bus_names = {"laser_can", ""};
  manifest.clock = kWallClock;
  manifest.host = "bench";
  manifest.time_scale_ppm = 2'500'000;
  return manifest;
}

// The kinds in turn, not in their order, all of them.
inline int kind_of(std::uint32_t i) {
  constexpr std::size_t kStride = 13;
  static_assert(std::gcd(kStride, records::kKindCount) == 1);
  return static_cast<int>(i * kStride % records::kKindCount) + 1;
}

// `count` drawn records of all kinds, one per millisecond.
inline void emit_drive(records::Sink& sink, std::uint32_t count) {
  for (std::uint32_t i = 0; i < count; ++i) emit(sink, kind_of(i), Values::kDrawn, i, std::int64_t{i} * 1'000'000);
}

inline std::string log_of(const std::function<void(ttf::recording::records::Sink&)>& drive) {
  const std::string path = scratch("log_of.mcap");
  LogWriter writer(path, sample_manifest());
  writer.attach("cluster.yaml", "application/yaml", "name: paper\n");
  drive(writer);
  writer.close();
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace ttf::recording::log
