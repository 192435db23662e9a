#include "schedules/synthesis/plan/loader.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "core/errors.h"
#include "core/strict_yaml.h"
#include "schedules/file/inherit.h"
#include "schedules/file/loader.h"
#include "schedules/left_out/earliest.h"
#include "schedules/synthesis/plan/left_out.h"
#include "schedules/synthesis/plan/section.h"

namespace ttf::schedules::synthesis::plan {
namespace {

// Moves the frames of lists with a value left out from the cluster to the plan.
void take_lists(Plan& plan, const std::vector<LeftOutValues::Frame>& entries) {
  std::vector<bool> taken(entries.size());
  for (const model::FrameSlot& frame : plan.cluster.frames) {
    const auto entry = static_cast<std::size_t>(frame.entry.value_or(0));
    if (entry >= entries.size() || !entries[entry].is_list || taken[entry]) continue;
    if (!entries[entry].slot && !entries[entry].repetition) continue;
    taken[entry] = true;
    plan.lists.push_back({frame.pdu,
                          frame.sender,
                          frame.channels,
                          frame.base_cycle,
                          frame.repetition,
                          frame.slot,
                          {entries[entry].slot, entries[entry].repetition},
                          frame.line,
                          frame.entry});
  }
  std::erase_if(plan.cluster.frames, [&](const model::FrameSlot& frame) {
    return frame.entry && taken[static_cast<std::size_t>(*frame.entry)];
  });
  std::stable_sort(plan.lists.begin(), plan.lists.end(), [](const auto& a, const auto& b) { return a.line < b.line; });
}

// Returns the lengths of the cycle, or the one length that the cluster says.
CycleLengths lengths_of(const StrictYaml& file, const std::optional<CycleLengths>& free, Findings& findings) {
  Findings none;
  YamlMap root = file.root(none);
  const auto flexray = root.map_if("flexray");
  for (const char* key : {"gdCycle", "gMacroPerCycle"})
    if (free && flexray && flexray->has(key))
      findings.add({file.name(), flexray->line(key), fmt::format("flexray.{}", key), "",
                    fmt::format("must be left out: plan.cycle (line {}) has the lengths to choose from", free->line)});
  if (free) return *free;
  if (!flexray || !flexray->has("gdCycle")) {
    findings.add({file.name(), flexray ? flexray->line() : 1, "flexray.gdCycle", "",
                  "is missing: a plan without plan.cycle has one length of the cycle"});
    return {Duration::milliseconds(5), Duration::milliseconds(5), Duration::milliseconds(5), 0};
  }
  YamlMap known = *flexray;
  const Duration one{known.scaled("gdCycle", 1'000'000, {10'000'000, 16'000'000'000}, "us") / 1'000};
  return {one, one, one, known.line("gdCycle")};
}

// A plan says the payload, or has the lengths to choose from.
void refuse_payloads(const StrictYaml& file, const std::optional<PayloadLengths>& free, Findings& findings) {
  Findings none;
  YamlMap root = file.root(none);
  const auto flexray = root.map_if("flexray");
  if (free && flexray && flexray->has("gPayloadLengthStatic"))
    findings.add({file.name(), flexray->line("gPayloadLengthStatic"), "flexray.gPayloadLengthStatic", "",
                  fmt::format("must be left out: plan.payload (line {}) has the lengths to choose from", free->line)});
}

// The payload of static slots says how many elements are in a fragment, where nothing else does.
void refuse_layouts(const Plan& plan, Findings& findings) {
  for (std::size_t p = 0; p < plan.free_layouts.size(); ++p) {
    if (!plan.free_layouts[p]) continue;
    const auto pdu = static_cast<PduId>(p);
    const model::PduLayout& layout = plan.cluster.pdu(pdu);
    const bool planned =
        std::any_of(plan.lists.begin(), plan.lists.end(), [&](const PlannedList& list) { return list.pdu == pdu; });
    const bool on_a_can =
        std::any_of(plan.cluster.can_buses.begin(), plan.cluster.can_buses.end(), [&](const auto& bus) {
          return std::any_of(bus.messages.begin(), bus.messages.end(), [&](const auto& one) { return one.pdu == pdu; });
        });
    if (!planned || on_a_can)
      findings.add(
          {plan.cluster.file, layout.line, fmt::format("pdus.{}.fragment_bytes", layout.name), "",
           "must be said: the payload of static slots stands for it only where a plan chooses the list's slots, "
           "and no CAN carries it"});
  }
}

// Candidates copy the cluster: what they have in common is kept once.
void set_aside(Plan& plan) {
  auto kept = std::make_shared<Unchanging>();
  kept->parameter_lines = std::move(plan.cluster.parameter_lines);
  kept->pdus = plan.cluster.pdus;
  plan.unchanging = std::move(kept);
  plan.cluster.parameter_lines.clear();
  plan.cluster.text.clear();
  for (model::PduLayout& layout : plan.cluster.pdus) {
    layout.header.clear();
    layout.element.clear();
  }
}

Plan read(StrictYaml file, TextOrigins origins) {
  Findings findings;
  YamlMap root = file.root(findings);
  YamlMap section = root.map("plan");
  Plan plan;
  const auto free = read_cycle(section);
  plan.free_cycle = free.has_value();
  plan.payload = read_payload(section);
  refuse_payloads(file, plan.payload, findings);
  plan.cycle = lengths_of(file, free, findings);
  LeftOutValues left = fill_in(file, plan.cycle.longest, plan.payload, findings);
  file.take("plan");
  try {
    plan.cluster = file::read_cluster(file);
  } catch (const InputError& error) {
    for (const Finding& finding : error.findings()) findings.add(finding);
  }
  findings.throw_if_any();  // names have no meaning yet
  plan.parameters = std::move(left.parameters);
  plan.tasks = std::move(left.tasks);
  plan.shortest_periods = std::move(left.shortest_periods);
  plan.free_layouts = std::move(left.layouts);
  for (const LeftOut& at : left.sensors) plan.sensors.push_back({at, std::nullopt, std::nullopt});
  take_lists(plan, left.frames);
  left_out::use_key_slots(plan.cluster, plan.lists);
  refuse_layouts(plan, findings);
  plan.origins = std::move(origins);
  read_section(section, plan);
  findings.throw_if_any();
  set_aside(plan);
  return plan;
}

std::vector<Finding> moved(const TextOrigins& origins, std::vector<Finding> findings) {
  for (Finding& finding : findings) finding = origins.moved(std::move(finding));
  return findings;
}

Plan read(std::string text, const std::string& name, TextOrigins origins) {
  try {
    return read(StrictYaml::parse(std::move(text), name), origins);
  } catch (const InputError& error) {
    throw InputError(moved(origins, error.findings()));
  }
}

}  // namespace

Plan parse_plan(std::string text, std::string name) { return read(std::move(text), name, {}); }

std::vector<Finding> in_the_files(const Plan& plan, std::vector<Finding> findings) {
  return moved(plan.origins, std::move(findings));
}

// The values are made up, and have no meaning.
void ask_for_keys(const StrictYaml& described) {
  Findings made_up;
  YamlMap root = described.root(made_up);
  YamlMap section = root.map("plan");
  (void)read_cycle(section);
  StrictYaml filled = described;
  const auto payload = read_payload(section);
  (void)fill_in(filled, Duration::milliseconds(5), payload, made_up);
  try {
    (void)file::read_cluster(filled);
  } catch (const InputError&) {
  }
  Plan nothing;
  read_section(section, nothing);
}

Plan load_plan(const std::string& path) {
  file::ClusterText whole = file::inherited(path);
  return read(std::move(whole.text), path, std::move(whole.origins));
}

}  // namespace ttf::schedules::synthesis::plan
