// Reads faults. Any key that the kind of an entry does not take is unknown.
#include "core/file_kind.h"
#include "faults/parameters.h"
#include "faults/plan.h"

namespace ttf::faults {

Fault load_fault(YamlMap& yaml, Duration latest) {
  Choices<FaultKind> kinds;
  for (const FaultKind kind : kAllFaultKinds) kinds.emplace_back(name_of(kind), kind);
  Fault fault;
  fault.line = yaml.line();
  fault.kind = yaml.choice<FaultKind>("kind", kinds);
  // Without a kind the right keys are unknown.
  if (!yaml.has("kind") || yaml.text("kind") != name_of(fault.kind)) return fault;
  if (has_node(fault.kind)) fault.node_name = yaml.text("node");
  read_parameters(yaml, fault, latest);
  yaml.finish();
  return fault;
}

FaultPlan load_fault_plan(YamlMap& yaml, Duration latest) {
  FaultPlan plan;
  plan.file = yaml.file();
  for (YamlMap& entry : yaml.maps_if("faults")) plan.faults.push_back(load_fault(entry, latest));
  return plan;
}

FaultPlan read_fault_plan(const StrictYaml& file, Duration latest) {
  expect_kind(file, FileKind::kFaults);
  Findings findings;
  YamlMap root = file.root(findings);
  FaultPlan plan = load_fault_plan(root, latest);
  root.finish();
  findings.throw_if_any();
  return plan;
}

}  // namespace ttf::faults
