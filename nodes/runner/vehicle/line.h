// The line between the processes of one host that need the vehicle's state: the actuator's node and the sensors'
// devices. It lies beside the bus, so it takes no slot and no identifier, and it is the same for every live medium.
//
// Each process has a Unix datagram socket, whose name follows from the session and its number. (The name is an abstract
// one, which ends with its process.) A message goes to each of the others by name; to one that is not there it is lost.
//
// Nothing allocates or waits after construction, except in catch_up(). One thread uses the line.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/time.h"
#include "nodes/host/step.h"
#include "nodes/runner/vehicle/record.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::runner::vehicle {

struct LinePlan {
  std::string session;
  std::size_t self = 0;
  std::vector<std::size_t> others;
  TrueTime start{};  // the drive's time at which the world begins
};

class Line {
 public:
  // `driven` outlives this. Throws std::runtime_error if the name is in use, or the system has no such socket.
  Line(const LinePlan& plan, sim::world::vehicle::Driven& driven);
  ~Line();
  Line(const Line&) = delete;
  Line& operator=(const Line&) = delete;

  // For a process that begins later: waits until the record is whole, at most for `patience`. Returns whether it is.
  bool catch_up(std::chrono::milliseconds patience);

  // Adds an actuation of this process to the record, and reports it to all others. It is in the drive's time.
  void report(const host::Actuation& actuation);
  // Takes in the messages that have come, and answers them.
  void take_in();
  int descriptor() const { return socket_; }  // readable when a message has come
  const Counts& counts() const { return record_.counts(); }

 private:
  struct Address {
    sockaddr_un name{};
    socklen_t size = 0;
  };
  static Address address_of(const std::string& session, std::size_t process);
  void send(std::span<const std::byte> message, const Address& to) const;
  void send_to_all(std::span<const std::byte> message) const;

  const TrueTime start_;
  std::vector<Address> others_;
  int socket_ = -1;
  Record record_;
  std::array<std::byte, Record::kLargest + 1> in_;  // a longer message is not cut to a valid one
};

// Returns the nodes whose processes need the vehicle's state: those of actuators and of sensors' devices.
std::vector<std::size_t> processes_of(const schedules::model::Cluster& cluster);

}  // namespace ttf::nodes::runner::vehicle
