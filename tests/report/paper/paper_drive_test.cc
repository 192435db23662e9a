// A drive's scripts for papers: sensors look as in the other pictures.
#include "report/paper/drive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

namespace ttf::report::paper {
namespace {

using drawing::Marker;
using testing::ContainsRegex;

TEST(PaperDrive, SensorsHaveTheirColoursAndMarkers) {
  PaperDrive drive;
  drive.label = "tt";
  drive.sensors = {{"left", "#d55e00", Marker::kCross}, {"image", "#009e73", Marker::kDownTriangle}};
  drive.kinds = {"truth", "reference", "left", "sensor image", "image"};
  drive.ages = {{"fused", "image"}, {"used", "left"}};
  std::map<std::string, std::string> files;
  for (const PaperFile& file : scripts_of_drives({drive})) files[file.name] = file.text;
  const std::string& positions = files.at("tt_positions.gp");
  EXPECT_THAT(positions, ContainsRegex("\"left\".* with points pointtype 2 [^\n]*#d55e00"));
  EXPECT_THAT(positions, ContainsRegex("\"sensor image\".* with points pointtype 10 [^\n]*#009e73"));
  EXPECT_THAT(positions, ContainsRegex("\"image\".* with points pointtype 4 [^\n]*#000000"));
  EXPECT_THAT(files.at("ages.gp"), ContainsRegex("\"image\"[^\n]*linecolor rgb \"#009e73\""));
  EXPECT_THAT(files.at("ages.gp"), ContainsRegex("\"left\"[^\n]*linecolor rgb \"#d55e00\""));
}

}  // namespace
}  // namespace ttf::report::paper
