#include "cli/schedule/packing/command.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "cli/argument_checks.h"
#include "cli/output.h"
#include "cli/schedule/packing/account.h"
#include "cli/schedule/packing/signal_file.h"
#include "core/check.h"
#include "core/decimal.h"
#include "core/errors.h"
#include "schedules/check/checker.h"
#include "schedules/packing/bus.h"
#include "schedules/packing/frames.h"
#include "schedules/packing/variants/check.h"
#include "schedules/packing/variants/packer.h"
#include "schedules/packing/variants/projection.h"

namespace ttf::cli::schedule::packing {
namespace {

namespace table = schedules::packing;
using table::variants::Projection;

// `schedule synthesize --fibex`: a packing as the FIBEX file of a bus, or of the bus of each variant of a vehicle.
struct BusFile {
  std::string path;
  std::string text;
  std::string content;  // for say_written()
};

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

// Returns the paths of the files: the given one, or with variants "bus_sport.xml" of "bus.xml" for each.
std::vector<std::string> bus_paths(const SignalFile& signals, const std::string& path) {
  std::vector<std::string> paths;
  const std::filesystem::path whole(path);
  for (const std::string& variant : signals.instance.variants)
    paths.push_back(
        (whole.parent_path() / (whole.stem().string() + "_" + variant + whole.extension().string())).string());
  return paths.empty() ? std::vector<std::string>{path} : paths;
}

// Returns the files. The buses of all variants have the same parameters and as many slots, and a node has the same key
// slot and the same role at startup in all. Throws InputError if the packing makes no consistent bus: it does not fit
// the cycle, or breaks a rule of a cluster.
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

constexpr Duration kShortestCycle = Duration::microseconds(10), kLongestCycle = Duration::milliseconds(16);

[[noreturn]] void refuse_option(const char* option, const std::string& text, std::string expected) {
  throw InputError({"command line", 0, option, text, std::move(expected)});
}

// Reads "32bit" or "4byte".
int payload_of(const std::string& text) {
  for (const auto& [unit, bits] : {std::pair{"bit", 1}, {"byte", 8}})
    if (text.ends_with(unit))
      if (const auto value = parse_scaled(text.substr(0, text.size() - std::string_view(unit).size()), 1);
          value && *value >= 1 && *value <= table::kMostPayloadBits / bits)
        return static_cast<int>(*value) * bits;
  refuse_option("--payload", text,
                fmt::format("must be 1..{}bit or 1..{}byte", table::kMostPayloadBits, table::kMostPayloadBits / 8));
}

TableShape shape_of(const PackingOptions& options) {
  const auto cycle = parse_duration(options.cycle);
  if (!cycle || *cycle < kShortestCycle || *cycle > kLongestCycle)
    refuse_option("--cycle", options.cycle, "must be 0.01..16 ms with its unit, as in 5ms");
  if (!std::has_single_bit(static_cast<unsigned>(options.cycles)))
    refuse_option("--cycles", std::to_string(options.cycles), "must be 1, 2, 4, 8, 16, 32 or 64");
  return {*cycle, payload_of(options.payload), options.cycles, options.slot_multiplexing};
}

table::ChannelUse use_of(const PackingOptions& options) {
  if (options.channels == "same") return table::ChannelUse::kSame;
  return options.channels == "independent" ? table::ChannelUse::kIndependent : table::ChannelUse::kOne;
}

std::vector<std::string> inputs_of(const PackingOptions& options) {
  std::vector<std::string> inputs{options.signals};
  inputs.insert(inputs.end(), options.fixed.begin(), options.fixed.end());
  return inputs;
}

void check_outputs(const PackingOptions& options, const std::string& out) {
  for (const std::string& input : inputs_of(options))
    if (!out.empty()) refuse_overwriting(input, out, "--out");
  if (options.fibex.empty()) return;
  if (options.slot_multiplexing)
    refuse_option("--fibex", options.fibex, "goes without --slot-multiplexing: the file is for FlexRay 2.1");
  if (options.channels == "independent")
    refuse_option("--fibex", options.fibex,
                  "goes with --channels one or same: a key slot has all channels of its node");
  if (options.first_slot == 0) refuse_option("--first-slot", "0", "must be 1 or more with --fibex");
}

// Variants have a file each, so this is known after the signals.
void check_bus_paths(const PackingOptions& options, const SignalFile& file, const std::string& out) {
  if (options.fibex.empty()) return;
  const auto normal = [](const std::string& path) { return std::filesystem::path(path).lexically_normal(); };
  for (const std::string& path : bus_paths(file, options.fibex)) {
    for (const std::string& input : inputs_of(options)) refuse_overwriting(input, path, "--fibex");
    if (normal(out) == normal(path)) refuse_option("--fibex", path, "must be another file than that of --out");
  }
}

// Returns 1 with a sentence for each signal without a place.
int print_impossible(const SignalFile& file) {
  for (const Finding& finding : file.impossible)
    fmt::print(stderr, "error: {}:{}: signal {} {}\n", finding.file, finding.line, finding.value, finding.expected);
  return file.impossible.empty() ? 0 : 1;
}

// Returns the reason why the slots do not suffice, or an empty text.
std::string shortage(const Account& account) {
  if (account.suffices()) return {};
  return fmt::format("need {} static slots with numbers up to {}: slots must be {}..{}, and {} has fewer than {}",
                     account.slots_needed(), account.highest_slot(), account.first_slot, account.last_slot(),
                     no_packing(account), account.least_slots());
}

// A cluster numbers its slots from 1. A packing that stands may have slot 0.
void check_bus_slots(const std::vector<std::string>& fixed, const std::vector<table::SlotNumber>& numbers) {
  for (const table::SlotNumber& number : numbers)
    if (number.slot == 0)
      throw InputError({fmt::format("{}", fmt::join(fixed, ", ")), 0, "slot", "0", "must be 1 or more with --fibex"});
}

}  // namespace

void add_packing_options(CLI::App& command, PackingOptions& options) {
  const auto group = [&](CLI::Option* option) { return option->group("Signals"); };
  CLI::Option* signals = group(command.add_option("--signals", options.signals,
                                                  "Signals to pack into frames, also of variants of a vehicle: CSV"));
  signals->check(named());
  std::vector<CLI::Option*> others{
      command
          .add_option("--fixed", options.fixed,
                      "Packing to keep, CSV or FIBEX: its signals do not move, new ones are added; may be repeated")
          ->check(named())
          ->allow_extra_args(false),
      command
          .add_option("--fibex", options.fibex,
                      "Bus description to write: FIBEX 3.1; with variants one for each, as in bus_sport.xml")
          ->check(named()),
      command.add_option("--cycle", options.cycle, "Communication cycle")->capture_default_str(),
      command.add_option("--payload", options.payload, "Payload of a frame, in bit or byte")->capture_default_str(),
      command.add_option("--cycles", options.cycles, "Cycles after which the schedule repeats: a power of two")
          ->check(whole_number({1, table::kMostCycles}))
          ->capture_default_str(),
      command.add_flag("--slot-multiplexing", options.slot_multiplexing,
                       "Share slots among nodes, in different cycles (FlexRay 3.0)"),
      command
          .add_option("--channels", options.channels,
                      "one; same: both channels with the same content; independent: each with its own")
          ->check(one_of({"one", "same", "independent"}))
          ->capture_default_str(),
      command.add_option("--first-slot", options.first_slot, "Number of the first slot to use")
          ->check(whole_number({0, table::kLastStaticSlot}))
          ->capture_default_str(),
      command.add_option("--slots", options.slots, "Static slots that are there (default: as many as needed)")
          ->check(whole_number({1, table::kLastStaticSlot})),
      command.add_option("--steps", options.steps, "Steps of improvement for a node above its bound")
          ->check(whole_number({0, 1'000'000}))
          ->capture_default_str(),
      command.add_option("--seed", options.seed, "Seed of the improvement")
          ->check(whole_number({0, 4'294'967'295}))
          ->capture_default_str(),
      command.add_option("--room-for", options.room_bits, "Length of the further signals that the room is told for")
          ->check(whole_number({1, table::kMostPayloadBits}))
          ->capture_default_str()};
  for (CLI::Option* option : others) group(option)->needs(signals);
}

int pack_signals(const PackingOptions& options, const std::string& out, bool json) {
  check_outputs(options, out);
  const table::ChannelUse use = use_of(options);
  const SignalFile file = read_signals(options.signals, shape_of(options));
  check_bus_paths(options, file, out);
  StandingPlaces standing;
  if (!options.fixed.empty()) standing = read_standing(options.fixed, file, use);
  print_warnings(standing.notes);
  if (!options.fibex.empty()) check_bus_slots(options.fixed, standing.numbers);
  const table::Effort effort{options.steps, options.seed};
  const bool has_variants = !file.instance.variants.empty();
  const table::Solution solution = has_variants ? table::variants::pack_variants(file.instance, standing.places, effort)
                                                : pack(file.instance, standing.places, effort);
  std::optional<table::Solution> one_vehicle;
  if (has_variants) one_vehicle = pack(table::variants::one_vehicle(file.instance), {}, effort);
  const auto numbers = slot_numbers(standing.numbers, solution.bins, options.first_slot, use);
  const table::Assignment assignment = assigned(solution.places, numbers);
  const auto rooms = room_left(file.instance, solution.places, options.room_bits);
  const auto kept = std::count_if(standing.places.begin(), standing.places.end(),
                                  [](const auto& place) { return place.has_value(); });
  const Account account{.file = file,
                        .solution = solution,
                        .numbers = numbers,
                        .rooms = rooms,
                        .one_vehicle = one_vehicle ? &*one_vehicle : nullptr,
                        .use = use,
                        .standing = static_cast<int>(kept),
                        .room_bits = options.room_bits,
                        .first_slot = options.first_slot,
                        .slots = options.slots};
  fmt::print("{}", json ? account_json(account) : account_text(account));
  int code = print_impossible(file);
  if (const std::string why = shortage(account); !why.empty()) {
    fmt::print(stderr, "error: {}: the signals {}\n", options.signals, why);
    return 1;
  }
  const auto broken = table::variants::variant_violations(file.instance, assignment);
  TTF_CHECK(broken.empty(), "signal {} {}", file.instance.signals[broken.front().signal].name, broken.front().text);
  if (!options.fibex.empty()) {
    for (const BusFile& bus : bus_files(file, assignment, options.fibex)) {
      write_file(bus.path, bus.text);
      say_written(bus.path, bus.content);
    }
  }
  if (!out.empty()) {
    write_file(out, packing_csv(file, assignment));
    say_written(out, fmt::format("{} slots", account.slots_needed()));
  }
  return code;
}

}  // namespace ttf::cli::schedule::packing
