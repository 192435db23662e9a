// The pages of results. Each table comes from a command. The command's experiment is as the page says. A page lists all
// that its experiment expects.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/file_bytes.h"
#include "core/strict_yaml.h"
#include "experiments/campaign/campaign_bus.h"
#include "experiments/sweep/file.h"
#include "tests/support/patterns.h"

namespace ttf::experiments::sweep {
namespace {

namespace fs = std::filesystem;
const fs::path kTop = TTF_SOURCE_DIR;

// "experiment FILE --option value ...", as a page prints it.
struct Command {
  std::string file;
  std::uint32_t shards = 1;
  std::optional<std::uint32_t> replications;
};

struct Page {
  fs::path path;
  std::string text;
  std::vector<Command> commands;
  std::vector<std::string> expected;  // lines that begin with "expected: "
};

Page page_at(const fs::path& path) {
  static const support::Pattern kCommand("\n    build/release/ttfusion experiment (\\S+)([^\n]*)"),
      kShard("--shard [0-9]+/([0-9]+)"), kReplications("--replications ([0-9]+)"),
      kExpected("\n    expected: ([^\n]+)");
  Page page{path, read_file(path.string()), {}, {}};
  for (const support::Match& match : support::matches(page.text, kCommand)) {
    Command& command = page.commands.emplace_back();
    command.file = match[1];
    const std::string options = match[2];
    if (const auto shard = support::first_match(options, kShard))
      command.shards = static_cast<std::uint32_t>(std::stoul((*shard)[1]));
    if (const auto count = support::first_match(options, kReplications))
      command.replications = static_cast<std::uint32_t>(std::stoul((*count)[1]));
  }
  for (const support::Match& match : support::matches(page.text, kExpected)) page.expected.push_back(match[1]);
  return page;
}

std::vector<Page> pages() {
  std::vector<Page> found{page_at(kTop / "docs/results.md")};
  for (const auto& entry : fs::directory_iterator(kTop / "docs/results"))
    if (entry.path().extension() == ".md") found.push_back(page_at(entry.path()));
  return found;
}

bool is_campaign(const std::string& file) { return read_file(file).find("kind: fault_campaign") != std::string::npos; }

TEST(ResultsPages, NameExperimentsThatAreThere) {
  static const support::Pattern kNamed("experiments/[a-z0-9_/]+\\.yaml");
  std::set<std::string> named;
  for (const Page& page : pages()) {
    for (const support::Match& match : support::matches(page.text, kNamed)) {
      named.insert(match[0]);
      EXPECT_TRUE(fs::exists(kTop / match[0])) << page.path << ": " << match[0];
    }
    for (const Command& command : page.commands) EXPECT_TRUE(named.contains(command.file)) << page.path;
  }
  for (const auto& entry : fs::directory_iterator(kTop / "experiments")) {
    if (entry.path().extension() != ".yaml") continue;
    EXPECT_TRUE(named.contains("experiments/" + entry.path().filename().string()))
        << entry.path() << " has no page of results";
  }
}

// A table comes from a command of its page, or of a page that it links to.
TEST(ResultsPages, HaveTheCommandsOfTheirTables) {
  static const support::Pattern kLink("\\]\\(([a-z_/.]+\\.md)");
  std::set<fs::path> with_command;
  for (const Page& page : pages())
    if (!page.commands.empty()) with_command.insert(fs::canonical(page.path));
  EXPECT_GE(with_command.size(), 10u);
  for (const Page& page : pages()) {
    if (page.text.find("\n|---") == std::string::npos) continue;
    if (page.text.find("\n    build/release/ttfusion ") != std::string::npos) continue;
    const auto links = support::matches(page.text, kLink);
    EXPECT_TRUE(std::any_of(links.begin(), links.end(), [&](const support::Match& link) {
      return with_command.contains(fs::weakly_canonical(page.path.parent_path() / link[1]));
    })) << page.path;
  }
}

TEST(ResultsPages, DroveAsManyWithTheSeedOfTheFile) {
  static const support::Pattern kReplications("([0-9][0-9,]*)\\s+replications"), kSeed("seed\\s+([0-9]+)");
  for (const Page& page : pages()) {
    if (page.commands.size() != 1 || is_campaign((kTop / page.commands[0].file).string())) continue;
    const SweepFile sweep = load_sweep((kTop / page.commands[0].file).string());
    const std::string behind = page.text.substr(page.text.find("build/release/ttfusion"));
    const auto count = support::first_match(page.text, kReplications), seed = support::first_match(behind, kSeed);
    ASSERT_TRUE(count && seed) << page.path;
    std::string number = (*count)[1];
    std::erase(number, ',');
    EXPECT_EQ(std::stoul(number), page.commands[0].replications.value_or(sweep.replications) / page.commands[0].shards)
        << page.path;
    EXPECT_EQ(std::stoul((*seed)[1]), sweep.seed) << page.path;
  }
}

TEST(ResultsPages, SayAllThatTheirExperimentsExpect) {
  std::size_t said = 0;
  for (const Page& page : pages()) {
    std::vector<std::string> expected;
    for (const Command& command : page.commands) {
      const std::string file = (kTop / command.file).string();
      if (is_campaign(file)) {
        const auto expectation = campaign::bus_of(campaign::load_campaign(file))->expectation();
        ASSERT_TRUE(expectation.has_value() && page.expected.size() == 1) << page.path;
        EXPECT_TRUE(page.expected[0].starts_with(expectation->sentence)) << page.expected[0];
        expected = page.expected;
        continue;
      }
      for (const Expectation& expectation : load_sweep(file).expectations) expected.push_back(expectation.text);
    }
    EXPECT_EQ(page.expected, expected) << page.path;
    said += expected.size();
  }
  EXPECT_GE(said, 20u);
}

}  // namespace
}  // namespace ttf::experiments::sweep
