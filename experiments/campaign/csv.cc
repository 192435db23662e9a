#include "experiments/campaign/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <string_view>

#include "core/errors.h"
#include "experiments/campaign/coverage.h"

namespace ttf::experiments::campaign {
namespace {

constexpr std::size_t kColumns = 21;

std::string header(const Words& words) {
  std::string halt(words.halt);
  std::replace(halt.begin(), halt.end(), ' ', '_');
  return fmt::format(
      "fault,variant,class,phase,node,parameters,hypothesis,activated,starts_without,seen_by_others,seen_by_itself,"
      "harms,harmed,sender,{},still_out,detected_after_ns,passive_after_ns,{}_after_ns,harmed_after_ns,{}_after_ns",
      words.frame_id, halt, words.reintegrated);
}

std::string or_nothing(const std::optional<std::int64_t>& value) { return value ? fmt::to_string(*value) : ""; }

std::string_view node_name(NodeId node, const schedules::model::Cluster& cluster) {
  return node == kNoNode ? std::string_view() : std::string_view(cluster.node(node).name);
}

// Returns the beginning of a line, which identifies the fault and the variant.
std::string drawn_text(const FaultResult& result, const Variant& variant, const CampaignBus& bus) {
  const faults::Fault& fault = result.drawn.fault;
  return fmt::format("{},{},{},{},{},{},{}", result.index, variant.name, faults::name_of(fault.kind),
                     result.drawn.starts_up ? "start_up" : "steady_state", node_name(fault.node, bus.cluster()),
                     parameters_text(fault, bus.cluster()), bus.in_hypothesis(fault) ? "yes" : "no");
}

// One line, cut at its commas.
class Line {
 public:
  Line(std::string_view text, std::string name, int line) : name_(std::move(name)), line_(line), text_(text) {
    for (std::size_t at = 0; at <= text.size();) {
      const std::size_t end = std::min(text.find(',', at), text.size());
      cells_.push_back(text.substr(at, end - at));
      at = end + 1;
    }
    if (cells_.size() != kColumns) fail(text, fmt::format("must have {} columns", kColumns));
  }
  [[noreturn]] void fail(std::string_view value, std::string expected) const {
    throw InputError({name_, line_, "line", std::string(value), std::move(expected)});
  }
  std::string_view cell(std::size_t column) const { return cells_[column]; }
  bool begins_with(std::string_view start) const {
    return text_.substr(0, start.size() + 1) == std::string(start) + ',';
  }

  std::int64_t integer(std::size_t column, std::int64_t low, std::int64_t high) const {
    const std::string_view text = cells_[column];
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || value < low || value > high)
      fail(text, fmt::format("must be {}..{} in column {}", low, high, column + 1));
    return value;
  }
  std::optional<std::int64_t> time(std::size_t column) const {
    if (cells_[column].empty()) return std::nullopt;
    return integer(column, 0, std::int64_t{1} << 62);
  }
  unsigned bits(std::size_t column, const std::vector<std::string_view>& all) const {
    unsigned bits = 0;
    std::string_view left = cells_[column];
    while (!left.empty()) {
      const std::string_view word = left.substr(0, left.find('+'));
      left.remove_prefix(std::min(left.size(), word.size() + 1));
      const auto found = std::find(all.begin(), all.end(), word);
      if (found == all.end()) fail(word, fmt::format("is an unknown word in column {}", column + 1));
      bits |= 1u << (found - all.begin());
    }
    return bits;
  }
  bool yes(std::size_t column) const {
    if (cells_[column] != "yes" && cells_[column] != "no")
      fail(cells_[column], fmt::format("must be yes or no in column {}", column + 1));
    return cells_[column] == "yes";
  }
  NodeId node(std::size_t column, const schedules::model::Cluster& cluster) const {
    if (cells_[column].empty()) return kNoNode;
    const auto node = cluster.find_node(cells_[column]);
    if (!node) fail(cells_[column], fmt::format("must be a node of the cluster in column {}", column + 1));
    return *node;
  }

 private:
  std::string name_;
  int line_;
  std::string_view text_;
  std::vector<std::string_view> cells_;
};

}  // namespace

std::string campaign_csv(const CampaignFile& campaign, const CampaignBus& bus, std::span<const FaultResult> results) {
  const Words& words = bus.words();
  std::string out = header(words);
  out += '\n';
  for (const FaultResult& result : results)
    for (std::size_t v = 0; v < campaign.variants.size(); ++v) {
      const FaultOutcome& o = result.outcomes[v];
      out += fmt::format("{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n",
                         drawn_text(result, campaign.variants[v], bus), o.activated ? "yes" : "no",
                         o.starts_without ? "yes" : "no", names_of(o.seen_by_others, words.checks),
                         names_of(o.seen_by_itself, words.checks), names_of(o.harms, words.harms),
                         node_name(o.harmed, bus.cluster()), node_name(o.sender, bus.cluster()), o.frame_id,
                         o.still_out, or_nothing(o.detected_after), or_nothing(o.passive_after),
                         or_nothing(o.halt_after), or_nothing(o.harmed_after), or_nothing(o.reintegrated_after));
    }
  return out;
}

std::vector<FaultResult> read_campaign_csv(const CampaignFile& campaign, const CampaignBus& bus,
                                           const std::string& text, const std::string& name) {
  const Words& words = bus.words();
  std::vector<FaultResult> results;
  int number_of_line = 0;
  std::string_view left = text;
  while (!left.empty()) {
    const std::string_view row = left.substr(0, left.find('\n'));
    left.remove_prefix(std::min(left.size(), row.size() + 1));
    if (++number_of_line == 1) {
      if (row != header(words))
        throw InputError({name, 1, "header", std::string(row), "must be the first line of a campaign's results"});
      continue;
    }
    const Line line(row, name, number_of_line);
    const auto index = static_cast<std::uint32_t>(line.integer(0, 0, campaign.faults - 1));
    if (results.empty() || results.back().outcomes.size() == campaign.variants.size())
      results.push_back({index, bus.draw(index), {}});
    FaultResult& result = results.back();
    if (result.index != index || !line.begins_with(drawn_text(result, campaign.variants[result.outcomes.size()], bus)))
      line.fail(row, "is of another campaign, or out of order");
    FaultOutcome o;
    o.activated = line.yes(7);
    o.starts_without = line.yes(8);
    o.seen_by_others = static_cast<std::uint16_t>(line.bits(9, words.checks));
    o.seen_by_itself = static_cast<std::uint16_t>(line.bits(10, words.checks));
    o.harms = static_cast<std::uint8_t>(line.bits(11, words.harms));
    o.harmed = line.node(12, bus.cluster());
    o.sender = line.node(13, bus.cluster());
    o.frame_id = static_cast<int>(line.integer(14, 0, 2047));
    o.still_out = static_cast<std::int16_t>(line.integer(15, 0, 255));
    o.detected_after = line.time(16);
    o.passive_after = line.time(17);
    o.halt_after = line.time(18);
    o.harmed_after = line.time(19);
    o.reintegrated_after = line.time(20);
    result.outcomes.push_back(o);
  }
  if (!results.empty() && results.back().outcomes.size() != campaign.variants.size())
    throw InputError({name, number_of_line, "results", "", "end in the middle of a fault's variants"});
  return results;
}

namespace {

// Returns the missing shards: "2/3, 3/3". Empty if the given ones are not shards of one number of parts.
std::string missing_shards(const CampaignFile& campaign, const std::vector<std::vector<FaultResult>>& shards) {
  std::uint32_t count = 0;
  std::set<std::uint32_t> parts;
  for (const auto& shard : shards) {
    if (shard.size() < 2) return "";
    const std::uint32_t first = shard[0].index, step = shard[1].index - first;
    const auto faults = static_cast<std::uint32_t>(campaign.faults);
    const bool whole =
        first < step && step <= faults && (count == 0 || step == count) && shard.back().index >= faults - step;
    for (std::size_t i = 0; i < shard.size(); ++i)
      if (!whole || shard[i].index != first + i * step) return "";
    count = step;
    parts.insert(first);
  }
  std::string missing;
  for (std::uint32_t part = 0; part < count; ++part)
    if (!parts.contains(part)) missing += fmt::format("{}{}/{}", missing.empty() ? "" : ", ", part + 1, count);
  return missing;
}

}  // namespace

std::vector<FaultResult> merged(const CampaignFile& campaign, std::vector<std::vector<FaultResult>> shards) {
  if (const std::string missing = missing_shards(campaign, shards); !missing.empty())
    throw InputError(
        {campaign.file, 0, "--merge", "", fmt::format("lacks shard {}: give the folders of all shards", missing)});
  std::vector<FaultResult> all;
  for (auto& shard : shards) std::move(shard.begin(), shard.end(), std::back_inserter(all));
  std::sort(all.begin(), all.end(), [](const FaultResult& a, const FaultResult& b) { return a.index < b.index; });
  for (std::size_t i = 0; i < all.size() || i < static_cast<std::size_t>(campaign.faults); ++i) {
    if (i < all.size() && all[i].index == i) continue;
    const bool twice = i < all.size() && all[i].index < i;
    throw InputError({campaign.file, 0, "--merge", fmt::to_string(twice ? all[i].index : i),
                      twice ? "is a repeated fault" : "is a missing fault"});
  }
  return all;
}

}  // namespace ttf::experiments::campaign
