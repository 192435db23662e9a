// The cost of a frame: both CRCs, encoding and decoding, by payload length; against a bitwise CRC in the same
// run.
#include <benchmark/benchmark.h>

#include <array>

#include "bus/wire/flexray_crc.h"
#include "bus/wire/flexray_frame.h"
#include "tests/bench/yardstick.h"

namespace ttf::wire {
namespace {

using schedules::model::Channel;

struct Sample {
  std::array<std::byte, bus::wire::kMaxPayloadBytes> payload{};
  std::array<std::byte, bus::wire::kMaxFrameBytes> frame{};
  bus::wire::FrameHeader header;
  std::size_t size = 0;

  explicit Sample(std::int64_t words) {
    for (std::size_t i = 0; i < payload.size(); ++i) payload[i] = static_cast<std::byte>(37 * i + 11);
    header.frame_id = 9;
    header.cycle = 17;
    header.sync = true;
    size = encode_frame(header, Channel::kA, bytes(words), frame);
  }
  std::span<const std::byte> bytes(std::int64_t words) const {
    return std::span(payload).first(2 * static_cast<std::size_t>(words));
  }
  std::span<const std::byte> covered() const { return std::span(frame).first(size - bus::wire::kTrailerBytes); }
};

std::uint32_t bitwise_frame_crc(std::span<const std::byte> bytes) {
  std::uint32_t crc = 0xFEDCBA;
  for (const std::byte byte : bytes) {
    crc ^= static_cast<std::uint32_t>(byte) << 16;
    for (int bit = 0; bit < 8; ++bit) crc = ((crc << 1) ^ ((crc & 0x800000u) ? 0x5D6DCBu : 0u)) & 0xFFFFFFu;
  }
  return crc;
}

void report(benchmark::State& state, std::size_t bytes) {
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(bytes));
}

void BitwiseFrameCrc(benchmark::State& state) {
  const Sample sample(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(bitwise_frame_crc(sample.covered()));
  report(state, sample.covered().size());
}
BENCHMARK(BitwiseFrameCrc)->Arg(8)->Arg(28)->Arg(127)->ArgName("words");

void FrameCrc(benchmark::State& state) {
  const Sample sample(state.range(0));
  if (bus::wire::frame_crc(Channel::kA, sample.covered()) != bitwise_frame_crc(sample.covered()))
    return state.SkipWithError("the two CRCs differ");
  for (auto _ : state) benchmark::DoNotOptimize(bus::wire::frame_crc(Channel::kA, sample.covered()));
  report(state, sample.covered().size());
}
BENCHMARK(FrameCrc)->Arg(8)->Arg(28)->Arg(127)->ArgName("words");

void HeaderCrc(benchmark::State& state) {
  std::uint16_t id = 0;
  for (auto _ : state) benchmark::DoNotOptimize(bus::wire::header_crc(true, false, ++id & 0x7FF, 28));
}
BENCHMARK(HeaderCrc);

void Encode(benchmark::State& state) {
  Sample sample(state.range(0));
  for (auto _ : state)
    benchmark::DoNotOptimize(encode_frame(sample.header, Channel::kA, sample.bytes(state.range(0)), sample.frame));
  report(state, sample.size);
}
BENCHMARK(Encode)->Arg(8)->Arg(28)->Arg(127)->ArgName("words");

void Decode(benchmark::State& state) {
  const Sample sample(state.range(0));
  for (auto _ : state)
    benchmark::DoNotOptimize(bus::wire::decode_frame(Channel::kA, std::span(sample.frame).first(sample.size)).error);
  report(state, sample.size);
}
BENCHMARK(Decode)->Arg(8)->Arg(28)->Arg(127)->ArgName("words");

}  // namespace
}  // namespace ttf::wire
BENCHMARK_MAIN();
