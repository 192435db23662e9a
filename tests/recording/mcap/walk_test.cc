// The walk through damaged files: its work grows with their size, whatever the bytes are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "core/random.h"
#include "recording/mcap/bytes.h"
#include "recording/mcap/chunk.h"
#include "recording/mcap/metadata.h"
#include "recording/mcap/reader.h"

namespace ttf::recording::mcap {
namespace {

struct Received final : McapHandler {
  void on_metadata(std::string_view name, const std::vector<std::pair<std::string, std::string>>& entries) override {
    names.emplace_back(name);
    count += entries.size();
  }
  void on_attachment(std::string_view, std::string_view, std::string_view) override {}
  bool on_message(std::uint16_t, std::uint64_t, std::string_view) override { return true; }
  std::vector<std::string> names;
  std::size_t count = 0;
};

std::string beginning() {
  std::string bytes(kMcapMagic);
  const std::size_t header = begin_record(bytes, Opcode::kHeader);
  put_text(bytes, "ttfusion");
  put_text(bytes, "");
  end_record(bytes, header);
  return bytes;
}

template <class Int> void write_at(std::string& bytes, std::size_t at, Int value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

// Makes the bytes from `at` on the head of a metadata record that ends at `end`, with an empty name.
constexpr std::size_t kHead = kRecordHead + 8;
void claim_metadata(std::string& bytes, std::size_t at, std::size_t end) {
  bytes[at] = static_cast<char>(Opcode::kMetadata);
  write_at(bytes, at + 1, static_cast<std::uint64_t>(end - at - kRecordHead));
  write_at(bytes, at + kRecordHead, std::uint32_t{0});
  write_at(bytes, at + kRecordHead + 4, static_cast<std::uint32_t>(end - at - kHead));
}

// Heads of metadata records that all claim to end behind the last. Each head is an entry of those before it, and the
// last entry does not fit. Sound records of another kind, `between`, stand before each head.
std::string chain(int count, const std::string& between) {
  std::string bytes = beginning();
  std::vector<std::size_t> heads;
  for (int i = 0; i < count; ++i) {
    bytes += between;
    heads.push_back(bytes.size());
    bytes.append(kHead, '\0');
    // An entry without a key. Its value is the next head, with the record before it.
    put(bytes, std::uint32_t{0});
    put(bytes, static_cast<std::uint32_t>(kHead + between.size()));
  }
  bytes.append(4, '\xff');
  for (const std::size_t head : heads) claim_metadata(bytes, head, bytes.size());
  return bytes;
}

// As before, but many claim an end of their own, within an entry.
std::string chain_with_many_ends(int count) {
  std::string bytes = chain(count, "");
  const std::size_t first = beginning().size(), step = kHead + 8;
  const auto heads = static_cast<std::size_t>(count);
  for (std::size_t i = 0; i + 1 < heads / 2; ++i)
    claim_metadata(bytes, first + i * step, first + kHead + (heads - 2 - i) * step + 1 + i % (step - 1));
  return bytes;
}

// A head before empty entries, the last of which does not fit.
std::string zeros(int count) {
  std::string bytes = beginning();
  const std::size_t head = bytes.size();
  bytes.append(kHead + 8 * static_cast<std::size_t>(count) + 3, '\0');
  claim_metadata(bytes, head, bytes.size());
  return bytes;
}

// Ends of the data section, with their sums.
std::string data_ends(int count) {
  std::string bytes = beginning();
  std::uint32_t crc = 0;
  for (std::size_t i = 0, summed = 0; i < static_cast<std::size_t>(count); ++i) {
    crc = crc_of(std::string_view(bytes).substr(summed), crc);
    summed = bytes.size();
    const std::size_t start = begin_record(bytes, Opcode::kDataEnd);
    put(bytes, crc);
    end_record(bytes, start);
  }
  return bytes;
}

std::string data_end() {
  std::string bytes;
  const std::size_t start = begin_record(bytes, Opcode::kDataEnd);
  put(bytes, std::uint32_t{0});
  end_record(bytes, start);
  return bytes;
}

TEST(Walk, OfACraftedFileIsWorkInProportion) {
  for (const int count : {100, 1'000, 20'000})
    for (const std::string& bytes :
         {chain(count, ""), chain(count, data_end()), chain_with_many_ends(count), zeros(count), data_ends(count)}) {
      Received received;
      const McapReport report = walk_mcap(bytes, received);
      EXPECT_LE(report.work, 4 * bytes.size()) << count << " of something in " << bytes.size() << " bytes";
      EXPECT_TRUE(received.names.empty());
    }
}

// A sound record behind the heads is found.
TEST(Walk, FindsMetadataBehindCraftedOnes) {
  std::string bytes = chain(50, "");
  std::string entries;
  for (int i = 0; i < 3; ++i) put_text(entries, "key"), put_text(entries, "value");
  const std::size_t start = begin_record(bytes, Opcode::kMetadata);
  put_text(bytes, "sound");
  put_text(bytes, entries);
  end_record(bytes, start);
  Received received;
  const McapReport report = walk_mcap(bytes, received);
  EXPECT_EQ(received.names, std::vector<std::string>{"sound"});
  EXPECT_EQ(received.count, 3u);
  ASSERT_FALSE(report.warnings.empty());
  EXPECT_EQ(report.warnings.front(),
            "the record at byte " + std::to_string(beginning().size()) + " is damaged and left out");
}

// Drawn bytes of which most are small numbers, so that lengths often fit; the plain way reads each candidate alone.
TEST(Metadata, ConsistentOnesAreThoseOfThePlainWay) {
  std::size_t consistent = 0, others = 0, together = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    RandomStream draw({.seed = seed, .purpose = Purpose::kTest, .entity = 31});
    std::string bytes(static_cast<std::size_t>(draw.integer(30, 600)), '\0');
    const auto place = [&](std::size_t room) {
      return static_cast<std::size_t>(draw.integer(0, static_cast<std::int64_t>(bytes.size() - room)));
    };
    for (int i = 0; i < 20; ++i) bytes[place(1)] = static_cast<char>(draw.integer(0, 24));
    std::vector<std::size_t> ends;
    for (int i = 0; i < 12; ++i) {
      const std::size_t at = place(kHead);
      std::size_t end =
          at + kHead + static_cast<std::size_t>(draw.integer(0, static_cast<std::int64_t>(bytes.size() - at - kHead)));
      if (!ends.empty() && ends.back() >= at + kHead && draw.uniform() < 0.5) end = ends.back();
      if (draw.uniform() < 0.6) end = at + kHead + (end - at - kHead) / 8 * 8;
      ends.push_back(end);
      claim_metadata(bytes, at, end);
    }
    const auto from = static_cast<std::size_t>(draw.integer(0, 10));
    std::vector<std::size_t> expected;
    for (std::size_t at = from; at < bytes.size(); ++at) {
      const auto record = record_at(bytes, at);
      if (!record || record->opcode != static_cast<std::uint8_t>(Opcode::kMetadata)) continue;
      std::string_view name;
      if (read_metadata(record->content, name, nullptr))
        expected.push_back(at);
      else
        ++others;
    }
    std::uint64_t work = 0;
    ASSERT_EQ(consistent_metadata(bytes, from, work), expected) << seed;
    consistent += expected.size();
    together += expected.size() > 1 ? 1 : 0;
  }
  EXPECT_GT(consistent, 300u);
  EXPECT_GT(together, 50u);
  EXPECT_GT(others, 300u);
}

}  // namespace
}  // namespace ttf::recording::mcap
