// The price of a smaller age in a plan, as a picture. Dots are lengths of the cycle with their least worst ages. Steps are the
// static slots that an age needs. With a judge, dots have its value beside the age. Below is what binds the schedule that was
// found: bars of work and of rest along each chain.
#pragma once

#include <string>
#include <vector>

#include "report/drawing/sheet.h"
#include "schedules/synthesis/trade/binding.h"
#include "schedules/synthesis/trade/trade_off.h"

namespace ttf::report::plots {

struct TradeOffView {
  std::string title;
  schedules::synthesis::trade::TradeOff trade_off;
  std::vector<schedules::synthesis::trade::BindingWay> ways;
  std::string judged;  // the name of the judge's value, with its unit
};

std::string trade_off_svg(const TradeOffView& view, const drawing::Sheet& sheet = {});

}  // namespace ttf::report::plots
