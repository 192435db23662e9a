// The mode of a detector's next frame, by the cameras with regions.
#include "nodes/vision/mode_choice.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ttf::nodes::vision {
namespace {

// Modes by their letters, as ABaCb; a task of three cameras.
schedules::model::Task with_modes(const std::vector<std::string>& sequences) {
  schedules::model::Task task;
  for (const char* camera : {"camera_a", "camera_b", "camera_c"}) {
    task.reads.push_back({camera, PduId{0}, schedules::model::kFlexRay, 0});
    task.writes.push_back({std::string(camera) + "_objects", PduId{1}, schedules::model::kFlexRay, 0});
  }
  for (const std::string& letters : sequences) {
    schedules::model::TaskMode& mode = task.modes.emplace_back();
    mode.name = letters;
    for (const char letter : letters) {
      const bool secondary = letter >= 'a';
      mode.instants.push_back(
          {2 * mode.cycles++, {}, static_cast<std::size_t>(letter - (secondary ? 'a' : 'A')), secondary, 0});
    }
  }
  return task;
}

constexpr CameraSet kNone = 0, kA = 1, kB = 2, kC = 4;

TEST(ModeChoice, FitsSecondaryDetectionsToRegions) {
  const std::vector<std::string> modes{"AaBbCc", "ABC", "AaBaCa", "ABbC", "AaBbC"};
  const schedules::model::Task task = with_modes(modes);
  const ModeChoice choice(task, {});
  const auto chosen = [&](CameraSet regions) { return modes[choice.of(regions)]; };
  EXPECT_EQ(chosen(kNone), "ABC");
  EXPECT_EQ(chosen(kA), "AaBaCa");
  EXPECT_EQ(chosen(kB), "ABbC");
  EXPECT_EQ(chosen(kA | kB), "AaBbC");
  EXPECT_EQ(chosen(kA | kB | kC), "AaBbCc");
  EXPECT_EQ(chosen(kC), "ABC") << "no detection of a region that is not there";
  EXPECT_EQ(chosen(kA | kC), "AaBaCa") << "a region is left out rather than";
}

TEST(ModeChoice, TakesWhatFitsLeastBadly) {
  const std::vector<std::string> modes{"AaBbCc", "AaBbC"};
  const ModeChoice choice(with_modes(modes), {});
  EXPECT_EQ(modes[choice.of(kNone)], "AaBbC") << "two secondary detections in vain instead of three";
  const ModeChoice first(with_modes({"AaBC", "AaBCa"}), {});
  EXPECT_EQ(first.of(kA), 0u) << "the first of equal ones";
}

TEST(ModeChoice, RowsComeFirstWhereTheyNameTheCameras) {
  const std::vector<std::string> modes{"ABC", "AaBaCa", "AaBbC"};
  const ModeChoice choice(with_modes(modes), {{{}, "AaBaCa", 1}, {{"camera_b", "camera_a"}, "ABC", 2}, {{}, "ABC", 3}});
  EXPECT_EQ(modes[choice.of(kNone)], "AaBaCa") << "the first row counts";
  EXPECT_EQ(modes[choice.of(kA | kB)], "ABC");
  EXPECT_EQ(modes[choice.of(kA)], "AaBaCa") << "by the rule";
}

}  // namespace
}  // namespace ttf::nodes::vision
