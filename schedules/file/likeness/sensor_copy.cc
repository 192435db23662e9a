#include "schedules/file/likeness/sensor_copy.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "core/counted.h"
#include "schedules/analysis/can_load.h"
#include "schedules/file/likeness/layouts.h"
#include "schedules/left_out/tasks.h"
#include "schedules/model/limits.h"
#include "schedules/model/ports.h"

namespace ttf::schedules::file::likeness {
namespace {

constexpr std::uint32_t kIdentifiers = 2048;  // of 11 bits
constexpr std::int64_t kMostRaw = 3'584;      // 256 fragments of 14 points, those of a laser's scan
constexpr std::int64_t kMostObjects = 255;    // counted by a byte of the list's header
constexpr std::string_view kAllParts = "a file has all parts of a sensor, with its device and host, or none of them";

class Copier {
 public:
  Copier(const Unfinished& schedule, const SensorCopy& copy)
      : cluster_(schedule.cluster), left_(schedule), copy_(copy), old_(cluster_.sensor(copy.from)),
        device_(static_cast<NodeId>(cluster_.nodes.size())), host_(static_cast<NodeId>(cluster_.nodes.size() + 1)) {
    if (copy.kind != old_.kind) known_ = known_layouts(copy.kind);
  }

  std::optional<Refusal> refusal() const {
    const std::string_view kind = row_of(old_.kind).word;
    if (!row_of(old_.kind).observes) {
      const std::string others = originals(cluster_, copy_.name);
      return like(fmt::format("must be a sensor of objects{}: no task would take the lists of a second {}",
                              others.empty() ? "" : " (" + others + ")", kind));
    }
    if (copy_.kind != old_.kind && !known_) {
      std::vector<std::string_view> words{kind};
      for (const auto& [word, known] : known_kinds())
        if (known != old_.kind) words.push_back(word);
      return Refusal{"kind",
                     fmt::format("must be one of {}: the layouts of others are not known", fmt::join(words, ", "))};
    }
    if (old_.device == old_.host || !is_alone(old_.device) || !is_alone(old_.host))
      return like(
          fmt::format("must be a sensor whose device and host have no tasks of other sensors; {} is none", old_.name));
    const auto& [nodes, pdus, cans] = std::tie(cluster_.nodes, cluster_.pdus, cluster_.can_buses);
    const auto lists =
        std::count_if(pdus.begin(), pdus.end(), [&](const auto& pdu) { return pdu.sensor == copy_.from; });
    const auto copies = std::count_if(cans.begin(), cans.end(), [&](const auto& can) { return is_copied(can); });
    if (nodes.size() + 2 > model::kMostNamed || pdus.size() + static_cast<std::size_t>(lists) > model::kMostNamed ||
        cans.size() + static_cast<std::size_t>(copies) > model::kMostCans)
      return like(fmt::format("needs room for its copies: a cluster has at most {} nodes, {} PDUs and {} CANs",
                              model::kMostNamed, model::kMostNamed, model::kMostCans));
    for (const model::CanBus& bus : cans)
      if (!is_copied(bus) && bus.messages.size() + own_messages(bus) > kIdentifiers)
        return like(fmt::format("needs free identifiers on {}, which has {} messages", bus.name, bus.messages.size()));
    for (const Part& part : parts())
      if (part.is_taken) return like(fmt::format("needs a {}, a name that is taken; {}", part.words, kAllParts));
    for (std::size_t n = 0; n < nodes.size(); ++n)
      if (const std::size_t more = tasks_of_its_own(n).size(); nodes[n].tasks.size() + more > model::kMostTasks)
        return like(fmt::format("needs {} of {}, which has {} of at most {}", counted(more, "more task"), nodes[n].name,
                                nodes[n].tasks.size(), model::kMostTasks));
    if (auto refused = too_many()) return refused;
    if (auto refused = too_long()) return refused;
    return no_key_slot();
  }

  // A node, PDU, CAN or task of the copy's own.
  struct Part {
    std::string path, words;  // "nodes.rear_pre", "node rear_pre"
    bool is_taken = false;
  };
  std::vector<Part> parts() const {
    std::vector<Part> found;
    const auto add = [&](std::string_view section, std::string_view word, const std::string& original,
                         const auto& others) {
      const std::string name = renamed(original);
      const bool is_taken =
          std::any_of(others.begin(), others.end(), [&](const auto& one) { return one.name == name; });
      found.push_back({fmt::format("{}.{}", section, name), fmt::format("{} {}", word, name), is_taken});
    };
    for (const NodeId node : {old_.device, old_.host}) add("nodes", "node", cluster_.node(node).name, cluster_.nodes);
    for (const model::PduLayout& pdu : cluster_.pdus)
      if (pdu.sensor == copy_.from) add("pdus", "PDU", pdu.name, cluster_.pdus);
    for (const model::CanBus& bus : cluster_.can_buses)
      if (is_copied(bus)) add("can", "CAN", bus.name, cluster_.can_buses);
    for (std::size_t n = 0; n < cluster_.nodes.size(); ++n)
      for (const model::Task* copied : tasks_of_its_own(n))
        add(fmt::format("nodes.{}.tasks", cluster_.nodes[n].name), "task", copied->name, cluster_.nodes[n].tasks);
    return found;
  }

  void copy(SensorId made) {
    made_ = made;
    copy_lists();
    copy_cans();
    copy_node(old_.device);
    copy_node(old_.host);
    model::Sensor& sensor = cluster_.sensors[index_of(made)];
    sensor.device = device_;
    sensor.host = host_;
    copy_slots(sensor.scheduled);
    key_slot();
    for (std::size_t n = 0; n < index_of(device_); ++n)
      if (n != index_of(old_.device) && n != index_of(old_.host)) extend_reader(n);
  }

 private:
  static Refusal like(std::string expected) { return {"like", std::move(expected)}; }

  bool own(PduId pdu) const { return cluster_.pdu(pdu).sensor == copy_.from; }
  bool all_own(const std::vector<model::PortBinding>& bindings) const {
    return std::all_of(bindings.begin(), bindings.end(), [&](const auto& one) { return own(one.pdu); });
  }
  // The tasks beside device and host that have lists of this sensor alone: each is copied.
  std::vector<const model::Task*> tasks_of_its_own(std::size_t node) const {
    std::vector<const model::Task*> found;
    if (node == index_of(old_.device) || node == index_of(old_.host)) return found;
    for (const model::Task& task : cluster_.nodes[node].tasks)
      if (!task.reads.empty() && all_own(task.reads) && all_own(task.writes)) found.push_back(&task);
    return found;
  }
  // Whether all lists of the node's tasks, or of the CAN, are the sensor's.
  bool is_alone(NodeId id) const {
    const std::vector<model::Task>& tasks = cluster_.node(id).tasks;
    return !tasks.empty() && std::all_of(tasks.begin(), tasks.end(), [&](const model::Task& task) {
      return all_own(task.reads) && all_own(task.writes);
    });
  }
  bool is_alone(const model::CanBus& bus) const {
    return std::all_of(bus.messages.begin(), bus.messages.end(), [&](const auto& one) { return own(one.pdu); });
  }
  bool is_copied(const model::CanBus& bus) const { return !bus.messages.empty() && is_alone(bus); }
  std::size_t own_messages(const model::CanBus& bus) const {
    return static_cast<std::size_t>(
        std::count_if(bus.messages.begin(), bus.messages.end(), [&](const auto& one) { return own(one.pdu); }));
  }

  std::string renamed(const std::string& text) const {
    const std::size_t at = text.find(old_.name);
    return at == std::string::npos ? copy_.name + "_" + text
                                   : std::string(text).replace(at, old_.name.size(), copy_.name);
  }

  // Returns the key whose number a list cannot have, and the most that it can; none if all fit.
  std::optional<Refusal> too_many() const {
    for (std::size_t p = 0; p < cluster_.pdus.size(); ++p) {
      if (!own(static_cast<PduId>(p))) continue;
      const bool raw = writes(old_.device, static_cast<PduId>(p));
      const std::int64_t most = most_elements(layout_like(p, raw));
      if (const auto& wanted = raw ? copy_.raw : copy_.objects; wanted && *wanted > most)
        return Refusal{raw ? "raw" : "objects",
                       fmt::format("must be at most {}: the list's header holds no more", most)};
    }
    return std::nullopt;
  }

  // Another kind's raw data may need a CAN with a flexible data rate.
  std::optional<Refusal> too_long() const {
    if (!known_) return std::nullopt;
    for (const model::CanBus& bus : cluster_.can_buses)
      for (const model::CanMessage& message : bus.messages) {
        if (!own(message.pdu)) continue;
        const int bytes = made_layout(index_of(message.pdu)).fragment_bytes;
        if (!analysis::can_data_length(bus.flexible_data_rate, bytes))
          return Refusal{"kind", fmt::format("must be a kind whose frames fit {}: they have {} bytes, and it takes at "
                                             "most {}",
                                             bus.name, bytes, bus.flexible_data_rate ? 64 : 8)};
      }
    return std::nullopt;
  }

  model::PduLayout layout_like(std::size_t pdu, bool raw) const {
    if (!known_) return cluster_.pdus[pdu];
    return raw ? known_->raw : known_->objects;
  }

  // With the copy's own number of elements.
  model::PduLayout made_layout(std::size_t pdu) const {
    const bool raw = writes(old_.device, static_cast<PduId>(pdu));
    model::PduLayout made = layout_like(pdu, raw);
    if (const auto& most = raw ? copy_.raw : copy_.objects) made.max_elements = *most;
    return made;
  }

  // The header counts elements and numbers fragments.
  static std::int64_t most_elements(const model::PduLayout& layout) {
    const auto values = [&](std::string_view name) {
      const auto found = find_signal(layout.header, name);
      return std::int64_t{1} << (found ? layout.header[*found].bits : 0);
    };
    const std::int64_t fragments = std::min<std::int64_t>(model::kMostFragments, values("fragment"));
    return std::min(values("count") - 1, fragments * layout.elements_per_fragment);
  }

  // The host's key slot is its own in every cycle.
  std::optional<Refusal> no_key_slot() const {
    const int slots = cluster_.flexray.gNumberOfStaticSlots;
    if (!cluster_.node(old_.host).flexray || first_free_slot() <= slots) return std::nullopt;
    std::set<PduId> lists;
    for (const model::FrameSlot& frame : cluster_.frames)
      if (frame.pdu != kNoPdu && own(frame.pdu)) lists.insert(frame.pdu);
    for (const left_out::List& list : left_.lists)
      if (own(list.pdu)) lists.insert(list.pdu);
    int needed = 1;
    for (const PduId list : lists) needed += made_layout(index_of(list)).max_fragments();
    return like(
        fmt::format("needs {} free static slots, one of them the key slot of {}: all {} of a cycle are taken "
                    "(flexray.gNumberOfStaticSlots)",
                    needed, renamed(cluster_.node(old_.host).name), slots));
  }

  int first_free_slot() const {
    std::set<int> taken;
    for (const model::FrameSlot& frame : cluster_.frames) taken.insert(frame.slot);
    for (const left_out::List& list : left_.lists)  // a list may stand in a key slot
      for (int f = 0; !list.at.instant && f < cluster_.pdu(list.pdu).max_fragments(); ++f) taken.insert(list.slot + f);
    int free = 1;
    while (taken.contains(free)) ++free;
    return free;
  }

  bool writes(NodeId node, PduId pdu) const {
    for (const model::Task& task : cluster_.node(node).tasks)
      for (const model::PortBinding& out : task.writes)
        if (out.pdu == pdu) return true;
    return false;
  }

  void copy_lists() {
    const std::size_t before = cluster_.pdus.size();
    new_pdus_.assign(before, kNoPdu);
    for (std::size_t p = 0; p < before; ++p) {
      if (!own(static_cast<PduId>(p))) continue;
      model::PduLayout made = made_layout(p);
      made.name = renamed(cluster_.pdus[p].name);
      made.sensor = made_;
      made.line = copy_.line;
      new_pdus_[p] = static_cast<PduId>(cluster_.pdus.size());
      cluster_.pdus.push_back(std::move(made));
    }
  }

  NodeId new_node(NodeId node) const { return node == old_.device ? device_ : node == old_.host ? host_ : node; }

  model::CanMessage rebound(model::CanMessage message) const {
    message.pdu = new_pdus_[index_of(message.pdu)];
    message.sender = new_node(message.sender);
    message.line = copy_.line;
    return message;
  }

  void copy_cans() {
    const std::size_t before = cluster_.can_buses.size();
    for (std::size_t c = 0; c < before; ++c) {
      new_cans_.push_back(c);
      if (!is_copied(cluster_.can_buses[c])) {
        share_can(c);
        continue;
      }
      model::CanBus made = cluster_.can_buses[c];
      made.name = renamed(made.name);
      made.line = copy_.line;
      for (model::CanMessage& message : made.messages) message = rebound(message);
      new_cans_[c] = cluster_.can_buses.size();
      left_.shortest_periods.emplace_back(made.messages.size(), true);
      cluster_.can_buses.push_back(std::move(made));
    }
  }

  // The copy's lists have the next free identifiers behind those of the other sensor.
  void share_can(std::size_t can) {
    std::vector<model::CanMessage>& messages = cluster_.can_buses[can].messages;
    for (const model::CanMessage& message : std::vector<model::CanMessage>(messages)) {
      if (!own(message.pdu)) continue;
      model::CanMessage made = rebound(message);
      while (std::any_of(messages.begin(), messages.end(),
                         [&](const auto& other) { return other.identifier == made.identifier; }))
        made.identifier = (made.identifier + 1) % kIdentifiers;
      messages.push_back(made);
      left_.shortest_periods[can].push_back(true);
    }
  }

  model::PortBinding rebound(model::PortBinding binding) const {
    binding.pdu = new_pdus_[index_of(binding.pdu)];
    if (binding.medium.is_can()) binding.medium = model::MediumId::can(new_cans_[binding.medium.can_index()]);
    binding.line = copy_.line;
    return binding;
  }

  void add_task(std::size_t node, model::Task task, left_out::TaskParts left) {
    for (model::PortBinding& in : task.reads) in = rebound(in);
    for (model::PortBinding& out : task.writes) out = rebound(out);
    if (task.activation.kind == model::ActivationKind::kSensor) task.activation.sensor = made_;
    task.line = left.line = copy_.line;
    left.copied = {made_, copy_.from};
    left.at.instant |= left_out::by_time(task);
    left.deadline = true;
    cluster_.nodes[node].tasks.push_back(std::move(task));
    left_.tasks[node].push_back(left);
  }

  void copy_node(NodeId id) {
    const std::size_t made = cluster_.nodes.size();
    cluster_.nodes.push_back(cluster_.node(id));
    cluster_.nodes[made].name = renamed(cluster_.node(id).name);
    cluster_.nodes[made].line = copy_.line;
    cluster_.nodes[made].tasks.clear();
    left_.tasks.emplace_back();
    lines_like(fmt::format("nodes.{}.", cluster_.node(id).name), fmt::format("nodes.{}.", cluster_.nodes[made].name));
    for (std::size_t t = 0; t < cluster_.node(id).tasks.size(); ++t) {
      model::Task task = cluster_.node(id).tasks[t];
      if (known_)
        task.step = fmt::format("{}_{}", row_of(copy_.kind).word, id == old_.device ? "emulator" : "preprocessing");
      if (id == old_.host && copy_.preprocessing) {
        task.worst_case = *copy_.preprocessing;
        task.best_case = std::min(task.best_case, task.worst_case);
      }
      add_task(made, std::move(task), left_.tasks[index_of(id)][t]);
    }
  }

  void copy_slots(bool scheduled) {
    std::set<PduId> done;
    const auto add = [&](left_out::List list) {
      if (!own(list.pdu) || !done.insert(list.pdu).second) return;
      list.pdu = new_pdus_[index_of(list.pdu)];
      list.sender = new_node(list.sender);
      list.at.instant = true;
      list.anywhere = !scheduled;
      list.line = copy_.line;
      list.copied = {made_, copy_.from};
      left_.lists.push_back(list);
    };
    for (const left_out::List& list : std::vector<left_out::List>(left_.lists)) add(list);
    for (const model::FrameSlot& frame : std::vector<model::FrameSlot>(cluster_.frames))
      if (frame.pdu != kNoPdu)
        add({frame.pdu, frame.sender, frame.channels, 0, frame.repetition, 1, {true, false}, copy_.line});
  }

  void key_slot() {
    if (!cluster_.node(host_).flexray) return;
    const int free = first_free_slot();
    model::NodeParameters& parameters = *cluster_.nodes[index_of(host_)].flexray;
    parameters.pKeySlotId = free;
    parameters.pKeySlotUsedForStartup = parameters.pKeySlotUsedForSync = false;
    cluster_.frames.push_back({free, parameters.pChannels, 0, 1, host_, kNoPdu, 0, copy_.line});
  }

  void rename_port(std::string& port) const {
    if (port == old_.name) port = copy_.name;
    if (port == model::written_port(old_.name)) port = model::written_port(copy_.name);
  }

  // Mistakes of the copy stand where it is asked for.
  void lines_like(const std::string& original, const std::string& made) {
    std::map<std::string, int, std::less<>>& lines = cluster_.parameter_lines;
    for (auto at = lines.lower_bound(original); at != lines.end() && at->first.starts_with(original); ++at)
      lines[made + at->first.substr(original.size())] = copy_.line;
  }

  // A task with lists of this sensor alone is copied; another one reads the copy's, too.
  void extend_reader(std::size_t node) {
    for (std::size_t t = 0, count = cluster_.nodes[node].tasks.size(); t < count; ++t) {
      model::Task& task = cluster_.nodes[node].tasks[t];
      const std::vector<model::PortBinding> reads = task.reads;
      if (std::none_of(reads.begin(), reads.end(), [&](const auto& in) { return own(in.pdu); })) continue;
      if (all_own(reads) && all_own(task.writes)) {
        model::Task made = task;
        made.name = renamed(made.name);
        rename_port(made.activation.port);
        for (auto* bindings : {&made.reads, &made.writes})
          for (model::PortBinding& binding : *bindings) rename_port(binding.port);
        lines_like(fmt::format("nodes.{}.tasks.{}.", cluster_.nodes[node].name, task.name),
                   fmt::format("nodes.{}.tasks.{}.", cluster_.nodes[node].name, made.name));
        add_task(node, std::move(made), left_.tasks[node][t]);
        continue;
      }
      for (const model::PortBinding& in : reads) {
        if (!own(in.pdu)) continue;
        task.reads.push_back(rebound(in));
        task.reads.back().port = renamed(in.port);
      }
    }
  }

  model::Cluster& cluster_;
  Unfinished left_;
  const SensorCopy& copy_;
  const model::Sensor old_;
  NodeId device_, host_;               // the copies
  std::optional<KnownLayouts> known_;  // with another kind
  SensorId made_{};
  std::vector<PduId> new_pdus_;        // by the original's
  std::vector<std::size_t> new_cans_;  // by the original's
};

}  // namespace

void read_differences(YamlMap& map, SensorCopy& copy) {
  const auto number = [](auto value) { return value ? std::optional(static_cast<int>(*value)) : std::nullopt; };
  copy.raw = number(map.integer_if("raw", {1, kMostRaw}));
  copy.objects = number(map.integer_if("objects", {1, kMostObjects}));
  copy.preprocessing = map.duration_if("preprocessing", {Duration::microseconds(1), Duration::milliseconds(1'000)});
}

std::optional<Refusal> refusal(const Unfinished& schedule, const SensorCopy& copy) {
  return Copier(schedule, copy).refusal();
}

std::vector<std::string> parts_of(const Unfinished& schedule, const SensorCopy& copy) {
  std::vector<std::string> paths;
  for (const auto& part : Copier(schedule, copy).parts()) paths.push_back(part.path);
  return paths;
}

std::string refusal_of_part(const std::string& sensor) {
  return fmt::format("is a name of {}'s copied parts, which cannot be changed; {}", sensor, kAllParts);
}

std::string originals(const model::Cluster& cluster, std::string_view copy) {
  std::vector<std::string> names;
  for (const model::Sensor& sensor : cluster.sensors)
    if (row_of(sensor.kind).observes && sensor.name != copy) names.push_back(sensor.name);
  return joined(names, " or ");
}

void copy_nodes(const Unfinished& schedule, const SensorCopy& copy, SensorId made) {
  Copier(schedule, copy).copy(made);
}

}  // namespace ttf::schedules::file::likeness
