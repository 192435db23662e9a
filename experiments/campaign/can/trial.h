// A trial: one fault on one CAN. It simulates the controllers with the fault, their hosts and the judge.
//
// Every host queues the full lists of its messages at their shortest period, from a drawn instant on: the heaviest traffic
// that the schedule allows. In a variant with recovery: host it restarts a controller that is bus off after the
// variant's delay. A trial is a pure function of campaign, variant and index.
#pragma once

#include <cstddef>
#include <cstdint>

#include "bus/ports/can_port.h"
#include "core/ids.h"
#include "core/time.h"
#include "experiments/campaign/file.h"
#include "experiments/campaign/outcome.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::campaign::can {

struct Setting {
  const CampaignFile& campaign;
  const schedules::model::Cluster& cluster;
  std::size_t bus = 0;
};

// Receives what the hosts get from their controllers.
class Witness {
 public:
  virtual ~Witness() = default;
  virtual void received(NodeId receiver, const bus::ports::CanFrame& frame, TrueTime at) = 0;
  virtual void sent(NodeId sender, TrueTime at) = 0;
};

// `story` and `witness` may be null. `bit_by_bit`: the medium always goes its plain way; the outcome is the same.
FaultOutcome run_trial(const Setting& setting, const Variant& variant, const DrawnFault& drawn, std::uint32_t index,
                       Story* story = nullptr, bool bit_by_bit = false, Witness* witness = nullptr);

}  // namespace ttf::experiments::campaign::can
