#include "cli/schedule/packing/bus_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "core/errors.h"
#include "schedules/check/checker.h"
#include "schedules/packing/bus.h"
#include "schedules/packing/frames.h"
#include "schedules/packing/variants/projection.h"

namespace ttf::cli::schedule::packing {
namespace {

namespace table = schedules::packing;
using table::variants::Projection;

// The vehicles of the variants, or the only one.
std::vector<Projection> vehicles_of(const table::Instance& instance) {
  std::vector<Projection> vehicles;
  for (int variant = 0; variant < instance.variant_count(); ++variant)
    vehicles.push_back(table::variants::projection(instance, variant));
  return vehicles;
}

std::string content_of(const std::vector<table::PackedFrame>& frames, std::size_t added) {
  const auto with_signals = std::count_if(frames.begin(), frames.end(),
                                          [](const table::PackedFrame& frame) { return !frame.signals.empty(); });
  std::string content = fmt::format("{} frames with signals", with_signals);
  if (added > 0) content += fmt::format(", and {} slots more: key slots, without signals", added);
  return content;
}

}  // namespace

std::vector<std::string> bus_paths(const SignalFile& signals, const std::string& path) {
  std::vector<std::string> paths;
  const std::filesystem::path whole(path);
  for (const std::string& variant : signals.instance.variants)
    paths.push_back(
        (whole.parent_path() / (whole.stem().string() + "_" + variant + whole.extension().string())).string());
  return paths.empty() ? std::vector<std::string>{path} : paths;
}

std::vector<BusFile> bus_files(const SignalFile& signals, const table::Assignment& assignment,
                               const std::string& path) {
  const std::vector<Projection> vehicles = vehicles_of(signals.instance);
  std::vector<std::vector<table::PackedFrame>> frames;
  for (const Projection& vehicle : vehicles) frames.push_back(frames_of(vehicle.instance, vehicle.of(assignment)));
  std::vector<std::size_t> packed;
  for (const auto& of_vehicle : frames) packed.push_back(of_vehicle.size());
  table::BusRequest request{std::filesystem::path(signals.name).stem().string(), signals.name, signals.shape.cycle, 0,
                            add_key_slots(frames)};
  request.starters = starters_of(frames);
  for (const auto& of_vehicle : frames)
    for (const table::PackedFrame& frame : of_vehicle) request.slots = std::max(request.slots, frame.number.slot);
  const std::vector<std::string> paths = bus_paths(signals, path);
  std::vector<BusFile> files;
  for (std::size_t i = 0; i < vehicles.size(); ++i) {
    const table::Instance& instance = vehicles[i].instance;
    const schedules::model::Cluster bus = bus_of(instance, frames[i], request);
    if (auto findings = schedules::check::check(bus); !findings.empty()) throw InputError(std::move(findings));
    files.push_back({paths[i], bus_fibex(instance, vehicles[i].of(assignment), frames[i], bus),
                     content_of(frames[i], frames[i].size() - packed[i])});
  }
  return files;
}

}  // namespace ttf::cli::schedule::packing
