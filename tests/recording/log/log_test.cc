// Written records are read back. The same records give the same bytes, and the hash depends on the records
// alone.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <numeric>
#include <set>

#include "core/errors.h"
#include "recording/log/codec.h"
#include "recording/log/log.pb.h"
#include "recording/log/manifest_codec.h"
#include "recording/log/reader.h"
#include "recording/log/writer.h"
#include "recording/records/lateness_bins.h"
#include "recording/records/tee.h"
#include "tests/recording/log/log_fixture.h"
#include "tests/recording/record_text.h"
#include "tests/support/allocation_counter.h"

namespace ttf::recording::log {

namespace {

constexpr int kKinds = static_cast<int>(records::kKindCount);

TEST(Log, ReturnsEveryKindOfRecordWithExtremeValuesBitForBit) {
  TextSink written, read;
  const std::string path = scratch("extremes.mcap");
  LogWriter writer(path, sample_manifest());
  records::Tee both({&writer, &written});
  std::array<std::uint64_t, records::kKindCount> counts{};
  for (const Values values : {Values::kZero, Values::kSmallest, Values::kLargest, Values::kDrawn})
    for (int kind = 1; kind <= kKinds; ++kind)
      for (std::uint32_t i = 0; i < 20; ++i, ++counts[static_cast<std::size_t>(kind - 1)])
        emit(both, kind, values, i, 1'000'000 * i);
  writer.close();

  const LogInfo info = read_log(path, read);
  EXPECT_EQ(info.warning, "");
  EXPECT_FALSE(info.truncated);
  EXPECT_EQ(read.lines, written.lines);
  EXPECT_EQ(info.counts, counts);
  EXPECT_EQ(info.content_hash, writer.content_hash());
  EXPECT_EQ(info.stated_content_hash, writer.content_hash());
  EXPECT_EQ(info.chunks_lost, 0u);
}

TEST(Log, ReturnsManifestAndAttachments) {
  const std::string path = scratch("manifest.mcap");
  std::string binary(100'000, '\0');
  std::iota(binary.begin(), binary.end(), char{});
  {
    LogWriter writer(path, sample_manifest());
    writer.attach("cluster.yaml", "application/yaml", "name: paper\n");
    writer.attach("empty", "", "");
    emit(writer, 1, Values::kDrawn, 0, 0);
    writer.attach("late.bin", "application/octet-stream", binary);
  }  // the destructor closes
  TextSink read;
  const LogInfo info = read_log(path, read);
  EXPECT_EQ(info.warning, "");
  EXPECT_EQ(info.manifest, sample_manifest());
  const std::vector<Attachment> expected{{"cluster.yaml", "application/yaml", "name: paper\n"},
                                         {"empty", "", ""},
                                         {"late.bin", "application/octet-stream", binary}};
  EXPECT_EQ(info.attachments, expected);
  EXPECT_EQ(read.lines.size(), 1u);
}

TEST(Log, EmptyManifestAndNoRecords) {
  const std::string path = scratch("empty.mcap");
  LogWriter(path, LogManifest{}).close();
  TextSink read;
  const LogInfo info = read_log(path, read);
  EXPECT_EQ(info.warning, "");
  EXPECT_EQ(info.manifest, LogManifest{});
  EXPECT_TRUE(read.lines.empty());
}

TEST(Log, SameRecordsGiveTheSameBytes) {
  const auto drive = [](records::Sink& sink) { emit_drive(sink, 3000); };
  const std::string first = log_of(drive), second = log_of(drive);
  EXPECT_EQ(first, second);
  const std::string other = log_of([](records::Sink& sink) { emit_drive(sink, 2999); });
  EXPECT_NE(first, other);
}

// Chunks close on log time or size: a quiet log has a chunk per 250 ms, a dense one chunks of 256 KiB.
TEST(Log, ChunksCloseOnLogTimeOrSize) {
  TextSink read;
  const std::string quiet = log_of([](records::Sink& sink) {
    for (int i = 0; i <= 100; ++i) sink.on(records::PrecisionSample{TrueTime{i * 10'000'000}, i, Duration{1}});  // 1 s
  });
  EXPECT_EQ(read_log_bytes(quiet, "quiet", read).chunks_read,
            4u);  // 0..250, 260..510, 520..770, 780..1000 ms

  const std::vector<std::byte> data(4096);
  const std::string dense = log_of([&data](records::Sink& sink) {
    for (int i = 0; i < 640; ++i) {
      records::FusionInput input;
      input.fragments = data;
      sink.on(input);
    }
  });
  const std::uint64_t chunks = read_log_bytes(dense, "dense", read).chunks_read;
  EXPECT_EQ(chunks, 640 / 64 + 0u);  // 64 messages of a little more than 4 KiB reach 256 KiB
}

TEST(Log, HashChangesWithAnyRecordAndNotWithTheOrderOfArrival) {
  const auto hash = [](const std::vector<std::pair<int, Values>>& records) {
    LogWriter writer(scratch("hash.mcap"), sample_manifest());
    for (const auto& [kind, values] : records) emit(writer, kind, values, 1, 5);
    return writer.content_hash();
  };
  std::set<std::uint64_t> seen{hash({})};
  for (int kind = 1; kind <= kKinds; ++kind)
    for (const Values values : {Values::kZero, Values::kSmallest, Values::kLargest, Values::kDrawn}) {
      const bool counts = records::counts_in_hash(static_cast<records::RecordKind>(kind));
      EXPECT_EQ(seen.insert(hash({{kind, values}})).second, counts) << "kind " << kind;
    }
  // All except records that need an observer of all clocks, and records about the machine.
  int passed_over = 0;
  for (int kind = 1; kind <= kKinds; ++kind)
    passed_over += records::counts_in_hash(static_cast<records::RecordKind>(kind)) ? 0 : 1;
  EXPECT_EQ(passed_over, 4);
  for (const auto kind : {records::kKindOf<records::PrecisionSample>, records::kKindOf<records::TimingProblem>,
                          records::kKindOf<records::LatenessHistogram>, records::kKindOf<records::MediumCounts>})
    EXPECT_EQ(hash({{static_cast<int>(kind), Values::kDrawn}}), hash({})) << records::topic_of(kind);
  // The same record twice hashes differently from once and from an empty log.
  EXPECT_TRUE(seen.insert(hash({{1, Values::kZero}, {1, Values::kZero}})).second);
  EXPECT_EQ(hash({{1, Values::kZero}, {17, Values::kDrawn}}), hash({{17, Values::kDrawn}, {1, Values::kZero}}));
}

TEST(Log, HashChangesWithEveryBitOfAPayload) {
  const auto hash = [](const std::vector<std::byte>& fragments, std::uint32_t sequence, std::int64_t time) {
    LogWriter writer(scratch("hash_bits.mcap"), {});
    records::FusionInput input;
    input.stamp.true_time.ns = time;
    input.sequence = sequence;
    input.fragments = fragments;
    writer.on(input);
    return writer.content_hash();
  };
  std::vector<std::byte> bytes(21, std::byte{0x5a});
  std::set<std::uint64_t> seen{hash(bytes, 0, 0)};
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    std::vector<std::byte> changed = bytes;
    changed[bit / 8] ^= std::byte{1} << static_cast<int>(bit % 8);
    EXPECT_TRUE(seen.insert(hash(changed, 0, 0)).second) << "bit " << bit;
  }
  for (std::uint32_t sequence = 1; sequence < 50; ++sequence) EXPECT_TRUE(seen.insert(hash(bytes, sequence, 0)).second);
  for (std::int64_t time = 1; time < 50; ++time) EXPECT_TRUE(seen.insert(hash(bytes, 0, time)).second);
  for (std::size_t size = 0; size < 21; ++size)
    EXPECT_TRUE(seen.insert(hash(std::vector<std::byte>(size), 0, 0)).second);
}

TEST(Log, HashIsPrintedAsSixteenHexDigits) {
  LogWriter writer(scratch("text.mcap"), {});
  const std::string text = writer.content_hash_text();
  EXPECT_EQ(text.size(), 16u);
  EXPECT_EQ(text.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_EQ(std::stoull(text, nullptr, 16), writer.content_hash());
}

TEST(Log, AFileThatIsNoLogIsInvalidInput) {
  TextSink read;
  const auto message = [&read](const std::string& bytes) {
    try {
      read_log_bytes(bytes, "some/file.mcap", read);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("no error");
  };
  EXPECT_EQ(message("slots: 12\n"), "some/file.mcap: is not a log: it does not begin as an MCAP file does");
  std::string foreign = log_of([](records::Sink&) {});
  // The header of another program's file, and no manifest.
  const std::size_t profile = foreign.find("ttfusion");
  foreign.replace(profile, 8, "rosbags2");
  for (std::size_t at = 0; (at = foreign.find("ttfusion.manifest", at)) != std::string::npos; ++at)
    foreign.replace(at, 8, "whatever");
  EXPECT_EQ(message(foreign), "some/file.mcap: profile = rosbags2: is an MCAP file, but its profile must be ttfusion");
  EXPECT_THROW(read_log("no/such/file.mcap", read), InputError);
  EXPECT_THROW(read_log(std::filesystem::temp_directory_path().string(), read), InputError);
  EXPECT_TRUE(read.lines.empty());
}

// Logs older than the time scale, and all in virtual time, lack it.
TEST(Log, WithoutATimeScaleRealTimeWasTheDrives) {
  LogManifest manifest;
  for (const auto& [key, value] : manifest_entries(manifest)) EXPECT_NE(key, "time_scale_ppm");
  manifest.time_scale_ppm = 20'000'000;
  ManifestEntries entries = manifest_entries(manifest);
  LogManifest read;
  EXPECT_TRUE(read_manifest(entries, read));
  EXPECT_EQ(read.time_scale_ppm, 20'000'000);
  for (const char* impossible : {"0", "-1", "1.5", ""}) {
    for (auto& [key, value] : entries)
      if (key == "time_scale_ppm") value = impossible;
    LogManifest other;
    EXPECT_FALSE(read_manifest(entries, other)) << impossible;
    EXPECT_EQ(other.time_scale_ppm, 1'000'000) << impossible;
  }
}

// Logs of a round of 64 cycles do not say so.
TEST(Log, SaysHowManyCyclesTheCounterHas) {
  LogManifest manifest;
  for (const auto& [key, value] : manifest_entries(manifest)) EXPECT_NE(key, "cycles");
  manifest.cycles = 60;
  ManifestEntries entries = manifest_entries(manifest);
  LogManifest read;
  EXPECT_TRUE(read_manifest(entries, read));
  EXPECT_EQ(read, manifest);
  for (const char* impossible : {"0", "-60", "65", "6.5", ""}) {
    for (auto& [key, value] : entries)
      if (key == "cycles") value = impossible;
    LogManifest other;
    EXPECT_FALSE(read_manifest(entries, other)) << impossible;
    EXPECT_EQ(other.cycles, 64) << impossible;
  }
}

TEST(Log, KeepsHowPicturesShowItsSensors) {
  LogManifest manifest = sample_manifest();
  for (const auto& [key, value] : manifest_entries(manifest)) EXPECT_FALSE(key.starts_with("sensor_")) << key;
  manifest.sensor_styles = {{}, {"camera", "green", ""}, {"", "", "plus"}};
  LogManifest read;
  EXPECT_TRUE(read_manifest(manifest_entries(manifest), read));
  EXPECT_EQ(read, manifest);
  LogManifest other;
  EXPECT_FALSE(read_manifest({{"sensor_colour.256", "green"}}, other)) << "there are no so many sensors";
  EXPECT_TRUE(other.sensor_styles.empty());
}

std::string payload_of(const auto& record) {
  std::string payload;
  encoder([&](const Encoded& encoded) { payload = encoded.payload; })->on(record);
  return payload;
}

TEST(Log, AHistogramHasNoMoreBinsThanThereAre) {
  const std::vector<std::uint64_t> counts(records::kLatenessBins + 1, 1);
  Decoder decoder;
  TextSink read;
  for (const std::size_t bins : {records::kLatenessBins, records::kLatenessBins + 1}) {
    const records::LatenessHistogram histogram{.stamp = {}, .counts = std::span(counts).first(bins)};
    EXPECT_EQ(decoder.decode(records::kKindOf<records::LatenessHistogram>, payload_of(histogram), read),
              bins == records::kLatenessBins);
  }
  EXPECT_EQ(read.lines.size(), 1u);
}

TEST(Log, ATextThatIsNoUtf8IsRefused) {
  Decoder decoder;
  TextSink read;
  for (const std::string_view text : {"", "a", "\u00e4\u20ac\U0001f697"})
    EXPECT_TRUE(decoder.decode(records::kKindOf<records::SequencePlanned>,
                               payload_of(records::SequencePlanned{.stamp = {}, .text = text}), read))
        << text;
  for (const std::string_view text : {"\x80", "a\xc3", "\xc0\xaf", "\xed\xa0\x80", "\xf4\x90\x80\x80"})
    EXPECT_FALSE(decoder.decode(records::kKindOf<records::SequencePlanned>,
                                payload_of(records::SequencePlanned{.stamp = {}, .text = text}), read))
        << text;
  EXPECT_EQ(read.lines.size(), 3u);
}

// A receiver without velocity, or a log older than its recording, gives an absent velocity instead of zero.
TEST(Log, AReferenceWithoutVelocityHasNone) {
  struct Fixes final : records::Sink {
    using records::Sink::on;
    std::vector<records::ReferenceFix> all;
    void on(const records::ReferenceFix& fix) override { all.push_back(fix); }
  } fixes;
  records::ReferenceFix fix;
  fix.x = 3.0;
  ttfusion::Reference payload;
  ASSERT_TRUE(payload.ParseFromString(payload_of(fix)));
  Decoder decoder;
  ASSERT_TRUE(decoder.decode(records::kKindOf<records::ReferenceFix>, payload.SerializeAsString(), fixes));
  payload.clear_vx();
  payload.clear_vy();
  payload.clear_sigma_velocity();
  ASSERT_TRUE(decoder.decode(records::kKindOf<records::ReferenceFix>, payload.SerializeAsString(), fixes));
  ASSERT_EQ(fixes.all.size(), 2u);
  EXPECT_EQ(fixes.all[0].vx, 0.0);
  EXPECT_EQ(fixes.all[1].x, 3.0);
  for (const double value : {fixes.all[1].vx, fixes.all[1].vy, fixes.all[1].sigma_velocity})
    EXPECT_TRUE(std::isnan(value)) << value;
}

TEST(Log, AWriterThatCannotWriteThrows) {
  EXPECT_THROW(LogWriter("no/such/folder/log.mcap", {}), std::runtime_error);
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full here to fail writing to";
  LogWriter writer("/dev/full", {});
  emit_drive(writer, 100);
  EXPECT_THROW(writer.close(), std::runtime_error);
}

// A first drive shows the lists' largest sizes. After that, a second of log allocates nothing per record. One
// entry per chunk remains in the index, whose memory doubles now and then.
TEST(Log, RecordingDoesNotAllocatePerRecord) {
  LogWriter writer(scratch("allocations.mcap"), {});
  std::vector<std::int64_t> counts;
  std::array<records::ImageObject, 25> images{};
  std::array<records::FeatureObject, 25> features{};
  std::array<MeasurementId, 3> newest{};
  std::array<ObjectId, 200> ids{};
  std::array<std::byte, 262> bytes{};
  std::array<std::uint64_t, 600> late{};
  const std::array<double, 6> state{1};
  const std::array<double, 36> covariance{1};
  for (int second = 0; second < 4; ++second) {
    const std::int64_t before = support::allocations();
    for (int i = 0; i < 1000; ++i) {
      const std::size_t objects = static_cast<std::size_t>(i) % 26;  // lists that grow and shrink
      records::Stamp stamp;
      stamp.true_time.ns = (second * 1000 + i) * 1'000'000ll;
      writer.on(records::Measured{stamp, {}, std::span(ids).first(objects * 8)});
      writer.on(records::SlotFrameSent{.stamp = stamp, .bytes = std::span(bytes).first(objects * 10)});
      writer.on(records::ListHop{stamp});
      writer.on(records::TaskRun{stamp});
      writer.on(records::TrackState{stamp, 1, TrackId{1}, {}, state, covariance, false});
      writer.on(records::ImageWritten{stamp, 1, {}, {}, std::span(images).first(objects), newest});
      writer.on(records::FeatureUsed{stamp, 1, {}, true, std::span(features).first(objects)});
      writer.on(records::StateChanged{stamp, records::PocKind::kColdstartCollisionResolution,
                                      records::PocKind::kColdstartConsistencyCheck, "coldstart collision resolution",
                                      "coldstart consistency check",
                                      i % 2 == 0 ? "no other node tried to start the cluster in four cycles" : "", ""});
      writer.on(records::LatenessHistogram{.stamp = stamp, .counts = std::span(late).first(objects * 20)});
    }
    counts.push_back(support::allocations() - before);
  }
  EXPECT_LE(counts[1], 20) << "9000 records";
  EXPECT_LE(counts[2], 20) << "9000 records";
  EXPECT_LE(counts[3], 20) << "9000 records";
}

}  // namespace
}  // namespace ttf::recording::log
