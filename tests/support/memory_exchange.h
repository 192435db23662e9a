// The exchange (bus/ports/exchange.h) between threads of one process: the simplest lawful implementation.
//
//   MemoryExchange hub;
//   auto a = hub.join(NodeId{0}), b = hub.join(NodeId{1});    // all before the first send
//   std::thread([&] { a->send(...); });  b->receive();
//   hub.leave(NodeId{0});                                     // as a supervisor announces the dead
//
// An endpoint belongs to one thread at a time, and may outlive the hub. Its queue has unlimited room: send()
// never blocks. Tests never hang without a partner: receive() then throws.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "bus/ports/exchange.h"
#include "core/check.h"
#include "core/ids.h"

namespace ttf::test {

class MemoryExchange {
 public:
  // Adds a member. Destroying an endpoint is not leaving: all its messages are received, and only leave()
  // announces it.
  std::unique_ptr<bus::ports::Exchange> join(NodeId node) { return std::make_unique<Endpoint>(hub_, node); }

  // Announces to all, after `node`'s messages, that it is gone. From then on it is cut off: its messages
  // reach no member, and its receive() throws, also when already asleep.
  void leave(NodeId node) { hub_->leave(node); }

 private:
  using Bytes = std::shared_ptr<const std::vector<std::byte>>;  // one copy for all hearers

  struct Item {
    NodeId from{};
    Bytes bytes;  // empty: it is gone
  };
  struct Member {
    std::deque<Item> waiting;
    std::condition_variable something;
    bool gone = false;
  };

  struct Hub {
    std::mutex mutex;
    bool begun = false;  // guarded by mutex, as are all below
    std::map<NodeId, Member> members;

    void join(NodeId node) {
      const std::scoped_lock lock(mutex);
      TTF_CHECK(!begun, "node {} joins after somebody has sent or left", index_of(node));
      TTF_CHECK(members.try_emplace(node).second, "node {} joins twice", index_of(node));
    }
    void leave(NodeId node) {
      const std::scoped_lock lock(mutex);
      Member& member = members.at(node);
      if (std::exchange(member.gone, true)) return;
      report_to_others({node, nullptr});
      for (auto& other : members) other.second.something.notify_one();  // also members that have no partner left
    }
    void send(NodeId from, std::span<const std::byte> message) {
      auto bytes = std::make_shared<const std::vector<std::byte>>(message.begin(), message.end());
      const std::scoped_lock lock(mutex);
      if (!members.at(from).gone) report_to_others({from, std::move(bytes)});
    }
    Item receive(NodeId node) {
      std::unique_lock lock(mutex);
      Member& member = members.at(node);
      member.something.wait(lock, [&] { return member.gone || !member.waiting.empty() || alone(node); });
      if (member.gone) throw std::runtime_error(name(node) + " has been removed by the supervisor");
      if (member.waiting.empty()) throw std::runtime_error(name(node) + ": all other members are gone");
      Item item = std::move(member.waiting.front());
      member.waiting.pop_front();
      return item;
    }

   private:
    static std::string name(NodeId node) { return "exchange: node " + std::to_string(index_of(node)); }
    bool alone(NodeId node) const {
      return std::all_of(members.begin(), members.end(),
                         [node](const auto& entry) { return entry.first == node || entry.second.gone; });
    }
    void report_to_others(const Item& item) {
      begun = true;
      for (auto& [node, member] : members) {
        if (node == item.from) continue;
        member.waiting.push_back(item);
        member.something.notify_one();
      }
    }
  };

  class Endpoint final : public bus::ports::Exchange {
   public:
    Endpoint(std::shared_ptr<Hub> hub, NodeId node) : hub_(std::move(hub)), node_(node) { hub_->join(node); }
    void send(std::span<const std::byte> message) override { hub_->send(node_, message); }
    Received receive() override {
      last_ = hub_->receive(node_);
      if (last_.bytes == nullptr) return {last_.from, true, {}};
      return {last_.from, false, *last_.bytes};
    }

   private:
    std::shared_ptr<Hub> hub_;
    NodeId node_;
    Item last_;  // the last message, valid until the next call
  };

  std::shared_ptr<Hub> hub_ = std::make_shared<Hub>();
};

}  // namespace ttf::test
