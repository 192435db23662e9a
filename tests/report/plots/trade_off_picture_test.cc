// Every candidate is a dot, every step of the front a square, every piece of a way a box.
#include "report/plots/trade_off_picture.h"

#include <gtest/gtest.h>

#include <string>

namespace ttf::report::plots {
namespace {

namespace trade = schedules::synthesis::trade;

std::size_t occurrences(const std::string& text, const std::string& word) {
  std::size_t found = 0;
  for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
  return found;
}

trade::TradeOffPoint point(int cycle_ms, int age_ms, int slots) {
  trade::TradeOffPoint made;
  made.candidate.cycle = Duration::milliseconds(cycle_ms);
  made.worst_age = made.bound = Duration::milliseconds(age_ms);
  made.slots = slots;
  return made;
}

TradeOffView view() {
  TradeOffView view;
  view.title = "A plan";
  view.trade_off.candidates = {point(8, 55, 80), point(9, 57, 76), point(10, 60, 60)};
  view.trade_off.front = {point(8, 55, 78), point(9, 57, 70)};
  using Kind = trade::WayPiece::Kind;
  view.ways = {{"laser",
                {{Kind::kWorks, "scan", Duration::milliseconds(16), {}},
                 {Kind::kRests, "lists begin with a slot", Duration::milliseconds(1), {}},
                 {Kind::kClocks, "clocks differ", Duration{}, {}}},
                Duration::milliseconds(17)}};
  return view;
}

TEST(TradeOffPicture, ShowsAllThatItIsGiven) {
  const std::string two = trade_off_svg(view());
  EXPECT_EQ(occurrences(two, "class=\"candidate\""), 3U);
  EXPECT_EQ(occurrences(two, "class=\"step\""), 2U);
  EXPECT_EQ(occurrences(two, "class=\"front\""), 1U);
  EXPECT_EQ(occurrences(two, "class=\"piece\""), 3U);
  EXPECT_NE(two.find("rests: lists begin with a slot 1.000"), std::string::npos);
  EXPECT_NE(two.find("laser: 17.000 ms at most"), std::string::npos);
}

TEST(TradeOffPicture, HasAThirdPanelWithAJudge) {
  TradeOffView judged = view();
  judged.judged = "expected squared error [m²]";
  judged.trade_off.candidates[0].judged = 0.5;
  judged.trade_off.candidates[1].judged = 0.4;
  const std::string three = trade_off_svg(judged);
  EXPECT_EQ(occurrences(three, "class=\"candidate\""), 5U);
  EXPECT_NE(three.find("expected squared error [m²]"), std::string::npos);
}

TEST(TradeOffPicture, SaysWhyItIsEmpty) {
  TradeOffView empty = view();
  empty.trade_off.candidates.clear();
  EXPECT_NE(trade_off_svg(empty).find("no candidate has a schedule"), std::string::npos);
}

}  // namespace
}  // namespace ttf::report::plots
