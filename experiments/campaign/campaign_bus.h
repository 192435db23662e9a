// A campaign's bus: how a campaign over one kind of bus draws its faults, tries and judges them, and says the results.
// FlexRay's is in flexray/, a CAN's in can/. All of it is const: workers share it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/time.h"
#include "experiments/campaign/file.h"
#include "experiments/campaign/outcome.h"
#include "schedules/model/cluster.h"

namespace ttf::experiments::campaign {

// The words of tables and messages.
struct Words {
  std::vector<std::string_view> checks;         // by bit of FaultOutcome::seen_by_others
  std::vector<std::string_view> check_columns;  // the same, of at most eight letters
  std::vector<std::string_view> harms;          // by bit of FaultOutcome::harms
  std::string_view trait;                       // only some variants have it
  std::string_view halt = "halt";               // the members of FaultOutcome
  std::string_view reintegrate = "reintegrate", reintegrated = "reintegrated";
  std::string_view frame_id = "slot";
  std::string_view unit_name;  // for the tables' times: "cycles"
  Duration unit{};
  std::string_view unit_beside_ms;  // a story states times in the unit, too, by this word; empty: it does not
};

// The faults that must not harm: at most so many do.
struct Expectation {
  std::string_view key;  // in coverage.json
  std::int64_t most = 0;
  std::string sentence;  // "at most 0 faults of the hypothesis do harm with guardian and both channels"
};

class CampaignBus {
 public:
  virtual ~CampaignBus() = default;
  virtual const Words& words() const = 0;
  virtual const schedules::model::Cluster& cluster() const = 0;  // as faults are drawn in it

  // Draws the n-th fault: a pure function of the campaign's seed and n, the same in every variant.
  virtual DrawnFault draw(std::uint32_t index) const = 0;
  virtual bool in_hypothesis(const faults::Fault& fault) const = 0;
  // Tries it in a variant: a pure function of the campaign, the variant and n. `story` may be null.
  virtual FaultOutcome run(std::size_t variant, const DrawnFault& drawn, std::uint32_t index,
                           Story* story = nullptr) const = 0;

  // Returns whether the variant has the trait of words().
  virtual bool has_trait(std::size_t variant) const = 0;
  // Returns whether the fault should not harm a fault-free node in this variant.
  virtual bool is_harmless(std::size_t variant, const faults::Fault& fault) const = 0;
  virtual std::optional<Expectation> expectation() const = 0;
};

// Returns the bus of a campaign, which it keeps a copy of. Throws InputError.
std::unique_ptr<const CampaignBus> bus_of(const CampaignFile& campaign);

}  // namespace ttf::experiments::campaign
