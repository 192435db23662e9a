#include "core/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace ttf {
namespace {

// Known-answer vectors of the Random123 distribution (kat_vectors, philox4x32 10).
TEST(Philox, KnownAnswers) {
  using Words = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox4x32_10({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32_10({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32_10({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, SameKeySameDrawsOtherKeyOthers) {
  const StreamKey key{42, 0, Purpose::kTest, 3, 7};
  RandomStream a(key), b(key);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.bits(), b.bits());
  for (int field = 0; field < 5; ++field) {
    StreamKey other = key;
    if (field == 0) other.seed++;
    if (field == 1) other.replication++;
    if (field == 2) other.purpose = Purpose::kClutter;
    if (field == 3) other.entity++;
    if (field == 4) other.index++;
    EXPECT_NE(RandomStream(key).bits(), RandomStream(other).bits()) << "field " << field;
  }
}

TEST(RandomStream, UniformAndNormalHaveTheirMoments) {
  RandomStream stream({1, 0, Purpose::kTest, 0, 0});
  constexpr int kDraws = 200'000;
  double sum = 0, squares = 0, fourth = 0, uniform = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double n = stream.normal();
    sum += n;
    squares += n * n;
    fourth += n * n * n * n;
    const double u = stream.uniform();
    ASSERT_GE(u, 0.0);
    ASSERT_LT(u, 1.0);
    uniform += u;
  }
  // Five standard errors of each estimate.
  EXPECT_NEAR(sum / kDraws, 0.0, 5 / std::sqrt(kDraws));
  EXPECT_NEAR(squares / kDraws, 1.0, 5 * std::sqrt(2.0 / kDraws));
  EXPECT_NEAR(fourth / kDraws, 3.0, 5 * std::sqrt(96.0 / kDraws));
  EXPECT_NEAR(uniform / kDraws, 0.5, 5 * std::sqrt(1.0 / 12 / kDraws));
}

TEST(RandomStream, IntegersCoverTheirRangeEvenly) {
  RandomStream stream({2, 0, Purpose::kTest, 0, 0});
  std::array<int, 6> count{};
  for (int i = 0; i < 60'000; ++i) ++count[static_cast<std::size_t>(stream.integer(-2, 3) + 2)];
  for (const int n : count) EXPECT_NEAR(n, 10'000, 5 * std::sqrt(10'000));
  EXPECT_EQ(stream.integer(5, 5), 5);
}

// A part read alone equals the same part of the whole stream: two uniform numbers to a block.
TEST(RandomStream, APartOfAStreamIsReadWithoutTheOthers) {
  const StreamKey key{.seed = 5, .entity = 3, .index = 9};
  RandomStream whole(key);
  for (std::uint32_t block = 0; block < 50; ++block) {
    RandomStream part(key, block);
    for (int k = 0; k < 2; ++k) EXPECT_EQ(part.bits(), whole.bits()) << block;
  }
}

TEST(RandomStream, DrawsTakeAsManyWordsAsTheySay) {
  const StreamKey key{.seed = 5, .entity = 3, .index = 9};
  const auto words_until = [&](RandomStream stream) {
    const std::uint64_t next = stream.bits();
    std::uint32_t words = 0;
    for (RandomStream whole(key); words < 100 && whole.bits() != next;) words += 2;
    return words;
  };
  RandomStream uniform(key), normal(key);
  uniform.uniform();
  EXPECT_EQ(words_until(uniform), RandomStream::kWordsOfUniform);
  normal.normal();
  EXPECT_EQ(words_until(normal), RandomStream::kWordsOfANormalPair);
  normal.normal();
  EXPECT_EQ(words_until(normal), RandomStream::kWordsOfANormalPair) << "the second of a pair takes none";
}

}  // namespace
}  // namespace ttf
