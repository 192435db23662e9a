// Words of the records' enumerations: no two enumerators share them, and they lead back to their enumerator.
#include "recording/records/enumerations.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace ttf::recording::records {
namespace {

template <class Enum> void expect_words_of_their_own(unsigned enumerators) {
  const std::string unknown(to_text(static_cast<Enum>(0xff)));
  std::set<std::string> words;
  for (unsigned number = 0; number < 0xff; ++number) {
    const auto one = static_cast<Enum>(number);
    const std::string text(to_text(one));
    if (text == unknown) continue;
    EXPECT_TRUE(words.insert(text).second) << text << " is said twice";
    EXPECT_EQ(from_text<Enum>(text), one) << text;
  }
  EXPECT_EQ(words.size(), enumerators);
  EXPECT_EQ(from_text<Enum>(unknown), std::nullopt);
  EXPECT_EQ(from_text<Enum>(""), std::nullopt);
  EXPECT_EQ(from_text<Enum>("no such words"), std::nullopt);
}

TEST(Enumerations, EachEnumeratorHasWordsThatLeadBackToIt) {
  expect_words_of_their_own<CanError>(5);
  expect_words_of_their_own<CanState>(kCanStates);
  expect_words_of_their_own<PocKind>(kAllPocKinds.size());
  expect_words_of_their_own<Symbol>(3);
  expect_words_of_their_own<TimingFault>(5);
  expect_words_of_their_own<GuardianReason>(kAllGuardianReasons.size());
  expect_words_of_their_own<PlannerState>(4);
}

TEST(Enumerations, ASetOfBitsSaysEachOfThemInTheirOrder) {
  EXPECT_EQ(to_text(ChannelState::kSound), "");
  EXPECT_EQ(to_text(ChannelState::kCut | ChannelState::kHeaderCrc), "header CRC wrong, cut off");
  EXPECT_TRUE(has(ChannelState::kCut | ChannelState::kCoding, ChannelState::kCut));
  EXPECT_FALSE(has(ChannelState::kCoding, ChannelState::kCut | ChannelState::kHeaderCrc));
  EXPECT_EQ(to_text(SlotStatus::kNoFrame | SlotStatus::kSyntaxError), "syntax error, no frame");
  EXPECT_EQ(to_text(SlotStatus::kValidFrame), "status 0");
  EXPECT_EQ(to_text(static_cast<SlotStatus>(64)), "status 64");
}

TEST(Enumerations, OnlyHopsThatLoseAListSaySo) {
  std::set<std::string_view> losses;
  for (unsigned number = 0; number < 0xff; ++number) losses.insert(loss_text(static_cast<Hop>(number)));
  EXPECT_EQ(losses.size(), 5u);  // four, and ""
  EXPECT_EQ(loss_text(Hop::kRead), "");
  EXPECT_EQ(loss_text(Hop::kTorn), "torn");
}

}  // namespace
}  // namespace ttf::recording::records
