// docs/fault_campaign.md shows the table of the shipped campaign, which takes a quarter of an hour to make.
// The number of draws of each class shows quickly whether the faults are still the same.
#include <gtest/gtest.h>

#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "core/file_bytes.h"
#include "experiments/campaign/campaign.h"
#include "experiments/campaign/coverage.h"

namespace ttf::experiments::campaign {
namespace {

// Reads every line "class [A+B] [*] number ..." of the page: each class as often as the page has it (a table
// per variant).
std::map<std::string, std::vector<int>> on_the_page() {
  std::map<std::string, std::vector<int>> counts;
  std::istringstream page(read_file(TTF_SOURCE_DIR "/docs/fault_campaign.md"));
  for (std::string line; std::getline(page, line);) {
    std::istringstream words(line);
    std::string name, word;
    if (!(words >> name) || line.rfind("    ", 0) != 0) continue;
    while (words >> word && (word == "*" || word == "A+B")) name += " " + word;
    // The tables of times have fractions in that place.
    if (!word.empty() && word.find_first_not_of("0123456789") == std::string::npos)
      counts[name].push_back(std::stoi(word));
  }
  return counts;
}

TEST(CampaignPage, ShowsTheFaultsThatAreDrawn) {
  const std::string path = TTF_SOURCE_DIR "/experiments/fault_campaign.yaml";
  const CampaignFile campaign = parse_campaign(read_file(path), path);
  const CampaignClusters clusters(campaign);
  std::map<std::string, int> drawn;
  for (std::uint32_t index = 0; index < campaign.faults; ++index) {
    const DrawnFault fault = draw_fault(campaign, clusters.base, index);
    ++drawn[class_text(fault.fault.kind, in_hypothesis(fault.fault))];
  }
  const auto shown = on_the_page();
  for (const auto& [name, count] : drawn) {
    const auto row = shown.find(name);
    ASSERT_NE(row, shown.end()) << name;
    EXPECT_EQ(row->second, std::vector<int>(campaign.variants.size(), count)) << name << ": make the page's table anew";
  }
}

}  // namespace
}  // namespace ttf::experiments::campaign
