#include "schedules/exchange/fibex/references.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace ttf::schedules::exchange::fibex {
namespace {

// The references that the importer follows, and their targets.
struct ReferenceKind {
  std::string_view reference, target;
};
constexpr ReferenceKind kReferenceKinds[] = {
    {"fx:CHANNEL-REF", "fx:CHANNEL"},
    {"fx:CODING-REF", "fx:CODING"},
    {"fx:CONTROLLER-REF", "fx:CONTROLLER"},
    {"fx:FRAME-REF", "fx:FRAME"},
    {"fx:PDU-REF", "fx:PDU"},
    {"fx:FRAME-TRIGGERING-REF", "fx:FRAME-TRIGGERING"},
    {"fx:SIGNAL-REF", "fx:SIGNAL"},
    {"ho:UNIT-REF", "ho:UNIT"},
};

struct Target {
  std::string name;
  int line = 0;
};
using Targets = std::map<std::string, Target>;

// Returns all elements of a file, each before its children. There is no recursion, because the file decides its
// depth.
std::vector<XmlElement> all_elements(const XmlFile& file, Findings& left_out) {
  std::vector<XmlElement> all, open{file.root(left_out)};
  while (!open.empty()) {
    all.push_back(std::move(open.back()));
    open.pop_back();
    std::vector<XmlElement> inner = all.back().elements();
    std::move(inner.rbegin(), inner.rend(), std::back_inserter(open));
  }
  return all;
}

Finding finding_at(const XmlFile& file, const XmlElement& element, std::string value, std::string expected) {
  return {file.name(), element.line(), element.path(), std::move(value), std::move(expected)};
}

void check_reference(const XmlFile& file, XmlElement& element, const Targets& targets, Findings& wrong) {
  const std::string name = element.name(), id = element.attribute("ID-REF");
  const auto kind = std::find_if(std::begin(kReferenceKinds), std::end(kReferenceKinds),
                                 [&](const ReferenceKind& one) { return one.reference == name; });
  const bool known = kind != std::end(kReferenceKinds);
  if (id.empty()) {
    if (known) wrong.add(finding_at(file, element, "", fmt::format("must have the ID-REF of a {}", kind->target)));
    return;
  }
  const auto target = targets.find(id);
  if (target == targets.end())
    wrong.add(finding_at(file, element, id, "must be the ID of an element of this file"));
  else if (known && target->second.name != kind->target)
    wrong.add(finding_at(file, element, id,
                         fmt::format("must be the ID of a {}, not of the {} in line {}", kind->target,
                                     target->second.name, target->second.line)));
}

}  // namespace

void check_references(const XmlFile& file, Findings& wrong) {
  Findings unused;  // nothing is left out here
  std::vector<XmlElement> elements = all_elements(file, unused);
  Targets targets;
  for (XmlElement& element : elements) {
    const std::string id = element.attribute("ID");
    if (id.empty()) continue;
    const auto [first, fresh] = targets.try_emplace(id, Target{element.name(), element.line()});
    if (!fresh)
      wrong.add(finding_at(
          file, element, id,
          fmt::format("must have an ID of its own; the {} in line {} has it", first->second.name, first->second.line)));
  }
  for (XmlElement& element : elements) check_reference(file, element, targets, wrong);
}

}  // namespace ttf::schedules::exchange::fibex
