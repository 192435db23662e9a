// Moves lists within a node: from a medium to the tasks that read them, and from a task to the media.
//
// A task's inputs are filled at its start, and its outputs leave at its end. The node registers a medium for
// each MediumId; the wiring has it only as a ListMedium. Nothing allocates or throws after construction.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "bus/cni/list_buffer.h"
#include "nodes/host/node_records.h"
#include "nodes/host/step.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::host {

// The lists of a medium, for the tasks of a node.
class ListMedium {
 public:
  virtual ~ListMedium() = default;
  virtual bus::cni::IncomingList& incoming(PduId pdu) = 0;  // always the same one
  virtual void send(PduId pdu, const bus::cni::ListView& list) = 0;
};

// A medium that this node is on.
struct Connection {
  schedules::model::MediumId id;
  std::unique_ptr<ListMedium> lists;
};

// A fragment that has arrived over a medium.
struct ListArrival {
  schedules::model::MediumId medium;
  PduId pdu{};
  bus::cni::ArrivalEffect effect{};
  std::uint32_t sequence = 0;
  std::optional<std::uint32_t> torn;  // the incomplete list that it displaced
};

class Wiring {
 public:
  // `cluster`, `time` and `records` outlive this. A task with a port to a medium outside `media` stops the program.
  // `steps`: by task.
  Wiring(const schedules::model::Cluster& cluster, const schedules::model::Node& node,
         std::span<const std::shared_ptr<Step>> steps, std::vector<Connection> media, const NodeTime& time,
         NodeRecords& records);

  // Returns the inputs of the task at its start `at`.
  std::span<Input> read(std::size_t task, const recording::records::Stamp& at);
  // Records the inputs that the task could not use.
  void report_discarded(std::size_t task, const recording::records::Stamp& at);
  std::span<Output> outputs(std::size_t task) { return tasks_[task].outputs; }
  // Sends the lists that the task has written; they become visible at its end `at`.
  void write(std::size_t task, const recording::records::Stamp& at);

  // Returns the tasks that the arrival activates.
  std::span<const std::size_t> arrived(const ListArrival& arrival, Microticks at);

 private:
  struct Source {
    schedules::model::MediumId medium;
    bus::cni::IncomingList& list;
    std::optional<std::uint32_t> unread;  // complete, not read yet
    bool newest_counts = false;           // a list that is overwritten unread is no loss
  };
  struct Drain {
    schedules::model::MediumId medium;
    ListMedium& lists;
  };
  struct TaskPorts {
    std::vector<Input> inputs;
    std::vector<Source> sources;  // by input
    std::vector<Output> outputs;
    std::vector<Drain> drains;  // by output
  };
  // A list with the tasks that read it, in their order.
  struct Route {
    schedules::model::MediumId medium;
    PduId pdu{};
    struct Reader {
      std::size_t task = 0;
      std::size_t input = 0;
    };
    std::vector<Reader> readers;
    std::vector<std::size_t> sets_off;  // the tasks that it activates
  };
  ListMedium* find(schedules::model::MediumId medium) const;
  Route* find_route(schedules::model::MediumId medium, PduId pdu);
  void connect(const schedules::model::Cluster& cluster, const schedules::model::Task& task, const Step& step);

  std::vector<Connection> media_;
  const NodeTime& time_;
  NodeRecords& records_;
  std::vector<TaskPorts> tasks_;
  std::vector<Route> routes_;
};

}  // namespace ttf::nodes::host
