// A member's stream of another, sample by sample (bus/dds/exchange/stream.h), and the messages that all have
// received (bus/dds/exchange/received_counts.h).
#include "bus/dds/exchange/stream.h"

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bus/dds/exchange/received_counts.h"

namespace ttf::bus::dds::exchange {
namespace {

constexpr NodeId kSender{3};
constexpr std::size_t kPlenty = 1 << 20;

common::Entry said(std::uint64_t number, common::Kind kind = common::Kind::kMessage, std::size_t size = 8) {
  return {number, kind, std::make_shared<const std::vector<std::byte>>(size)};
}

// The received messages as text: "0 1 2 bye".
class StreamTest : public testing::Test {
 protected:
  void accept(std::uint64_t number, common::Kind kind = common::Kind::kMessage) {
    stream_.accept(said(number, kind), entries_);
  }
  void close(std::uint64_t end) { stream_.close(end, entries_); }
  std::string received() const {
    std::string text;
    for (const common::Entry& entry : entries_)
      text += (text.empty() ? "" : " ") + (entry.kind == common::Kind::kBye ? "bye" : std::to_string(entry.number));
    return text;
  }
  static std::string error_of(const std::function<void()>& work) {
    try {
      work();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "none";
  }

  Stream stream_{kSender, kPlenty};
  std::vector<common::Entry> entries_;
};

TEST_F(StreamTest, IsReceivedInOrderAndEachSampleOnce) {
  for (const std::uint64_t number : {0, 1, 0, 1, 2, 1, 3}) accept(number);
  EXPECT_EQ(received(), "0 1 2 3");
  EXPECT_EQ(stream_.received(), 4u);
}

TEST_F(StreamTest, AGapIsAnErrorThatNamesIt) {
  accept(0);
  EXPECT_EQ(error_of([this] { accept(5); }), "exchange: samples 1 to 4 of node 3 are lost");
}

TEST_F(StreamTest, EndsWithItsGoodbye) {
  accept(0);
  accept(1, common::Kind::kBye);
  EXPECT_TRUE(stream_.closed());
  accept(2);
  EXPECT_EQ(received(), "0 bye");
}

TEST_F(StreamTest, BehindTheFenceNothingIsReceivedUntilItIsClosed) {
  accept(0);
  EXPECT_EQ(stream_.fence(), 1u);
  accept(1);
  accept(2);
  EXPECT_EQ(received(), "0");
  close(2);
  EXPECT_EQ(received(), "0 1 bye");  // 2 was received by no survivor when they reported
  accept(2);
  accept(3);
  EXPECT_EQ(received(), "0 1 bye");
}

TEST_F(StreamTest, MissingSamplesThatComeInAnyOrderAreReceivedInOrder) {
  accept(0);
  stream_.fence();
  close(4);
  EXPECT_TRUE(stream_.wanting());
  EXPECT_EQ(stream_.missing(), "exchange: samples 1 to 3 of node 3 are lost");
  accept(3);
  accept(2);
  EXPECT_EQ(stream_.missing(), "exchange: samples 1 to 1 of node 3 are lost");
  accept(1);
  EXPECT_EQ(received(), "0 1 2 3 bye");
  EXPECT_TRUE(stream_.closed());
}

TEST_F(StreamTest, AGoodbyeSaidAgainEndsItOnce) {
  accept(0);
  stream_.fence();
  close(3);
  accept(1);
  accept(2, common::Kind::kBye);
  EXPECT_EQ(received(), "0 1 bye");
}

TEST_F(StreamTest, ALaterRoundMayEndItEarlier) {
  accept(0);
  stream_.fence();
  close(4);
  accept(1);
  EXPECT_EQ(stream_.fence(), 2u);  // the member with the rest has died
  accept(2);
  EXPECT_EQ(received(), "0 1");
  close(2);
  EXPECT_EQ(received(), "0 1 bye");
}

TEST_F(StreamTest, ClosedItReportsAllItReceivedInALaterRoundAndStaysClosed) {
  accept(0);
  accept(1, common::Kind::kBye);
  EXPECT_EQ(stream_.fence(), 2u);
  close(2);
  EXPECT_TRUE(stream_.closed());
  EXPECT_EQ(received(), "0 bye");
}

TEST_F(StreamTest, KeepsWhatNotEverybodyHasReceived) {
  for (std::uint64_t i = 0; i < 10; ++i) accept(i);
  stream_.settle(4);
  ASSERT_EQ(stream_.again(4).size(), 6u);
  EXPECT_EQ(stream_.again(4).front().number, 4u);
  EXPECT_EQ(stream_.again(9).size(), 1u);
  EXPECT_TRUE(stream_.again(10).empty());
  EXPECT_EQ(error_of([this] { stream_.again(2); }),
            "exchange: samples 2 to 3 of node 3 are lost to others, and this node no longer has them");
}

TEST_F(StreamTest, KeepsNoMoreThanItMay) {
  Stream small(kSender, 10'000);
  for (std::uint64_t i = 0; i < 100; ++i) small.accept(said(i, common::Kind::kMessage, 904), entries_);  // 1000 each
  EXPECT_EQ(small.again(90).size(), 10u);
  EXPECT_NE(error_of([&] { small.again(89); }), "none");
  Stream none(kSender, 0);
  none.accept(said(0), entries_);
  EXPECT_NE(error_of([&] { none.again(0); }), "none");
}

TEST(Received, ReportsSurviveTheWire) {
  const ReceivedCounts received{{NodeId{0}, 0}, {NodeId{7}, 0x0123456789abcdef}, {NodeId{255}, 300}};
  EXPECT_EQ(decode(encode(received)), received);
  EXPECT_EQ(encode({{NodeId{2}, 0x0102}}),
            (std::vector<std::byte>{std::byte{2}, std::byte{2}, std::byte{1}, {}, {}, {}, {}, {}, {}}));
  auto bytes = encode(received);
  bytes.pop_back();
  EXPECT_THROW(decode(bytes), std::runtime_error);
  auto twice = encode({{NodeId{1}, 5}});
  twice.insert(twice.end(), twice.begin(), twice.begin() + 9);
  EXPECT_THROW(decode(twice), std::runtime_error);
}

TEST(Received, ReceivedByAllIsTheLeastOfTheRemainingMembers) {
  const NodeId a{1}, b{2}, c{3};
  ReceivedTable table({a, b, c});
  EXPECT_EQ(table.by_all(a), 0u);
  table.note(b, {{a, 10}, {c, 3}});
  EXPECT_EQ(table.by_all(a), 0u);  // c has not spoken yet
  table.note(c, {{a, 7}, {b, 2}});
  EXPECT_EQ(table.by_all(a), 7u);
  EXPECT_EQ(table.by_all(c), 0u);  // a has not
  table.without(a);
  EXPECT_EQ(table.by_all(c), 3u);
  EXPECT_EQ(table.by_all(a), 7u);  // also for a member that has gone: it may need repeating
  table.without(c);
  EXPECT_EQ(table.by_all(a), 10u);
}

}  // namespace
}  // namespace ttf::bus::dds::exchange
