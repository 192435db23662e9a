#include "report/timing/windows/painted.h"

#include <algorithm>
#include <utility>

#include "core/check.h"
#include "report/drawing/log_limits.h"

namespace ttf::report::timing::windows {
namespace {

// Records come in the order of their begins, some a little later: a second is more than any of them waits.
constexpr Duration kSlack = Duration::milliseconds(1000);

}  // namespace

PaintedWindows::PaintedWindows(drawing::Names names, Duration cycle, TrueTime anchor, Duration length, Painted painted)
    : names_(std::move(names)), cycle_(cycle), anchor_(anchor), length_(length), painted_(std::move(painted)),
      next_(0) {
  TTF_CHECK(length.ns > 0, "windows of {} ns", length.ns);
  next_ = window_of({});
}

std::int64_t PaintedWindows::window_of(TrueTime t) const {
  const std::int64_t apart = (t - anchor_).ns;
  return apart / length_.ns - (apart % length_.ns < 0 ? 1 : 0);
}

template <class Record> void PaintedWindows::pass(const Record& record, TrueTime begin, TrueTime end) {
  if (full_ || !drawing::possible(begin) || !drawing::possible(end) || end < begin) return;
  const std::int64_t first = window_of(begin - TimingDiagram::kMargin) - 1,  // near its very end, too
      last = window_of(end + TimingDiagram::kMargin);
  // A damaged log may hold an endless task.
  for (std::int64_t window = std::max({next_, first, window_of(end - kSlack)}); window <= last; ++window) open(window);
  for (auto one = open_.lower_bound(first); one != open_.end() && one->first <= last; ++one) one->second.on(record);
  newest_ = std::max(newest_, begin);
  close_before(newest_ - kSlack);
}

void PaintedWindows::open(std::int64_t window) {
  const auto [one, opened] =
      open_.try_emplace(window, names_, cycle_, std::max(begin_of(window), TrueTime{}), begin_of(window + 1));
  if (!opened) return;
  for (const drawing::FaultEvent& fault : faults_) one->second.on(fault.record());
}

void PaintedWindows::close_before(TrueTime t) {
  while (!full_ && !open_.empty() && begin_of(open_.begin()->first + 1) + TimingDiagram::kMargin < t)
    paint(open_.begin()->first);
}

void PaintedWindows::paint(std::int64_t window) {
  const auto one = open_.find(window);
  if (one->second.shows_anything())
    full_ = !painted_(one->second.from(), one->second.to(), one->second.svg(TimingUse::kPage));
  open_.erase(one);
  next_ = window + 1;
}

void PaintedWindows::finish() {
  while (!full_ && !open_.empty()) paint(open_.begin()->first);
}

void PaintedWindows::on(const recording::records::Measured& r) { pass(r, r.stamp.true_time, r.stamp.true_time); }
void PaintedWindows::on(const recording::records::CanFrameSent& r) { pass(r, r.start.true_time, r.end.true_time); }
void PaintedWindows::on(const recording::records::SlotFrameSent& r) { pass(r, r.stamp.true_time, r.end.true_time); }
void PaintedWindows::on(const recording::records::ListHop& r) { pass(r, r.stamp.true_time, r.stamp.true_time); }
void PaintedWindows::on(const recording::records::TaskRun& r) { pass(r, r.activated.true_time, r.end.true_time); }
void PaintedWindows::on(const recording::records::ListFused& r) { pass(r, r.stamp.true_time, r.stamp.true_time); }
void PaintedWindows::on(const recording::records::FusionStep& r) { pass(r, r.stamp.true_time, r.stamp.true_time); }
void PaintedWindows::on(const recording::records::ImageWritten& r) { pass(r, r.stamp.true_time, r.stamp.true_time); }
void PaintedWindows::on(const recording::records::FeatureUsed& r) { pass(r, r.stamp.true_time, r.stamp.true_time); }
void PaintedWindows::on(const recording::records::ChannelFrame& r) { pass(r, r.start, r.end); }
void PaintedWindows::on(const recording::records::TimingProblem& r) { pass(r, r.stamp.true_time, r.stamp.true_time); }

void PaintedWindows::on(const recording::records::FaultActivity& r) {
  if (r.what == recording::records::FaultAct::kActs) return pass(r, r.at, r.at);
  for (auto& [window, diagram] : open_) diagram.on(r);
  faults_.push_back(r);
}

}  // namespace ttf::report::timing::windows
