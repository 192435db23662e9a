#include "nodes/foreign/foreign_step.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <optional>
#include <stdexcept>
#include <utility>

#include "core/errors.h"

namespace ttf::nodes::foreign {
namespace {

constexpr std::size_t kLongestWords = 400;  // about a refused task
constexpr std::int64_t kFarthest_ns = std::int64_t{1} << 62;

Finding place_of(const schedules::model::Cluster& cluster, const schedules::model::Node& node,
                 const schedules::model::Task& task) {
  std::string key = fmt::format("nodes.{}.tasks.{}.step", node.name, task.name);
  const auto line = cluster.parameter_lines.find(key);
  return cluster.finding(line == cluster.parameter_lines.end() ? task.line : line->second, std::move(key), task.step,
                         "");
}

const StepFolder& allowed(const StepFolder* folder, Finding place) {
  if (folder != nullptr) return *folder;
  place.expected = "needs --steps FOLDER, the library's folder: a cluster file alone loads no code";
  throw InputError(std::move(place));
}

// Returns the place in the words of an error.
std::string text_of(const Finding& place) {
  Finding finding = place;
  finding.expected.clear();
  std::string text = finding.sentence();
  while (text.ends_with(' ') || text.ends_with(':')) text.pop_back();
  return text;
}

std::size_t room_of(const schedules::model::PortBinding& port, const schedules::model::Cluster& cluster) {
  const schedules::model::PduLayout& layout = cluster.pdu(port.pdu);
  return static_cast<std::size_t>(layout.max_elements) * layout.element.size();
}

}  // namespace

PortDescriptions::PortDescriptions(const schedules::model::Cluster& cluster,
                                   const std::vector<schedules::model::PortBinding>& bindings)
    : described_(bindings.size()) {
  for (std::size_t p = 0; p < bindings.size(); ++p) {
    const schedules::model::PduLayout& layout = cluster.pdu(bindings[p].pdu);
    Described& one = described_[p];
    one.signals.reserve(layout.element.size());
    for (const schedules::model::Signal& signal : layout.element) {
      one.signals.push_back({.struct_size = sizeof(ttf_step_signal),
                             .name = signal.name.c_str(),
                             .unit = signal.unit.c_str(),
                             .low = signal.low,
                             .high = signal.high,
                             .resolution = signal.resolution});
      one.pointers.push_back(&one.signals.back());
    }
    one.port = {.struct_size = sizeof(ttf_step_port),
                .name = bindings[p].port.c_str(),
                .pdu = layout.name.c_str(),
                .capacity = static_cast<std::uint32_t>(layout.max_elements),
                .time_stamped = schedules::model::find_signal(layout.header, "timestamp") ? 1u : 0u,
                .signal_count = static_cast<std::uint32_t>(layout.element.size()),
                .signals = one.pointers.data()};
    pointers_.push_back(&one.port);
  }
}

ForeignStep::ForeignStep(const schedules::model::Cluster& cluster, const schedules::model::Node& node,
                         const schedules::model::Task& task, const StepFolder* folder)
    : place_(place_of(cluster, node, task)), terms_(terms_of(text_of(place_), allowed(folder, place_).limit)),
      round_(cluster.round()), reads_(cluster, task.reads), writes_(cluster, task.writes), ins_(task.reads.size()),
      outs_(task.writes.size()), library_(load_library(folder->path + "/" + task.step, place_, terms_)) {
  for (std::size_t i = 0; i < ins_.size(); ++i) {
    In& in = ins_[i];
    in.values.resize(room_of(task.reads[i], cluster));
    in.list.struct_size = sizeof in.list;
    in.list.values = in.values.data();
    in_pointers_.push_back(&in.list);
  }
  for (std::size_t o = 0; o < outs_.size(); ++o) {
    Out& out = outs_[o];
    out.values.resize(room_of(task.writes[o], cluster));
    out_pointers_.push_back(&out.list);
  }
  const ttf_step_task described{.struct_size = sizeof(ttf_step_task),
                                .node = node.name.c_str(),
                                .name = task.name.c_str(),
                                .cycle_ns = cluster.cycle().ns,
                                .input_count = static_cast<std::uint32_t>(ins_.size()),
                                .inputs = reads_.ports(),
                                .output_count = static_cast<std::uint32_t>(outs_.size()),
                                .outputs = writes_.ports()};
  std::array<char, kLongestWords> words{};
  const std::optional<std::string> thrown =
      thrown_by(terms_, [&] { self_ = library_.create(&described, words.data(), words.size()); });
  words.back() = '\0';
  if (self_ != nullptr) return;
  Finding refusal = place_;
  refusal.expected =
      thrown ? "ttf_step_create " + *thrown
             : fmt::format("is refused by the library: {}", words[0] != '\0' ? words.data() : "it gives no reason");
  throw InputError(std::move(refusal));
}

// A destructor must not throw: an exception is a crash, within the guard.
ForeignStep::~ForeignStep() {
  const Call call(terms_);
  try {
    library_.destroy(self_);
  } catch (...) {
    std::terminate();
  }
}

void ForeignStep::fail(const std::string& words) const {
  Finding failure = place_;
  failure.expected = words;
  throw std::runtime_error(failure.sentence());
}

// A list's time stamp is placed when it arrives: later, it could mean another round.
void ForeignStep::take(const host::Input& input, const host::StepContext& context, In& in) const {
  in.list.present = input.list ? 1 : 0;
  in.list.fresh = input.fresh ? 1 : 0;
  if (!input.list || !input.fresh) return;
  const schedules::model::PduLayout& layout = *input.layout;
  const int count = host::element_count(layout, *input.list);
  in.list.sequence = input.list->sequence;
  in.list.count = static_cast<std::uint32_t>(count);
  in.list.time_known = context.global_time && schedules::model::find_signal(layout.header, "timestamp") ? 1 : 0;
  in.list.time_stamp_ns =
      in.list.time_known != 0 ? host::time_stamp(layout, *input.list, context.stamp.global, round_).ns : 0;
  std::size_t at = 0;
  for (int e = 0; e < count; ++e)
    for (std::size_t s = 0; s < layout.element.size(); ++s)
      in.values[at++] = host::element_value(layout, *input.list, e, s);
}

void ForeignStep::give(const Out& out, host::Output& output) const {
  if (out.list.written == 0) return;
  const schedules::model::PduLayout& layout = output.layout();
  if (out.list.values != out.values.data())
    fail(
        fmt::format("replaced the pointer to the values of the port {}: they belong in the given room", output.port()));
  if (out.list.count > static_cast<std::uint32_t>(layout.max_elements))
    fail(fmt::format("gave {} elements to the port {}, which has room for {}", out.list.count, output.port(),
                     layout.max_elements));
  const int count = static_cast<int>(out.list.count);
  const std::size_t signals = layout.element.size();
  for (std::size_t v = 0; v < out.list.count * signals; ++v)
    if (!std::isfinite(out.values[v]))
      fail(fmt::format("gave {} as {} of element {} to the port {}: values must be finite", out.values[v],
                       layout.element[v % signals].name, v / signals, output.port()));
  if (out.list.time_stamp_ns < -kFarthest_ns || out.list.time_stamp_ns > kFarthest_ns)
    fail(fmt::format("gave the time stamp {} ns to the port {}: it must be within 2^62 ns", out.list.time_stamp_ns,
                     output.port()));
  output.begin(out.list.sequence, count, GlobalTime{out.list.time_stamp_ns});
  for (int e = 0; e < count; ++e)
    for (std::size_t s = 0; s < signals; ++s) output.set(e, s, out.values[static_cast<std::size_t>(e) * signals + s]);
}

void ForeignStep::run(host::StepContext& context) {
  for (std::size_t i = 0; i < ins_.size(); ++i) take(context.inputs[i], context, ins_[i]);
  for (Out& out : outs_) {
    std::fill(out.values.begin(), out.values.end(), 0.0);
    out.list = {.struct_size = sizeof(ttf_step_output),
                .written = 0,
                .sequence = 0,
                .time_stamp_ns = 0,
                .count = 0,
                .values = out.values.data()};
  }
  const ttf_step_context given{.struct_size = sizeof(ttf_step_context),
                               .start_ns = context.stamp.global.ns,
                               .global_time = context.global_time ? 1u : 0u,
                               .activation = context.activation,
                               .input_count = static_cast<std::uint32_t>(ins_.size()),
                               .inputs = in_pointers_.data(),
                               .output_count = static_cast<std::uint32_t>(outs_.size()),
                               .outputs = out_pointers_.data()};
  int result = 0;
  if (const auto thrown = thrown_by(terms_, [&] { result = library_.run(self_, &given); }))
    fail("ttf_step_run " + *thrown);
  if (result != 0) fail(fmt::format("failed: ttf_step_run returned {}", result));
  for (std::size_t o = 0; o < outs_.size(); ++o) give(outs_[o], context.outputs[o]);
}

}  // namespace ttf::nodes::foreign
