// Lists dealt out to both channels: their notation in the file, and the refused cases.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "schedules/analysis/slot_groups.h"
#include "schedules/exchange/cluster_text.h"
#include "tests/schedules/check/mutation.h"

namespace ttf::schedules::analysis {
namespace {

TEST(DealtLists, GoOutOnBothChannelsWithinOneCycle) {
  const model::Cluster cluster = check::load_checked_cluster(shipped_path("thousand_synchronised"));
  const PduId image = *cluster.find_pdu("image");
  std::set<int> on_a, on_b;
  for (const model::FrameSlot& frame : cluster.frames)
    if (frame.pdu == image) (frame.channels == model::Channels::kA ? on_a : on_b).insert(frame.fragment);
  EXPECT_EQ(on_a.size(), 50u);
  EXPECT_EQ(on_b.size(), 50u);
  for (const int fragment : on_a) EXPECT_EQ(fragment % 2, 0);
  for (const int fragment : on_b) EXPECT_EQ(fragment % 2, 1);
  const std::vector<SlotGroup> groups = slot_groups(cluster, image);
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0].first, 5);
  EXPECT_EQ(groups[0].last, 54);
  EXPECT_EQ(groups[0].complete_by, Macroticks{54 * 276});
}

TEST(DealtLists, AreShownChannelByChannel) {
  const std::string text = exchange::show_text(file::load_cluster(shipped_path("thousand_synchronised")));
  EXPECT_NE(text.find("image 0-98, every other"), std::string::npos) << text;
  EXPECT_NE(text.find("image 1-99, every other"), std::string::npos) << text;
  EXPECT_NE(text.find("1000 in 100 slots, 10 to a slot; its header counts to 1023"), std::string::npos) << text;
}

TEST(DealtLists, AreCompleteAndInOrder) {
  const std::string image_on_a = "{slot: 5, channels: A, sender: fusion";  // where the entry begins
  const std::string image_on_b = "pdu: image, fragments: 50, first_fragment: 1, fragment_step: 2";
  check::expect_named(
      {
          {"third_channel",
           image_on_b,
           "pdu: image, fragments: 50, first_fragment: 1, fragment_step: 3",
           {"fragment_step: 3", "frames[9].fragment_step", "3", "1..2"}},
          {"one_half_twice",
           image_on_b,
           "pdu: image, fragments: 50, fragment_step: 2",
           {image_on_a, "frames[8] (slot 5)", "image", "fragment 1 has no slot"}},
          {"halves_exchanged",
           image_on_b,
           "pdu: image, fragments: 50, first_fragment: 50",
           {image_on_a, "frames[8] (slot 6)", "image, fragment 2", "must be above fragment 50 of slot 5"}},
          {"an_object_more",
           "(image:\\s+fragment_bytes: 248\\s+max_elements: )1000",
           "$011001",
           {image_on_a, "frames[8] (slot 5)", "image", "fragment 100 has no slot"}},
          {"more_than_the_header_counts",
           "(image:\\s+fragment_bytes: 248\\s+max_elements: )1000",
           "$011024",
           {"name: sequence", "pdus.image.header", "", "enough bits for 1024"}},
          {"slots_beyond_the_cycle",
           "(gNumberOfStaticSlots: )56",
           "$0153",
           {image_on_a, "frames[8] (slot 54)", "54", "must be 1..53"}},
      },
      "thousand_synchronised");
}

}  // namespace
}  // namespace ttf::schedules::analysis
