#include <fmt/format.h>

#include <utility>

#include "cli/schedule/packing/standing.h"
#include "core/decimal.h"
#include "schedules/model/cluster.h"
#include "schedules/packing/imported/bus_signals.h"

namespace ttf::cli::schedule::packing {
namespace {

namespace imported = schedules::packing::imported;

// The table of the packing is that of the bus, or there is a finding.
void expect_shape(const imported::BusSignals& bus, const std::string& name, const TableShape& shape,
                  Findings& findings) {
  const auto expect = [&](const char* key, const std::string& value, bool same, const std::string& expected) {
    if (!same) findings.add({name, bus.cluster_line, key, value, expected});
  };
  expect("cycle", scaled_text(bus.cycle.ns, 1'000'000) + " ms", bus.cycle == shape.cycle,
         fmt::format("must be {} ms, as --cycle says", scaled_text(shape.cycle.ns, 1'000'000)));
  const int words = (shape.payload_bits + 15) / 16;
  expect("gPayloadLengthStatic", std::to_string(bus.payload_words), bus.payload_words == words,
         fmt::format("must be {}, for the {} bits of --payload", words, shape.payload_bits));
  expect("cycles of a round", std::to_string(bus.cycles), bus.cycles % shape.cycles == 0,
         fmt::format("must be a multiple of {}, the --cycles", shape.cycles));
}

}  // namespace

void gather_bus(std::string text, const std::string& name, const TableShape& shape, StandingGatherer& standing,
                Findings& findings) {
  const imported::BusSignals bus = imported::parse_bus_signals(std::move(text), name);
  expect_shape(bus, name, shape, findings);
  findings.throw_if_any();
  for (const imported::BusSignal& one : bus.signals) {
    const StandingSignal signal{one.name,
                                one.node,
                                scaled_text((bus.cycle * one.repetition).ns, 1'000'000),
                                std::to_string(one.bits),
                                std::string(schedules::model::channels_text(one.place.number.channels)),
                                one.line};
    if (const auto index = standing.find(signal, findings)) standing.place(*index, signal, one.place, findings);
  }
}

}  // namespace ttf::cli::schedule::packing
