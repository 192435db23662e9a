// The number of objects that the shipped clusters carry: the figures of docs/fusion/tracker.md, confirmed by the
// checker.
#include "schedules/analysis/object_ceiling.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "schedules/exchange/cluster_text.h"
#include "tests/schedules/cluster_file.h"

namespace ttf::schedules::analysis {
namespace {

ObjectCeiling ceiling_of(const std::string& name) {
  return object_ceiling(check::load_checked_cluster(shipped_path(name)));
}

TEST(ObjectCeiling, OfTheShippedClusters) {
  struct Expected {
    const char* name;
    int carried, with_all_static_slots;
  };
  for (const Expected& expected :
       {Expected{"paper_synchronised", 25, 32}, Expected{"paper_unsynchronised", 25, 32},
        Expected{"laser_radar", 3, 32}, Expected{"laser_radar_synchronised", 3, 32}, Expected{"flexray_demo", 4, 8},
        Expected{"thousand_unsynchronised", 1000, 1000}, Expected{"thousand_synchronised", 1000, 1000}}) {
    const ObjectCeiling ceiling = ceiling_of(expected.name);
    EXPECT_EQ(ceiling.carried, expected.carried) << expected.name;
    EXPECT_EQ(ceiling.with_all_static_slots, expected.with_all_static_slots) << expected.name;
    ASSERT_EQ(ceiling.lists.size(), 3u) << expected.name;
    // docs/fusion/tracker.md has the same numbers.
    std::ostringstream page;
    page << std::ifstream(TTF_SOURCE_DIR "/docs/fusion/tracker.md").rdbuf();
    const std::string row =
        fmt::format("| `{}` | {} | {} |", expected.name, expected.carried, expected.with_all_static_slots);
    EXPECT_NE(page.str().find(row), std::string::npos) << row;
  }
  const ObjectCeiling paper = ceiling_of("paper_synchronised");
  EXPECT_EQ(paper.free_for_lists, 35);
  EXPECT_EQ(paper.lists[0].slots, 9);
  EXPECT_EQ(paper.lists[0].objects, 25) << "27 would fit the slots, but not the list";
  EXPECT_EQ(paper.lists[2].countable, 255);
  const ObjectCeiling on_can = ceiling_of("paper_event_triggered");
  EXPECT_EQ(on_can.lists.size(), 1u) << "observations are not on FlexRay";
  EXPECT_EQ(on_can.carried, 25);
  EXPECT_EQ(on_can.with_all_static_slots, 70);
}

TEST(ObjectCeiling, IsShown) {
  const std::string text = exchange::show_text(file::load_cluster(shipped_path("paper_synchronised")));
  EXPECT_NE(text.find("image             25 in 13 slots, 2 to a slot; its header counts to 255"), std::string::npos)
      << text;
  EXPECT_NE(text.find("25 objects in every list; 32 if the lists shared all 35 static slots without status frames"),
            std::string::npos)
      << text;
}

std::string exchanged(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// The paper's cluster for `objects`. The lists follow each other from slot 6 on, the fusion lies between the
// sensors' and the image's.
std::string paper_for(int objects) {
  const int laser = (objects + 2) / 3, camera = (objects + 3) / 4, image = (objects + 1) / 2;
  const int second = 6 + laser, third = second + camera, end = third + image - 1;
  std::string text = shipped_text("paper_synchronised");
  const std::string most = fmt::format("max_elements: {}", objects);
  for (int list = 0; list < 3; ++list) text = exchanged(text, "max_elements: 25", most);
  text = exchanged(text, "laser_objects, fragments: 9", fmt::format("laser_objects, fragments: {}", laser));
  text = exchanged(text, "slot: 15", fmt::format("slot: {}", second));
  text = exchanged(text, "camera_objects, fragments: 7", fmt::format("camera_objects, fragments: {}", camera));
  text = exchanged(text, "slot: 22", fmt::format("slot: {}", third));
  text = exchanged(text, "image, fragments: 13", fmt::format("image, fragments: {}", image));
  text =
      exchanged(text, "repetition: 2, offset: 1800", fmt::format("repetition: 2, offset: {}", 84 * (third - 1) + 36));
  text = exchanged(text, "kind: time, base_cycle: 1, repetition: 8, offset: 900",
                   fmt::format("kind: time, base_cycle: 1, repetition: 8, offset: {}", 84 * (third - 1) - 864));
  return exchanged(text, "repetition: 8, offset: 2900", fmt::format("repetition: 8, offset: {}", 84 * end + 44));
}

TEST(ObjectCeiling, TheCheckerAcceptsAsManyAndNotOneMore) {
  const std::vector<Finding> most = findings_of(paper_for(32));
  EXPECT_TRUE(most.empty()) << sentences(most);
  EXPECT_EQ(object_ceiling(file::parse_cluster(paper_for(32), "cluster.yaml")).carried, 32);
  EXPECT_FALSE(findings_of(paper_for(33)).empty());
}

}  // namespace
}  // namespace ttf::schedules::analysis
