// Pages show the tables of the shipped campaigns. To make them takes long. The number of draws of each class shows
// quickly whether the faults are still the same.
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

// Reads every line "class [A+B] [*] number ..." of the page's tables with the injected faults: each class as often as the page
// has it (a table per variant).
void add_page(const std::string& name, std::map<std::string, std::vector<int>>& counts) {
  std::istringstream page(read_file(TTF_SOURCE_DIR "/docs/" + name));
  bool injected = false;
  for (std::string line; std::getline(page, line);) {
    std::istringstream words(line);
    std::string row, word;
    if (!(words >> row) || line.rfind("    ", 0) != 0) {
      injected = false;
      continue;
    }
    while (words >> word && (word == "*" || word == "A+B")) row += " " + word;
    if (row == "class") injected = word == "injected";
    if (injected && !word.empty() && word.find_first_not_of("0123456789") == std::string::npos)
      counts[row].push_back(std::stoi(word));
  }
}

void shows_what_is_drawn(const std::string& file, const std::vector<std::string>& pages) {
  const std::string path = TTF_SOURCE_DIR "/experiments/" + file;
  const CampaignFile campaign = parse_campaign(read_file(path), path);
  const auto bus = bus_of(campaign);
  std::map<std::string, int> drawn;
  for (std::uint32_t index = 0; index < campaign.faults; ++index) {
    const DrawnFault fault = bus->draw(index);
    ++drawn[class_text(fault.fault.kind, bus->in_hypothesis(fault.fault))];
  }
  std::map<std::string, std::vector<int>> shown;
  for (const std::string& page : pages) add_page(page, shown);
  for (const auto& [name, count] : drawn) {
    const auto row = shown.find(name);
    ASSERT_NE(row, shown.end()) << name;
    EXPECT_EQ(row->second, std::vector<int>(campaign.variants.size(), count)) << name << ": make the page's table anew";
  }
}

TEST(CampaignPage, ShowsTheFaultsThatAreDrawn) {
  shows_what_is_drawn("fault_campaign.yaml", {"reference/fault_campaign.md", "results/fault_campaign.md"});
}

TEST(CampaignPage, ShowsTheFaultsThatAreDrawnOnACan) {
  shows_what_is_drawn("can_fault_campaign.yaml", {"results/can_faults.md"});
}

}  // namespace
}  // namespace ttf::experiments::campaign
