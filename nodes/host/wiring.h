// Which list goes where in a node: from a medium to the tasks that read it, and from a task to the media.
//
// A task's inputs are filled when it starts, and its outputs leave when it ends. A medium is whatever the node has
// registered for a MediumId; the wiring knows nothing else of it. Nothing allocates or throws after construction.
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

// The lists of a medium, as the node's tasks see it.
class ListMedium {
 public:
  virtual ~ListMedium() = default;
  virtual bus::cni::IncomingList& incoming(PduId pdu) = 0;  // the same one always
  virtual void send(PduId pdu, const bus::cni::ListView& list) = 0;
};

// A medium that this node is on.
struct Connection {
  schedules::model::MediumId id;
  std::unique_ptr<ListMedium> lists;
};

// A fragment that has come over a medium.
struct ListArrival {
  schedules::model::MediumId medium;
  PduId pdu{};
  bus::cni::ArrivalEffect effect{};
  std::uint32_t sequence = 0;
  std::optional<std::uint32_t> torn;  // the list it displaced before that was complete
};

class Wiring {
 public:
  // `cluster`, `time` and `records` outlive this. A task that reads from a medium that is not among `media`, or writes to
  // one, must not run: it stops the program.
  Wiring(const schedules::model::Cluster& cluster, const schedules::model::Node& node, std::vector<Connection> media,
         const NodeTime& time, NodeRecords& records);

  // What the task reads at its start `at`.
  std::span<Input> read(std::size_t task, const recording::records::Stamp& at);
  // Those of its inputs that it could not use.
  void tell_discarded(std::size_t task, const recording::records::Stamp& at);
  std::span<Output> outputs(std::size_t task) { return tasks_[task].outputs; }
  // Its outputs, which it has written, become visible at its end `at`.
  void write(std::size_t task, const recording::records::Stamp& at);

  // The tasks that the arrival activates.
  std::span<const std::size_t> arrived(const ListArrival& arrival, Microticks at);

 private:
  struct Source {
    schedules::model::MediumId medium;
    bus::cni::IncomingList* list = nullptr;
    std::optional<std::uint32_t> unread;  // complete, not read yet
  };
  struct Drain {
    schedules::model::MediumId medium;
    ListMedium* lists = nullptr;
  };
  struct TaskPorts {
    std::vector<Input> inputs;
    std::vector<Source> sources;  // by input
    std::vector<Output> outputs;
    std::vector<Drain> drains;  // by output
  };
  // A list that tasks read, in their order.
  struct Route {
    schedules::model::MediumId medium;
    PduId pdu{};
    struct Reader {
      std::size_t task = 0;
      std::size_t input = 0;
    };
    std::vector<Reader> readers;
    std::vector<std::size_t> sets_off;  // tasks
  };
  ListMedium* find(schedules::model::MediumId medium) const;
  Route* find_route(schedules::model::MediumId medium, PduId pdu);
  void connect(const schedules::model::Cluster& cluster, const schedules::model::Task& task);

  std::vector<Connection> media_;
  const NodeTime& time_;
  NodeRecords& records_;
  std::vector<TaskPorts> tasks_;
  std::vector<Route> routes_;
};

}  // namespace ttf::nodes::host
