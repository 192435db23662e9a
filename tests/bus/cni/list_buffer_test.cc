#include "bus/cni/list_buffer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <vector>

#include "core/random.h"
#include "tests/bus/layouts.h"

namespace ttf::bus::cni {
namespace {

using enum ArrivalEffect;

// A reader must see exactly one written list.
void expect_latest(const IncomingList& incoming, const MadeList& list) {
  const auto latest = incoming.latest();
  ASSERT_TRUE(latest.has_value());
  EXPECT_EQ(latest->sequence, list.sequence);
  EXPECT_EQ(latest->fragments, list.fragments);
  EXPECT_TRUE(std::equal(latest->bytes.begin(), latest->bytes.end(), list.bytes.begin(), list.bytes.end()));
}

TEST(IncomingList, IsEmptyUntilTheFirstListIsComplete) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  EXPECT_FALSE(incoming.latest());
  MadeList list(layout, 0, 10, 100);
  for (int f = 0; f < 3; ++f) {
    EXPECT_EQ(incoming.arrive(list.fragment(f)), kIncomplete);
    EXPECT_FALSE(incoming.latest());
  }
  EXPECT_EQ(incoming.arrive(list.fragment(3)), kCompleted);
  expect_latest(incoming, list);
}

TEST(IncomingList, FragmentsMayComeInAnyOrder) {
  const auto layout = list_layout();
  int order[] = {0, 1, 2, 3};
  std::uint32_t sequence = 0;
  IncomingList incoming(layout);
  do {
    MadeList list(layout, sequence, 10, 7 * sequence);
    ++sequence;
    for (int i = 0; i < 3; ++i) EXPECT_EQ(incoming.arrive(list.fragment(order[i])), kIncomplete);
    EXPECT_EQ(incoming.arrive(list.fragment(order[3])), kCompleted);
    expect_latest(incoming, list);
  } while (std::next_permutation(std::begin(order), std::end(order)));
}

TEST(IncomingList, AnEmptyListIsAMessageToo) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  MadeList list(layout, 3, 0, 0);
  EXPECT_EQ(list.fragments, 1);
  EXPECT_EQ(incoming.arrive(list.fragment(0)), kCompleted);
  expect_latest(incoming, list);
}

TEST(IncomingList, TwoChannelsGiveOneList) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  MadeList list(layout, 1, 7, 5);
  EXPECT_EQ(incoming.arrive(list.fragment(0)), kIncomplete);
  EXPECT_EQ(incoming.arrive(list.fragment(0)), kDuplicate);
  EXPECT_EQ(incoming.arrive(list.fragment(1)), kIncomplete);
  EXPECT_EQ(incoming.arrive(list.fragment(1)), kDuplicate);
  EXPECT_EQ(incoming.arrive(list.fragment(2)), kCompleted);
  EXPECT_EQ(incoming.arrive(list.fragment(2)), kDuplicate);
  EXPECT_EQ(incoming.arrived(), 1u);
  expect_latest(incoming, list);
}

// One channel loses a fragment, the other another: together they have the list.
TEST(IncomingList, ChannelsCompleteEachOther) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  MadeList list(layout, 1, 7, 5);
  EXPECT_EQ(incoming.arrive(list.fragment(0)), kIncomplete);  // A
  EXPECT_EQ(incoming.arrive(list.fragment(2)), kIncomplete);  // B
  EXPECT_EQ(incoming.arrive(list.fragment(1)), kCompleted);   // A
  expect_latest(incoming, list);
}

TEST(IncomingList, ARepeatedListIsNotCollectedAgain) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  MadeList list(layout, 2, 9, 1);
  for (int f = 0; f < 3; ++f) incoming.arrive(list.fragment(f));
  for (int repetition = 0; repetition < 5; ++repetition)
    for (int f = 0; f < 3; ++f) EXPECT_EQ(incoming.arrive(list.fragment(f)), kDuplicate);
  // And the next list does not find a half-collected repetition in its way.
  incoming.arrive(list.fragment(0));
  MadeList next(layout, 3, 9, 2);
  EXPECT_EQ(incoming.arrive(next.fragment(0)), kIncomplete);
}

TEST(IncomingList, ATornListIsNeverHandedOut) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  MadeList whole(layout, 1, 9, 10), torn(layout, 2, 9, 20), next(layout, 3, 9, 30);
  for (int f = 0; f < 3; ++f) incoming.arrive(whole.fragment(f));
  EXPECT_EQ(incoming.arrive(torn.fragment(0)), kIncomplete);
  EXPECT_EQ(incoming.arrive(torn.fragment(1)), kIncomplete);
  EXPECT_EQ(incoming.torn(), std::nullopt);
  EXPECT_EQ(incoming.arrive(next.fragment(0)), kTorn);
  EXPECT_EQ(incoming.arrived(), 3u);
  EXPECT_EQ(incoming.torn(), 2u);
  expect_latest(incoming, whole);
  EXPECT_EQ(incoming.arrive(next.fragment(1)), kIncomplete);
  EXPECT_EQ(incoming.torn(), std::nullopt) << "it is lost once";
  expect_latest(incoming, whole);
  EXPECT_EQ(incoming.arrive(next.fragment(2)), kCompleted);
  expect_latest(incoming, next);
}

TEST(IncomingList, AWholeListInOneFragmentTearsToo) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  MadeList torn(layout, 2, 9, 20), small(layout, 3, 2, 30);
  EXPECT_EQ(incoming.arrive(torn.fragment(0)), kIncomplete);
  EXPECT_EQ(incoming.arrive(small.fragment(0)), kCompleted);
  EXPECT_EQ(incoming.torn(), 2u);
  EXPECT_EQ(incoming.arrive(small.fragment(0)), kDuplicate);
  EXPECT_EQ(incoming.torn(), std::nullopt);
  expect_latest(incoming, small);
}

// The same sequence number with another count: still two different lists.
TEST(IncomingList, AnotherCountUnderOneNumberTears) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  MadeList longer(layout, 1, 9, 10), shorter(layout, 1, 6, 20);
  EXPECT_EQ(incoming.arrive(longer.fragment(0)), kIncomplete);
  EXPECT_EQ(incoming.arrive(shorter.fragment(1)), kTorn);
  EXPECT_EQ(incoming.arrive(shorter.fragment(0)), kCompleted);
  expect_latest(incoming, shorter);
  // Also where both take three fragments.
  MadeList nine(layout, 2, 9, 10), eight(layout, 2, 8, 20);
  EXPECT_EQ(incoming.arrive(nine.fragment(0)), kIncomplete);
  EXPECT_EQ(incoming.arrive(nine.fragment(1)), kIncomplete);
  EXPECT_EQ(incoming.arrive(eight.fragment(2)), kTorn);
  expect_latest(incoming, shorter);
}

TEST(IncomingList, ARepeatedOlderListDoesNotTearTheNewer) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  MadeList whole(layout, 1, 9, 10), next(layout, 2, 9, 20);
  for (int f = 0; f < 3; ++f) incoming.arrive(whole.fragment(f));
  EXPECT_EQ(incoming.arrive(next.fragment(0)), kIncomplete);
  EXPECT_EQ(incoming.arrive(whole.fragment(2)), kDuplicate);  // the second channel's copy, late
  EXPECT_EQ(incoming.arrived(), 1u);
  EXPECT_EQ(incoming.arrive(next.fragment(1)), kIncomplete);
  EXPECT_EQ(incoming.arrive(next.fragment(2)), kCompleted);
}

TEST(IncomingList, MalformedHeadersAreIgnored) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  MadeList list(layout, 1, 9, 10);
  EXPECT_EQ(incoming.arrive(list.fragment(0)), kIncomplete);
  std::vector<std::byte> bad(list.fragment(1).begin(), list.fragment(1).end());
  wire::write_header_raw(layout, bad, 2, 11);  // more elements than there may be
  EXPECT_EQ(incoming.arrive(bad), kMalformed);
  wire::write_header_raw(layout, bad, 2, 9);
  wire::write_header_raw(layout, bad, 0, 3);  // a fourth fragment of nine elements
  EXPECT_EQ(incoming.arrive(bad), kMalformed);
  wire::write_header_raw(layout, bad, 0, 15);
  EXPECT_EQ(incoming.arrive(bad), kMalformed);
  EXPECT_EQ(incoming.arrive(list.fragment(1)), kIncomplete);
  EXPECT_EQ(incoming.arrive(list.fragment(2)), kCompleted);
  expect_latest(incoming, list);
}

TEST(IncomingList, SequenceCountsOnWhereTheFieldWraps) {
  for (const int bits : {2, 4, 8}) {
    const auto layout = list_layout(bits);
    IncomingList incoming(layout);
    for (std::uint32_t sequence = 0; sequence < 600; ++sequence) {
      MadeList list(layout, sequence, 2, sequence);
      EXPECT_EQ(incoming.arrive(list.fragment(0)), kCompleted);
      expect_latest(incoming, list);
    }
  }
}

// Lists may be lost: a number up to half the circle ahead belongs to a newer list.
TEST(IncomingList, ListsMayBeLost) {
  const auto layout = list_layout(4);
  IncomingList incoming(layout);
  std::uint32_t sequence = 0;
  for (const std::uint32_t step : {5u, 8u, 1u, 7u, 3u, 8u, 6u}) {
    sequence += step;
    MadeList list(layout, sequence, 2, 0);
    incoming.arrive(list.fragment(0));
    EXPECT_EQ(incoming.latest()->sequence, sequence);
  }
}

TEST(IncomingList, L2_AnOlderListNeverReplacesANewerOne) {
  for (const int bits : {2, 4, 8}) {
    const auto layout = list_layout(bits);
    const std::uint32_t circle = 1u << bits;
    IncomingList counting(layout);
    for (std::uint32_t newest = 0; newest < 3 * circle; ++newest) {
      counting.arrive(MadeList(layout, newest, 1, newest).fragment(0));
      for (std::uint32_t back = 1; back < circle && newest >= circle; ++back) {
        IncomingList incoming = counting;
        MadeList latest(layout, newest, 1, newest), other(layout, newest - back, 1, 9999);
        const bool older = back < circle / 2;  // else it is as far ahead, on the circle
        ASSERT_EQ(incoming.arrive(other.fragment(0)), older ? kStale : kCompleted) << newest << " then -" << back;
        if (!older) continue;
        ASSERT_EQ(incoming.arrived(), newest - back);
        expect_latest(incoming, latest);
      }
    }
  }
}

TEST(IncomingList, L2_AStragglerDoesNotTearTheListBegunAfterIt) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  MadeList one(layout, 1, 9, 10), two(layout, 2, 9, 20), three(layout, 3, 9, 30);
  for (int f = 0; f < 3; ++f) incoming.arrive(one.fragment(f));
  EXPECT_EQ(incoming.arrive(two.fragment(0)), kIncomplete);
  EXPECT_EQ(incoming.arrive(three.fragment(0)), kTorn);
  EXPECT_EQ(incoming.arrive(two.fragment(1)), kStale);  // its list is lost already
  EXPECT_EQ(incoming.arrive(two.fragment(2)), kStale);
  expect_latest(incoming, one);
  EXPECT_EQ(incoming.arrive(three.fragment(1)), kIncomplete);
  EXPECT_EQ(incoming.arrive(three.fragment(2)), kCompleted);
  expect_latest(incoming, three);
}

// The sender has sent `before` lists and counts from zero again; each of its lists has two fragments.
int lists_until_believed(const schedules::model::PduLayout& layout, std::uint32_t before) {
  IncomingList incoming(layout);
  for (std::uint32_t sequence = 0; sequence < before; ++sequence) {
    MadeList list(layout, sequence, 4, sequence);
    for (int f = 0; f < 2; ++f) incoming.arrive(list.fragment(f));
  }
  for (std::uint32_t sequence = 0; sequence < 40; ++sequence) {
    MadeList list(layout, sequence, 4, 1000 + sequence);
    incoming.arrive(list.fragment(0));
    incoming.arrive(list.fragment(0));  // the other channel
    if (incoming.arrive(list.fragment(1)) != kCompleted) continue;
    const auto latest = incoming.latest()->bytes;
    EXPECT_TRUE(std::equal(latest.begin(), latest.end(), list.bytes.begin(), list.bytes.end()));
    return static_cast<int>(sequence) + 1;
  }
  return -1;
}

TEST(IncomingList, L3_ASenderThatCountsAnewIsBelievedAtItsThirdList) {
  const auto layout = list_layout(8);
  for (const std::uint32_t before : {4u, 20u, 100u, 127u}) EXPECT_EQ(lists_until_believed(layout, before), 3) << before;
  // Numbers that were the newest before are copies of those, until one is ahead.
  EXPECT_EQ(lists_until_believed(layout, 1), 2);
  EXPECT_EQ(lists_until_believed(layout, 2), 3);
  // Zero is ahead of the last, on the circle: as if lists had been lost.
  EXPECT_EQ(lists_until_believed(layout, 200), 1);
}

TEST(IncomingList, L3_StragglersAreNoRestart) {
  const auto layout = list_layout(8);
  const auto incoming_at = [&](std::uint32_t newest) {
    IncomingList incoming(layout);
    for (std::uint32_t sequence = 0; sequence <= newest; ++sequence)
      incoming.arrive(MadeList(layout, sequence, 1, sequence).fragment(0));
    return incoming;
  };
  const auto expect_stale = [&](IncomingList& incoming, std::initializer_list<std::uint32_t> sequences) {
    for (const std::uint32_t sequence : sequences)
      EXPECT_EQ(incoming.arrive(MadeList(layout, sequence, 1, 0).fragment(0)), kStale) << sequence;
  };
  IncomingList backwards = incoming_at(50), repeated = incoming_at(50), between = incoming_at(50);
  expect_stale(backwards, {40, 39, 38, 37, 36});         // each older than the one before
  expect_stale(repeated, {40, 40, 40, 41, 41, 40, 41});  // two lists only
  expect_stale(between, {40, 41});
  EXPECT_EQ(between.arrive(MadeList(layout, 50, 1, 50).fragment(0)), kDuplicate);  // the sender still is at 50
  expect_stale(between, {42, 43});
  EXPECT_EQ(between.arrive(MadeList(layout, 51, 1, 51).fragment(0)), kCompleted);
  expect_stale(between, {44, 45});
  EXPECT_EQ(between.latest()->sequence, 51u);
}

// The layout's `high` is code 1000; senders write no higher code. Only existing elements count.
TEST(IncomingList, L4_CodesAboveTheRangeAreRefused) {
  auto layout = list_layout();
  layout.element[0].high = 1000.0;
  IncomingList incoming(layout);
  MadeList list(layout, 1, 5, 990);                                 // 990..994
  wire::write_element_raw(layout, list.fragment(1), 2, 0, 0xFFFF);  // the sixth element is absent
  EXPECT_EQ(incoming.arrive(list.fragment(0)), kIncomplete);
  for (const int element : {0, 1}) {
    std::vector<std::byte> bad(list.fragment(1).begin(), list.fragment(1).end());
    wire::write_element_raw(layout, bad, element, 0, 1001);
    EXPECT_EQ(incoming.arrive(bad), kMalformed);
    wire::write_element_raw(layout, bad, element, 0, 0xFFFF);
    EXPECT_EQ(incoming.arrive(bad), kMalformed);
  }
  wire::write_element_raw(layout, list.fragment(1), 1, 0, 1000);
  EXPECT_EQ(incoming.arrive(list.fragment(1)), kCompleted);
  expect_latest(incoming, list);
}

TEST(IncomingList, L4_AFragmentInAnotherOnesSlotIsRefused) {
  const auto layout = list_layout();
  IncomingList incoming(layout);
  MadeList list(layout, 1, 9, 10);
  for (int slot = 0; slot < 3; ++slot)
    for (int f = 0; f < 3; ++f)
      if (f != slot) {
        EXPECT_EQ(incoming.arrive(list.fragment(f), slot), kMalformed);
      }
  for (int f = 0; f < 3; ++f) EXPECT_EQ(incoming.arrive(list.fragment(f), f), f == 2 ? kCompleted : kIncomplete);
  expect_latest(incoming, list);
}

// Fragments of a running sender, lost and repeated at random on two channels. Every list handed out was sent
// as such.
TEST(IncomingList, AListIsWholeOrAbsentUnderLossAndRepetition) {
  RandomStream stream({7, 0, Purpose::kTest, 1, 0});
  const auto layout = list_layout(8);
  IncomingList incoming(layout);
  std::deque<MadeList> sent;
  int completed = 0, already_known = 0;
  for (std::uint32_t sequence = 0; sequence < 3000; ++sequence) {
    sent.emplace_back(layout, sequence, static_cast<int>(stream.integer(0, 10)),
                      static_cast<std::uint32_t>(stream.integer(0, 50'000)));
    if (sent.size() > 3) sent.pop_front();
    for (int arrival = 0; arrival < 12; ++arrival) {
      // Mostly the newest list, now and then one before.
      MadeList& from = stream.integer(0, 9) == 0 ? sent.front() : sent.back();
      const auto fragment = static_cast<int>(stream.integer(0, from.fragments - 1));
      // Each slot brings the same, and a known fragment is neither stored nor counted again.
      const bool known = incoming.is_known(from.fragment(fragment), fragment);
      const IncomingList before = incoming;
      IncomingList in_slot = incoming;
      const ArrivalEffect effect = incoming.arrive(from.fragment(fragment));
      ASSERT_EQ(in_slot.arrive(from.fragment(fragment), fragment), effect);
      ASSERT_EQ(in_slot.arrived(), incoming.arrived());
      ASSERT_EQ(in_slot.torn(), incoming.torn());
      ASSERT_EQ(in_slot.latest().has_value(), incoming.latest().has_value());
      if (known) {
        ASSERT_EQ(effect, kDuplicate);
        ++already_known;
        incoming = before;
      }
      if (effect == kCompleted) ++completed;
      const auto latest = incoming.latest();
      if (!latest) continue;
      const auto match = std::find_if(sent.begin(), sent.end(),
                                      [&](const MadeList& list) { return list.sequence == latest->sequence; });
      if (match == sent.end()) continue;  // an older one is still the latest
      ASSERT_EQ(match->fragments, latest->fragments);
      ASSERT_TRUE(std::equal(latest->bytes.begin(), latest->bytes.end(), match->bytes.begin(), match->bytes.end()));
    }
  }
  EXPECT_GT(completed, 1000);
  EXPECT_GT(already_known, 1000);
}

TEST(OutgoingList, OffersTheFragmentsOfTheNewestWrite) {
  const auto layout = list_layout();
  OutgoingList outgoing(layout);
  EXPECT_TRUE(outgoing.empty());
  EXPECT_TRUE(outgoing.fragment(0).empty());
  MadeList longer(layout, 1, 10, 0), shorter(layout, 2, 4, 50);
  outgoing.write(longer.view());
  EXPECT_EQ(outgoing.fragments(), 4);
  EXPECT_EQ(outgoing.fragment(3).size(), static_cast<std::size_t>(layout.fragment_bytes));
  outgoing.write(shorter.view());
  EXPECT_EQ(outgoing.sequence(), 2u);
  for (int f = 0; f < 2; ++f) {
    const auto expected = shorter.fragment(f);
    const auto offered = outgoing.fragment(f);
    EXPECT_TRUE(std::equal(offered.begin(), offered.end(), expected.begin(), expected.end()));
  }
  EXPECT_TRUE(outgoing.fragment(2).empty());  // the rest of the longer list is gone
  EXPECT_TRUE(outgoing.fragment(-1).empty());
}

TEST(OutgoingListDeathTest, AListThatDoesNotFitIsOurBug) {
  const auto layout = list_layout();
  const auto larger = list_layout(4, 20);
  OutgoingList outgoing(layout);
  MadeList list(larger, 1, 20, 0);
  EXPECT_DEATH(outgoing.write(list.view()), "fragments");
}

}  // namespace
}  // namespace ttf::bus::cni
