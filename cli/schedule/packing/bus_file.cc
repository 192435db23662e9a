#include "cli/schedule/packing/bus_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/errors.h"
#include "schedules/check/checker.h"
#include "schedules/synthesis/packing/bus.h"
#include "schedules/synthesis/packing/frames.h"

namespace ttf::cli::schedule::packing {

BusFile bus_file(const SignalFile& signals, const schedules::synthesis::packing::Assignment& assignment) {
  namespace table = schedules::synthesis::packing;
  const std::vector<table::PackedFrame> packed = frames_of(signals.instance, assignment);
  const std::vector<table::PackedFrame> frames = with_key_slots(packed);
  const schedules::model::Cluster bus =
      bus_of(signals.instance, frames,
             {std::filesystem::path(signals.name).stem().string(), signals.name, signals.shape.cycle});
  if (auto findings = schedules::check::check(bus); !findings.empty()) throw InputError(std::move(findings));
  const auto with_signals = std::count_if(frames.begin(), frames.end(),
                                          [](const table::PackedFrame& frame) { return !frame.signals.empty(); });
  std::string content = fmt::format("{} frames with signals", with_signals);
  if (frames.size() > packed.size())
    content += fmt::format(", and {} slots more: key slots, without signals", frames.size() - packed.size());
  return {bus_fibex(signals.instance, assignment, frames, bus), std::move(content)};
}

}  // namespace ttf::cli::schedule::packing
