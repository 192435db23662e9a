// Receives the events of a trial, for a replay in words.
#pragma once

#include "bus/poc/poc.h"
#include "core/ids.h"
#include "core/time.h"
#include "evaluation/faults/judge.h"
#include "recording/records/records.h"
#include "sim/medium/star_coupler.h"

namespace ttf::experiments::campaign::flexray {

class TrialStory {
 public:
  virtual ~TrialStory() = default;
  virtual void state_changed(NodeId node, bus::poc::PocKind from, const bus::poc::PocStep& step, TrueTime at) = 0;
  virtual void fault_acts(const recording::records::FaultActivity& activity) = 0;
  virtual void guardian_intervened(const sim::medium::StarCoupler::Intervention& intervention) = 0;
  virtual void judged(const evaluation::faults::Judgement& judgement) = 0;
};

}  // namespace ttf::experiments::campaign::flexray
