#include "report/plots/schedule_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "core/decimal.h"
#include "report/drawing/axes.h"
#include "report/drawing/names.h"
#include "schedules/analysis/dynamic_load.h"
#include "schedules/analysis/minislots.h"

namespace ttf::report::plots {
namespace {

using schedules::model::Channel;
using schedules::model::Cluster;
using schedules::model::FrameSlot;

constexpr double kPlotWidth = 1300, kSlotLane = 110, kTaskLane = 26;
constexpr std::string_view kSymbolWindowFill = "#f5eeda";

class SchedulePainter {
 public:
  SchedulePainter(const Cluster& cluster, const drawing::Sheet& sheet)
      : c_(cluster), sheet_(sheet), names_(drawing::names_of(cluster)) {
    for (const FrameSlot& f : c_.frames) {
      repetition_ = std::max(repetition_, f.repetition);
      frames_[f.slot].push_back(&f);
    }
    for (const auto& [slot, frames] : frames_) used_.push_back(slot);
    if (sheet.on_paper()) left_ = drawing::text_width("channel A", sheet.text(11.5)) + 24;
  }

  std::string picture() {
    const std::vector<drawing::LegendEntry> legend = make_legend();
    const std::vector<TaskLane> lanes = task_lanes();
    const double widest = sheet_.on_paper() ? std::max(left_, 0.35 * sheet_.width(0)) : 320.0;
    for (const TaskLane& lane : lanes)
      left_ = std::clamp(drawing::text_width(lane.label, sheet_.text(10)) + 24, left_, widest);
    plot_ = sheet_.plot_width(kPlotWidth, left_ + 30);
    const double matrix_cell = std::clamp(plot_ / std::max<double>(1.0, static_cast<double>(used_.size())),
                                          sheet_.on_paper() ? 0.0 : 16.0, 90.0);
    const double width = left_ + std::max(plot_, matrix_cell * static_cast<double>(used_.size())) + 30;
    // On paper, words begin at its left edge.
    words_left_ = sheet_.on_paper() ? 10 : left_;
    words_width_ = sheet_.on_paper() ? width - 20 : plot_;
    const std::vector<std::string> title = drawing::broken(title_text(), sheet_.text(14), line(), true);
    const double legend_y = 26 + drawing::kLineHeight * static_cast<double>(title.size());
    const double strip = legend_y + legend_height(legend, words_width_) + 34;
    const double tasks = strip + 2 * (kSlotLane + 6) + 14;
    const double axis = tasks + static_cast<double>(lanes.size()) * kTaskLane;
    const double notes = axis + 58;
    const std::vector<std::string> notes_text = other_tasks();
    const std::vector<std::string> matrix_title = drawing::broken(matrix_text(), sheet_.text(11.5), line(), true);
    std::vector<std::string> matrix_notes;
    if (any_number_fits(matrix_cell))
      matrix_notes = drawing::broken("Numbers in the cells: fragment of the PDU / most fragments it can have.",
                                     sheet_.text(10), line());
    const double matrix = notes + 14 * static_cast<double>(notes_text.size()) + 34 +
                          drawing::kLineHeight * static_cast<double>(matrix_title.size());
    const double row = 24;
    const double height = matrix + row * static_cast<double>(rows()) + 26 +
                          drawing::kLineHeight * static_cast<double>(matrix_notes.size());
    drawing::Svg svg(width, height, "Schedule of " + c_.name, sheet_);
    svg_ = &svg;
    svg.lines({sheet_.on_paper() ? words_left_ : 20.0, 24}, title, {.size = 14, .bold = true});
    draw_legend(svg, {words_left_, legend_y}, words_width_, legend);
    draw_axis(strip - 6, axis);
    for (const Channel channel : schedules::model::kBothChannels)
      draw_channel(channel, strip + (channel == Channel::kA ? 0 : kSlotLane + 6));
    draw_tasks(lanes, tasks);
    svg.lines({words_left_, notes}, notes_text, {.size = 10, .fill = "#333333"});
    if (!used_.empty()) {
      svg.lines({words_left_, matrix - 12 - drawing::kLineHeight * static_cast<double>(matrix_title.size())},
                matrix_title, {.size = 11.5, .bold = true});
      draw_matrix(matrix, matrix_cell, row);
      svg.lines({words_left_, matrix + row * rows() + 18}, matrix_notes, {.size = 10, .fill = "#444444"});
    }
    return svg.str();
  }

 private:
  struct TaskBox {
    double offset_mt, length_mt;
    std::string text;
  };
  struct TaskLane {
    std::string label;
    std::vector<TaskBox> boxes;
  };

  double line() const { return sheet_.line(words_width_); }

  std::string title_text() const {
    const auto& g = c_.flexray;
    return fmt::format("Schedule of {}: cycle {} ms, {} static slots of {} MT, {} minislots{}, NIT {} MT", c_.name,
                       scaled_text(g.cycle_ps(), 1'000'000'000), g.gNumberOfStaticSlots, g.gdStaticSlot,
                       g.gNumberOfMinislots,
                       g.gdSymbolWindow > 0 ? fmt::format(", symbol window {} MT", g.gdSymbolWindow) : "", g.gdNIT);
  }
  std::string matrix_text() const {
    return fmt::format(
        "Owned slots over cycles, the pattern repeats every {} (upper half of a cell: channel A, lower half: B)",
        rows() == 1 ? "cycle" : fmt::format("{} cycles", rows()));
  }

  double macroticks(Duration d) const {
    return static_cast<double>(d.ns) * 1000.0 / static_cast<double>(c_.flexray.gdMacrotick_ps);
  }
  double x(double macrotick) const { return left_ + macrotick / c_.flexray.gMacroPerCycle * plot_; }
  // Rows of the matrix: the cycles until the pattern repeats, at most the counter's 64.
  int rows() const { return std::min(repetition_, c_.flexray.gCycleCountMax + 1); }

  // A pale colour, for text in the boxes.
  std::string colour(PduId pdu) const { return drawing::tint(pdu_colour(names_, pdu), pdu == kNoPdu ? 0.55 : 0.35); }

  std::vector<drawing::LegendEntry> make_legend() const {
    std::map<std::pair<PduId, NodeId>, int> frames_of;
    for (const FrameSlot& f : c_.frames) ++frames_of[{f.pdu, f.sender}];
    std::vector<drawing::LegendEntry> legend;
    bool status = false;
    for (const auto& [key, n] : frames_of) {
      if (key.first == kNoPdu)
        status = true;
      else
        legend.push_back({drawing::LegendEntry::Kind::kBox,
                          names_.pdu(key.first) + ", sent by " + names_.node(key.second),
                          colour(key.first),
                          {},
                          true});
    }
    if (status) legend.push_back({drawing::LegendEntry::Kind::kBox, "status frame", colour(kNoPdu), {}, true});
    legend.push_back({drawing::LegendEntry::Kind::kBox, "slot without owner", "#bbbbbb", {}, false});
    // The symbol window is mostly too narrow for its name.
    if (c_.flexray.gdSymbolWindow > 0)
      legend.push_back({drawing::LegendEntry::Kind::kBox, "symbol window", std::string(kSymbolWindowFill), {}, true});
    return legend;
  }

  std::string frame_text(const FrameSlot& f) const {
    return f.pdu == kNoPdu ? names_.node(f.sender) + ": status"
                           : fmt::format("{}: {} {}/{}", names_.node(f.sender), names_.pdu(f.pdu), f.fragment + 1,
                                         c_.pdu(f.pdu).max_fragments());
  }

  // Returns the longest beginning of the text that fits.
  static std::string fitted(const std::string& text, double size, double room) {
    if (drawing::text_width(text, size) <= room) return text;
    std::string cut = text;
    while (!cut.empty() && drawing::text_width(cut + "…", size) > room) cut.pop_back();
    return cut.empty() ? "" : cut + "…";
  }

  void draw_channel(Channel channel, double top) {
    const auto& g = c_.flexray;
    svg_->text({left_ - 12, top + kSlotLane / 2 + 4}, channel == Channel::kA ? "channel A" : "channel B",
               {.size = 11.5, .anchor = drawing::Anchor::kEnd});
    for (int slot = 1; slot <= g.gNumberOfStaticSlots; ++slot) {
      const double left = x((slot - 1.0) * g.gdStaticSlot),
                   width = x(static_cast<double>(slot) * g.gdStaticSlot) - left;
      std::vector<const FrameSlot*> here;
      if (const auto it = frames_.find(slot); it != frames_.end())
        for (const FrameSlot* f : it->second)
          if (includes(f->channels, channel)) here.push_back(f);
      std::string hover = fmt::format("slot {}", slot);
      for (const FrameSlot* f : here)
        hover += fmt::format("; {} in cycles {} mod {}", frame_text(*f), f->base_cycle, f->repetition);
      if (here.empty()) {
        svg_->rect({left, top, width, kSlotLane}, {.fill = "#ffffff", .stroke = "#bbbbbb", .width = 0.5}, hover,
                   "slot free");
      } else {
        // Multiplexed frames share the slot's height.
        const double part = kSlotLane / static_cast<double>(here.size());
        for (std::size_t i = 0; i < here.size(); ++i)
          svg_->rect({left, top + part * static_cast<double>(i), width, part},
                     {.fill = colour(here[i]->pdu), .stroke = "#444444", .width = 0.5}, hover, "slot");
      }
      if (width >= sheet_.text(7) * std::max<double>(1.0, drawing::text_width(fmt::format("{}", slot), 1.0)) + 1)
        svg_->text({left + width / 2, top + kSlotLane - 4}, fmt::format("{}", slot),
                   {.size = 7, .anchor = drawing::Anchor::kMiddle});
      const double size = sheet_.text(8.5);
      if (width >= size + 1.5 && !here.empty()) {
        // Shows the owner above the PDU if two lines fit, otherwise the PDU; the hover text has everything.
        const FrameSlot& f = *here.front();
        std::string text =
            f.pdu == kNoPdu ? "status"
                            : fmt::format("{} {}/{}", names_.pdu(f.pdu), f.fragment + 1, c_.pdu(f.pdu).max_fragments());
        if (here.size() > 1) text += fmt::format(" +{}", here.size() - 1);
        const bool two = width >= 2 * size + 4;
        const double centre = left + width / 2 + 3, foot = top + kSlotLane - 14;
        if (two)
          svg_->text({centre - 6, foot}, fitted(names_.node(f.sender), size, kSlotLane - 18),
                     {.size = 8.5, .rotate = -90});
        svg_->text({two ? centre + 3.5 : centre, foot}, fitted(text, size, kSlotLane - 18),
                   {.size = 8.5, .rotate = -90});
      }
    }
    double at = g.gNumberOfStaticSlots * static_cast<double>(g.gdStaticSlot);
    // The name stands in the middle of the segment's free part.
    const auto segment = [&](double length, const char* name, std::string_view fill, double taken = 0) {
      if (length <= 0) return;
      const double left = x(at), width = x(at + length) - left;
      svg_->rect({left, top, width, kSlotLane}, {.fill = fill, .stroke = "#666666", .width = 0.5},
                 fmt::format("{}: {} MT", name, drawing::number(length)), "segment");
      const double free = x(at + taken), room = left + width - free;
      if (room > drawing::text_width(name, sheet_.text(10)) + 6)
        svg_->text({free + room / 2, top + kSlotLane / 2 + 4}, name, {.size = 10, .anchor = drawing::Anchor::kMiddle});
      else if (room > sheet_.text(9) + 2)
        svg_->text({free + room / 2 + 4, top + kSlotLane / 2}, name,
                   {.size = 9, .anchor = drawing::Anchor::kMiddle, .rotate = -90});
      at += length;
    };
    segment(static_cast<double>(g.gNumberOfMinislots) * g.gdMinislot, "dynamic segment", "#e6f0f7",
            static_cast<double>(taken_minislots(channel)) * g.gdMinislot);
    draw_dynamic(channel, top);
    segment(g.gdSymbolWindow, "symbol window", kSymbolWindowFill);
    segment(g.gMacroPerCycle - at, "network idle time", "#eeeeee");
  }

  std::int64_t taken_minislots(Channel channel) const {
    for (const schedules::analysis::DynamicLoad& load : schedules::analysis::dynamic_load(c_))
      if (load.channel == channel) return std::min<std::int64_t>(load.minislots, c_.flexray.gNumberOfMinislots);
    return 0;
  }

  // Draws one row per dynamic frame: from its slot's earliest turn to its latest end.
  void draw_dynamic(Channel channel, double top) {
    const auto& g = c_.flexray;
    std::vector<const FrameSlot*> here;
    for (const FrameSlot& f : c_.frames)
      if (is_dynamic(g, f) && includes(f.channels, channel)) here.push_back(&f);
    const double part = kSlotLane / std::max<double>(1.0, static_cast<double>(here.size()));
    for (std::size_t i = 0; i < here.size(); ++i) {
      const FrameSlot& f = *here[i];
      const std::int64_t over = schedules::analysis::latest_turn(c_, f) +
                                schedules::analysis::minislots_of(g, schedules::analysis::dynamic_words(c_, f));
      const double left = x(
          static_cast<double>(schedules::analysis::minislot_start(g, schedules::analysis::earliest_turn(g, f)).value));
      const double right = x(static_cast<double>(
          schedules::analysis::minislot_start(g, std::min<std::int64_t>(over, g.gNumberOfMinislots + 1)).value));
      svg_->rect({left, top + part * static_cast<double>(i), right - left, part},
                 {.fill = colour(f.pdu), .stroke = "#444444", .width = 0.5},
                 fmt::format("slot {}; {} in cycles {} mod {}, when there is a list", f.slot, frame_text(f),
                             f.base_cycle, f.repetition),
                 "slot");
      const std::string text = fmt::format("{}: {}", f.slot, frame_text(f));
      if (part >= sheet_.text(8.5) + 0.5)
        svg_->text({left + 3, top + part * (static_cast<double>(i) + 0.5) + 3},
                   fitted(text, sheet_.text(8.5), right - left - 6), {.size = 8.5});
    }
  }

  std::vector<TaskLane> task_lanes() const {
    std::vector<TaskLane> lanes;
    for (const auto& node : c_.nodes)
      for (const auto& task : node.tasks) {
        if (task.activation.kind != schedules::model::ActivationKind::kTime) continue;
        const auto& at = task.activation.at;
        const std::string when = at.repetition > 1 ? fmt::format(" ({} mod {})", at.base_cycle, at.repetition) : "";
        lanes.push_back(
            {node.name + ": " + task.name + when,
             {{static_cast<double>(at.offset.value), macroticks(task.worst_case),
               fmt::format("{}, at {} MT of cycles {} mod {}, at most {} us", task.name, at.offset.value, at.base_cycle,
                           at.repetition, drawing::number(task.worst_case.seconds() * 1e6))}}});
      }
    for (const auto& sensor : c_.sensors)
      if (sensor.scheduled)
        lanes.push_back({fmt::format("{} measures{}", sensor.name,
                                     sensor.at.repetition > 1
                                         ? fmt::format(" ({} mod {})", sensor.at.base_cycle, sensor.at.repetition)
                                         : ""),
                         {{static_cast<double>(sensor.at.offset.value), 0, sensor.name}}});
    return lanes;
  }

  void draw_tasks(const std::vector<TaskLane>& lanes, double top) {
    const double cycle = c_.flexray.gMacroPerCycle;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      const double centre = top + kTaskLane * (static_cast<double>(i) + 0.5);
      svg_->line({left_, centre}, {left_ + plot_, centre}, {.stroke = "#e0e0e0", .width = 0.7});
      // A lane has room for two lines.
      std::vector<std::string> label = drawing::broken(lanes[i].label, sheet_.text(10), sheet_.line(left_ - 20));
      while (label.size() > 2) {
        label[label.size() - 2] += ' ' + label.back();
        label.pop_back();
      }
      for (std::string& one : label) one = fitted(one, sheet_.text(10), left_ - 20);
      svg_->lines({left_ - 12, centre + 4 - drawing::kLineHeight / 2 * static_cast<double>(label.size() - 1)}, label,
                  {.size = 10, .anchor = drawing::Anchor::kEnd});
      for (const TaskBox& box : lanes[i].boxes) {
        if (box.length_mt <= 0) {
          svg_->marker(drawing::Marker::kDownTriangle, {x(box.offset_mt), centre}, 11, {.fill = drawing::kBlack},
                       box.text, "instant");
          continue;
        }
        // A task that runs on into the next cycle ends in an arrow at the cycle's end.
        const double end = std::min(cycle, box.offset_mt + box.length_mt);
        svg_->rect({x(box.offset_mt), centre - 8, std::max(2.0, x(end) - x(box.offset_mt)), 16},
                   {.fill = "#c9d7e6", .stroke = "#5b7083", .width = 0.7}, box.text, "task");
        if (box.offset_mt + box.length_mt > cycle)
          svg_->arrow({x(end) - 1, centre}, {x(end) + 14, centre}, {.stroke = "#5b7083", .width = 1.6},
                      "runs on into the next cycle", "overrun");
        const std::string length = fmt::format(
            "{} us", drawing::number(box.length_mt * static_cast<double>(c_.flexray.gdMacrotick_ps) * 1e-6));
        if (x(end) - x(box.offset_mt) > drawing::text_width(length, sheet_.text(9)) + 6)
          svg_->text({(x(box.offset_mt) + x(end)) / 2, centre + 3.5}, length,
                     {.size = 9, .anchor = drawing::Anchor::kMiddle});
      }
    }
  }

  void draw_axis(double top, double bottom) {
    const double ms = static_cast<double>(c_.flexray.cycle_ps()) * 1e-9;
    const drawing::Ticks ticks = drawing::nice_ticks({0, ms}, sheet_.on_paper() ? static_cast<int>(plot_ / 50) : 12);
    svg_->line({left_, bottom}, {left_ + plot_, bottom}, {.stroke = drawing::kBlack, .width = 0.8});
    for (const double t : ticks.at) {
      const double px = left_ + t / ms * plot_;
      svg_->line({px, top}, {px, bottom + 4}, {.stroke = "#888888", .width = 0.5, .dash = "2 3"});
      svg_->text({px, bottom + 16}, drawing::tick_label(t, ticks.step),
                 {.size = 10.5, .anchor = drawing::Anchor::kMiddle});
    }
    svg_->text({left_ + plot_ / 2, bottom + 33}, "time in the cycle [ms]",
               {.size = 11.5, .anchor = drawing::Anchor::kMiddle});
  }

  std::string list_of(const schedules::model::Task& task) const {
    for (const auto& binding : task.reads)
      if (binding.port == task.activation.port) return "a list of " + names_.pdu(binding.pdu);
    return "a list at " + task.activation.port;
  }

  static std::string in_modes(const schedules::model::Task& task) {
    std::string words = fmt::format("at {} MT of cycles of its modes: ", task.activation.at.offset.value);
    for (const auto& mode : task.modes)
      words += fmt::format("{}{} of {} cycles", &mode == &task.modes.front() ? "" : ", ", mode.name, mode.cycles);
    return words;
  }

  // Describes tasks without a place in the cycle in words.
  std::vector<std::string> other_tasks() const {
    using schedules::model::ActivationKind;
    std::vector<std::string> lines;
    for (const auto& node : c_.nodes)
      for (const auto& task : node.tasks) {
        std::string when;
        switch (task.activation.kind) {
          case ActivationKind::kTime: continue;
          case ActivationKind::kModes: when = in_modes(task); break;
          case ActivationKind::kMessage: when = "when " + list_of(task) + " has arrived"; break;
          case ActivationKind::kSensor: when = "when " + names_.sensor(task.activation.sensor) + " measures"; break;
          case ActivationKind::kCompletion: when = "when " + task.activation.after + " ends"; break;
        }
        const std::string words = fmt::format("{}: {} runs {}, {} to {} us", node.name, task.name, when,
                                              drawing::number(task.best_case.seconds() * 1e6),
                                              drawing::number(task.worst_case.seconds() * 1e6));
        for (std::string& one : drawing::broken(words, sheet_.text(10), line())) lines.push_back(std::move(one));
      }
    return lines;
  }

  // Draws slots by cycles: both channels in one cell, A above B.
  void draw_matrix(double top, double cell, double row) {
    drawing::LabelSpace numbers;
    for (std::size_t s = 0; s < used_.size(); ++s) {
      const drawing::Point at{left_ + cell * (static_cast<double>(s) + 0.5), top - 6};
      const std::string text = fmt::format("{}", used_[s]);
      const drawing::TextStyle style{.size = sheet_.text(cell < 22 ? 7.5 : 9.5), .anchor = drawing::Anchor::kMiddle};
      drawing::Area room = text_area(at, text, style);
      room.x -= 1, room.width += 2;
      if (!sheet_.on_paper() || numbers.claim(room)) svg_->text(at, text, style);
    }
    svg_->text({left_ - 12, top - 6}, "slot", {.size = 10, .anchor = drawing::Anchor::kEnd});
    for (int cycle = 0; cycle < rows(); ++cycle) {
      const double y = top + row * cycle;
      svg_->text({left_ - 12, y + row / 2 + 4}, fmt::format("cycle {}", cycle),
                 {.size = 10, .anchor = drawing::Anchor::kEnd});
      for (std::size_t s = 0; s < used_.size(); ++s) {
        const double left = left_ + cell * static_cast<double>(s);
        svg_->rect({left, y, cell, row}, {.fill = "#ffffff"});
        for (const FrameSlot* f : frames_.at(used_[s])) {
          if (!in_cycle(*f, cycle)) continue;
          const bool a = includes(f->channels, Channel::kA), b = includes(f->channels, Channel::kB);
          svg_->rect({left, a ? y : y + row / 2, cell, a && b ? row : row / 2}, {.fill = colour(f->pdu)},
                     frame_text(*f), "cell");
          const std::string text = number_of(*f);
          const double middle = a && b ? y + row / 2 : a ? y + row / 4 : y + row * 3 / 4;
          if (fits(text, cell))
            svg_->text({left + cell / 2, middle + 3}, text, {.size = 8, .anchor = drawing::Anchor::kMiddle});
        }
        svg_->rect({left, y, cell, row}, {.stroke = "#bbbbbb", .width = 0.5});
      }
    }
  }

  std::string number_of(const FrameSlot& f) const {
    return f.pdu == kNoPdu ? "status" : fmt::format("{}/{}", f.fragment + 1, c_.pdu(f.pdu).max_fragments());
  }
  bool fits(const std::string& text, double cell) const {
    return drawing::text_width(text, sheet_.text(8)) <= cell - 2;
  }
  bool any_number_fits(double cell) const {
    return std::ranges::any_of(frames_, [&](const auto& of_slot) {
      return std::ranges::any_of(of_slot.second, [&](const FrameSlot* f) { return fits(number_of(*f), cell); });
    });
  }

  const Cluster& c_;
  drawing::Sheet sheet_;
  drawing::Names names_;
  double left_ = 110;  // start of the plot, right of the lane labels
  double plot_ = kPlotWidth, words_left_ = 0, words_width_ = 0;
  int repetition_ = 1;
  std::map<int, std::vector<const FrameSlot*>> frames_;
  std::vector<int> used_;
  drawing::Svg* svg_ = nullptr;
};

}  // namespace

std::string schedule_svg(const Cluster& cluster, const drawing::Sheet& sheet) {
  if (cluster.frames.empty() && cluster.nodes.empty())
    return drawing::empty_picture("Schedule of " + cluster.name, "The cluster has no nodes and no frames.", sheet);
  return SchedulePainter(cluster, sheet).picture();
}

}  // namespace ttf::report::plots
