// Every FlexRay parameter has an effect on a drive, or stands in the list of those without one.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "schedules/file/parameter_table.h"
#include "tests/support/patterns.h"

namespace ttf::schedules::file {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

std::set<std::string> all_parameters() {
  std::set<std::string> names{"pChannels", "pWakeupChannel"};
  const auto add = [&](const auto& table) {
    for (const auto& parameter : table) names.insert(std::string(parameter.name));
  };
  add(kGlobalIntegers);
  add(kGlobalScaled);
  add(kNodeIntegers);
  add(kNodeScaled);
  add(kNodeFlags);
  return names;
}

// The code by which a drive runs, without its comments.
std::string running_code() {
  std::string code;
  for (const char* room : {"timebase", "bus", "nodes", "sim", "schedules/model"})
    for (const auto& entry : std::filesystem::recursive_directory_iterator(std::string(TTF_SOURCE_DIR "/") + room))
      if (entry.path().extension() == ".h" || entry.path().extension() == ".cc") code += text_of(entry.path());
  std::istringstream lines(code);
  std::string without_comments;
  for (std::string line; std::getline(lines, line);) without_comments += line.substr(0, line.find("//")) + "\n";
  return without_comments;
}

// Returns the members that the code reads: behind a dot or an arrow, and not assigned to.
std::set<std::string> members_read(const std::string& code) {
  static const support::Pattern member("(?:\\.|->)([gp][A-Za-z]+|baudrate)(?:_ps)?\\b(?!\\s*=[^=])");
  std::set<std::string> names;
  for (const support::Match& read : support::matches(code, member)) names.insert(read[1]);
  return names;
}

// Returns the first column of the table in docs/develop/flexray_model.md.
std::set<std::string> listed() {
  const std::string page = text_of(TTF_SOURCE_DIR "/docs/develop/flexray_model.md");
  const std::size_t begin = page.find("## Parameters without an effect");
  const std::string section = begin == std::string::npos ? "" : page.substr(begin, page.find("\n## ", begin) - begin);
  static const support::Pattern name("`([A-Za-z]+)`");
  std::set<std::string> names;
  std::istringstream lines(section);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with("| `")) continue;
    const std::string column = line.substr(0, line.find('|', 1));
    for (const support::Match& listed : support::matches(column, name)) names.insert(listed[1]);
  }
  return names;
}

TEST(ParameterEffects, EveryParameterHasOneOrIsListed) {
  const std::set<std::string> read = members_read(running_code()), without = listed();
  EXPECT_GT(read.size(), 30u);
  for (const std::string& name : all_parameters())
    EXPECT_NE(read.contains(name), without.contains(name))
        << name << (read.contains(name) ? " is read, and listed as without effect" : " is neither read nor listed");
  for (const std::string& name : without) EXPECT_TRUE(all_parameters().contains(name)) << name << " is no parameter";
}

}  // namespace
}  // namespace ttf::schedules::file
