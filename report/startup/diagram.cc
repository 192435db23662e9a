#include "report/startup/diagram.h"

#include <algorithm>
#include <utility>

#include "recording/exports/logged_frame.h"
#include "report/drawing/axes.h"
#include "report/drawing/log_limits.h"
#include "report/startup/painter.h"

namespace ttf::report::startup {

using recording::records::PocKind;

StartupDiagram::StartupDiagram(drawing::Names names, Duration cycle, TrueTime from, TrueTime to)
    : names_(std::move(names)), cycle_(cycle <= drawing::kLongestCycle ? cycle : Duration{}), from_(from), to_(to) {}

void StartupDiagram::on(const recording::records::StateChanged& r) {
  if (drawing::possible(r.stamp.true_time))
    data_.changes.push_back({r.stamp.true_time, r.stamp.node, r.from, r.to, std::string(r.from_name),
                             std::string(r.to_name), std::string(r.why), std::string(r.consequence)});
}
void StartupDiagram::on(const recording::records::PowerChanged& r) {
  if (drawing::possible(r.stamp.true_time)) data_.power.push_back(r);
}
void StartupDiagram::on(const recording::records::SymbolSent& r) {
  const TrueTime start = r.stamp.true_time, end = r.end.true_time;
  if (drawing::possible(start) && drawing::possible(end) && start <= to_) data_.symbols.push_back(r);
}
void StartupDiagram::on(const recording::records::SlotFrameSent& r) {
  const TrueTime start = r.stamp.true_time, end = r.end.true_time;
  if (drawing::possible(start) && drawing::possible(end) && start <= to_ && drawing::possible_cycle(r.cycle))
    data_.frames.push_back(
        {start, end, r.stamp.node, r.cycle, r.slot, r.channel, r.null_frame, recording::exports::is_startup_frame(r)});
}
void StartupDiagram::on(const recording::records::FaultActivity& r) {
  if (drawing::possible(r.at)) data_.faults.push_back(r);
}

std::string StartupDiagram::svg(const drawing::Sheet& sheet) const {
  if (data_.changes.empty() && data_.power.empty())
    return drawing::empty_picture("Start-up", "No node changed its state: all nodes were integrated from begin to end.",
                                  sheet);
  if (from_ >= to_) return drawing::empty_picture("Start-up", "The window is empty.", sheet);
  return paint_startup(names_, data_, cycle_, from_, to_, sheet);
}

void StartupExtent::see(TrueTime at, bool starts) {
  if (!drawing::possible(at)) return;
  if (starts) first_start_ = first_start_ ? std::min(*first_start_, at) : at;
  first_ = first_ ? std::min(*first_, at) : at;
  last_ = last_ ? std::max(*last_, at) : at;
}
void StartupExtent::on(const recording::records::StateChanged& r) {
  see(r.stamp.true_time, r.from == PocKind::kDefaultConfig);
  const std::size_t node = index_of(r.stamp.node);
  if (r.to != PocKind::kNormalActive || active_[node] || !drawing::possible(r.stamp.true_time)) return;
  active_[node] = true;
  last_active_ = last_active_ ? std::max(*last_active_, r.stamp.true_time) : r.stamp.true_time;
}
void StartupExtent::on(const recording::records::PowerChanged& r) { see(r.stamp.true_time, r.on); }

std::optional<std::pair<TrueTime, TrueTime>> StartupExtent::window(Duration cycle) const {
  if (!first_) return std::nullopt;
  const Duration a_little = Duration::milliseconds(1);
  const Duration after = std::clamp(cycle, Duration{}, drawing::kLongestCycle) * 2;
  const TrueTime first = first_start_.value_or(*first_);
  const TrueTime last = std::max(first, last_active_.value_or(*last_));
  return std::pair(std::max(TrueTime{}, first - a_little), last + a_little + after);
}

}  // namespace ttf::report::startup
