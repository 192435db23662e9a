// Truncated or damaged logs: sound records are read, the rest is reported, without a crash.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "core/errors.h"
#include "core/random.h"
#include "recording/log/reader.h"
#include "recording/records/tee.h"
#include "tests/recording/log/log_fixture.h"
#include "tests/recording/record_text.h"
#include "tests/support/refusals.h"

namespace ttf::recording::log {
namespace {

struct Result {
  LogInfo info;
  std::vector<std::string> lines;
};

Result read(std::string_view bytes) {
  TextSink sink;
  LogInfo info = read_log_bytes(bytes, "log.mcap", sink);
  return {std::move(info), std::move(sink.lines)};
}

// A second of log in several chunks.
const std::string& small_log() {
  static const std::string bytes = log_of([](records::Sink& sink) {
    for (std::uint32_t i = 0; i < 36; ++i) emit(sink, kind_of(i), Values::kDrawn, i, std::int64_t{i} * 30'000'000);
  });
  return bytes;
}

bool is_prefix(const std::vector<std::string>& part, const std::vector<std::string>& whole) {
  return part.size() <= whole.size() && std::equal(part.begin(), part.end(), whole.begin());
}

// The refusal of a log cut to this size; empty if it is read.
std::string refusal(std::size_t size) {
  return support::refusal_of([&] { (void)read(std::string_view(small_log()).substr(0, size)); });
}

// The smallest readable part: it has the manifest.
std::size_t least_log() {
  std::size_t size = 0;
  while (!refusal(size).empty()) ++size;
  return size;
}

TEST(LogDamage, AFileThatEndsBeforeItsManifestIsNoLog) {
  const std::size_t least = least_log();
  EXPECT_GT(least, 100u);
  EXPECT_LT(least, small_log().size() / 4) << "before the first chunk";
  EXPECT_EQ(refusal(0), "log.mcap: is not a log: it does not begin as an MCAP file does");
  EXPECT_EQ(refusal(7), "log.mcap: is not a log: it does not begin as an MCAP file does");
  EXPECT_EQ(refusal(100), "log.mcap: holds only the beginning of a log: 100 bytes, no manifest, no record");
  for (std::size_t size = least; size < small_log().size(); size += 501) EXPECT_EQ(refusal(size), "") << size;
}

// The number of records in a cut log, for each length from the least on. Counted once, because it takes long.
const std::vector<std::size_t>& records_by_length() {
  static const std::vector<std::size_t> counts = [] {
    const Result whole = read(small_log());
    std::vector<std::size_t> out;
    for (std::size_t size = least_log(); size < small_log().size(); ++size) {
      const Result cut = read(std::string_view(small_log()).substr(0, size));
      EXPECT_TRUE(cut.info.truncated) << size;
      EXPECT_NE(cut.info.warning.find("log.mcap: the log was cut off at byte " + std::to_string(size)),
                std::string::npos)
          << size << ": " << cut.info.warning;
      EXPECT_TRUE(is_prefix(cut.lines, whole.lines)) << size;
      EXPECT_EQ(cut.info.chunks_lost, 0u) << size;
      out.push_back(cut.lines.size());
    }
    return out;
  }();
  return counts;
}

TEST(LogDamage, CutAnywhereItIsReadUpToTheCut) {
  const std::string& bytes = small_log();
  const Result whole = read(bytes);
  ASSERT_EQ(whole.lines.size(), 36u);
  ASSERT_EQ(whole.info.warning, "");
  ASSERT_GE(whole.info.chunks_read, 4u);
  const std::vector<std::size_t>& counts = records_by_length();
  EXPECT_TRUE(std::is_sorted(counts.begin(), counts.end())) << "a longer beginning holds no less";
  EXPECT_EQ(counts.back(), whole.lines.size());
  EXPECT_EQ(std::set<std::size_t>(counts.begin(), counts.end()).size(), whole.info.chunks_read + 1);
}

// Cut at the writer's position after each flush: the result of a process crash.
TEST(LogDamage, ClosedChunksAreInTheFileBeforeTheWriterCloses) {
  const std::string path = scratch("crash.mcap");
  LogWriter writer(path, sample_manifest());
  TextSink written;
  records::Tee both({&writer, &written});
  emit_drive(both, 1000);  // 1 s: chunks of 250 ms
  TextSink sink;
  const LogInfo info = read_log(path, sink);
  EXPECT_TRUE(info.truncated);
  EXPECT_EQ(info.manifest, sample_manifest());
  EXPECT_TRUE(is_prefix(sink.lines, written.lines));
  EXPECT_GE(sink.lines.size(), 740u);
  EXPECT_LT(sink.lines.size(), 1000u);
}

// Adds the numbers of records that beginnings of `low` to `high` bytes hold. A longer one holds no less, so two lengths
// with the same number have nothing between them.
void add_borders(std::size_t low, std::size_t high, std::set<std::size_t>& borders) {
  const auto records = [](std::size_t size) {
    return read(std::string_view(small_log()).substr(0, size)).lines.size();
  };
  const auto split = [&](const auto& self, std::size_t from, std::size_t at_from, std::size_t to,
                         std::size_t at_to) -> void {
    borders.insert({at_from, at_to});
    if (at_from == at_to || to - from < 2) return;
    const std::size_t middle = (from + to) / 2, at_middle = records(middle);
    self(self, from, at_from, middle, at_middle);
    self(self, middle, at_middle, to, at_to);
  };
  split(split, low, records(low), high, records(high));
}

// One byte changed anywhere: at most one chunk's records are missing, no record is changed, and the loss is
// reported.
TEST(LogDamage, OneChangedByteCostsAtMostItsChunk) {
  const std::string& bytes = small_log();
  const Result whole = read(bytes);
  std::set<std::size_t> borders;
  add_borders(least_log(), bytes.size() - 1, borders);
  std::map<std::pair<std::size_t, std::size_t>, int> chunks;  // from and to which record, and how often it was lost
  for (auto border = borders.begin(); std::next(border) != borders.end(); ++border)
    chunks[{*border, *std::next(border)}] = 0;
  ASSERT_EQ(chunks.size(), whole.info.chunks_read);

  int no_log = 0, nothing_lost = 0;
  for (std::uint32_t seed = 0; seed < 4'000; ++seed) {
    RandomStream stream({.seed = seed, .purpose = Purpose::kTest});
    std::string damaged = bytes;
    const std::size_t drawn = static_cast<std::size_t>(stream.integer(0, static_cast<std::int64_t>(bytes.size()) - 1));
    const std::size_t at = seed < 8 ? seed : drawn;  // each byte of the magic
    damaged[at] = static_cast<char>(damaged[at] ^ static_cast<char>(stream.integer(1, 255)));
    if (at < 8) {
      EXPECT_THROW(read(damaged), InputError) << seed;  // the magic: not an MCAP file
      ++no_log;
      continue;
    }
    const Result result = read(damaged);
    ASSERT_NE(result.info.warning, "") << "seed " << seed << " byte " << at;
    if (result.lines == whole.lines) {
      ++nothing_lost;
      continue;
    }
    // Otherwise it is the whole log without one of its chunks.
    const auto first = std::mismatch(result.lines.begin(), result.lines.end(), whole.lines.begin()).first;
    const auto from = static_cast<std::size_t>(first - result.lines.begin());
    const std::size_t missing = whole.lines.size() - result.lines.size();
    const auto lost = chunks.find({from, from + missing});
    ASSERT_NE(lost, chunks.end()) << "seed " << seed << " byte " << at << ": records " << from << " to "
                                  << from + missing << " are missing";
    ++lost->second;
    ASSERT_TRUE(
        std::equal(first, result.lines.end(), whole.lines.begin() + static_cast<std::ptrdiff_t>(from + missing)))
        << "seed " << seed << " byte " << at;
    ASSERT_NE(result.info.warning.find("byte "), std::string::npos) << result.info.warning;
  }
  EXPECT_GE(no_log, 8);
  EXPECT_GT(nothing_lost, 1'000);
  for (const auto& [records, times] : chunks) EXPECT_GT(times, 20) << "records from " << records.first;
}

// With several bytes changed there is no crash, no endless reading, and no invented record.
TEST(LogDamage, ManyChangesNeverCrashNorInventRecords) {
  const std::string& bytes = small_log();
  const Result whole = read(bytes);
  const std::set<std::string> known(whole.lines.begin(), whole.lines.end());
  for (std::uint32_t seed = 0; seed < 10'000; ++seed) {
    RandomStream stream({.seed = seed, .purpose = Purpose::kTest, .entity = 1});
    std::string damaged = bytes;
    for (std::int64_t changes = stream.integer(2, 12); changes > 0; --changes) {
      const auto at = static_cast<std::size_t>(stream.integer(8, static_cast<std::int64_t>(damaged.size()) - 1));
      switch (stream.integer(0, 3)) {
        case 0: damaged[at] = static_cast<char>(stream.integer(0, 255)); break;
        case 1: damaged.erase(at, static_cast<std::size_t>(stream.integer(1, 40))); break;
        case 2: damaged.insert(at, static_cast<std::size_t>(stream.integer(1, 40)), '\xff'); break;
        default: damaged.insert(at, damaged.substr(8, static_cast<std::size_t>(stream.integer(1, 300))));
      }
    }
    try {
      const Result result = read(damaged);
      for (const std::string& record : result.lines) ASSERT_EQ(known.count(record), 1u) << "seed " << seed;
    } catch (const InputError&) {
      // Both header and manifest gone: no longer a log of this program.
    }
  }
}

// Chunks without a checksum (0 means "none" in MCAP) reach the decoder with any content: it must not trust
// them.
TEST(LogDamage, UncheckedPayloadsAreDecodedWithCare) {
  const auto put = [](std::string& out, std::uint64_t value, int size) {
    for (int i = 0; i < size; ++i) out += i < 8 ? static_cast<char>(value >> (8 * i)) : '\0';
  };
  const std::string& bytes = small_log();
  const std::size_t header = bytes.find('\x0c', 8);  // the manifest's record follows the header
  for (std::uint32_t seed = 0; seed < 3000; ++seed) {
    RandomStream stream({.seed = seed, .purpose = Purpose::kTest, .entity = 2});
    std::string records;
    for (int i = 0; i < 5; ++i) {
      std::string payload;
      for (std::int64_t left = stream.integer(0, 60); left > 0; --left)
        payload += static_cast<char>(stream.uniform() < 0.5 ? stream.integer(0, 30) : stream.integer(0, 255));
      put(records, 5, 1);
      put(records, payload.size() + (stream.uniform() < 0.05 ? 1000 : 22), 8);
      put(records, static_cast<std::uint64_t>(stream.integer(0, 20)), 2);
      put(records, 0, 4);
      put(records, 0, 16);
      records += payload;
    }
    std::string log = bytes.substr(0, header);
    put(log, 6, 1);
    put(log, 40 + records.size(), 8);
    put(log, 0, 16);
    put(log, records.size(), 8);
    put(log, 0, 4);  // no checksum
    put(log, 0, 4);  // no compression
    put(log, records.size(), 8);
    log += records;
    const Result result = read(log);
    ASSERT_EQ(result.info.chunks_read, 1u);
    ASSERT_LE(result.lines.size(), 5u);
  }
}

TEST(LogDamage, AHugeClaimedSizeIsNotAllocated) {
  std::string bytes = small_log();
  // The first chunk's uncompressed size stands before its checksum and the length of the compression's name.
  const std::size_t at = bytes.find("zstd") - 4 - 4 - 8;
  bytes.replace(at, 8, std::string("\0\0\0\0\0\0\0\x7f", 8));
  const Result result = read(bytes);
  EXPECT_EQ(result.info.chunks_lost, 1u);
  EXPECT_FALSE(result.info.truncated);
  EXPECT_NE(result.info.warning.find("the chunk at byte"), std::string::npos) << result.info.warning;
}

}  // namespace
}  // namespace ttf::recording::log
