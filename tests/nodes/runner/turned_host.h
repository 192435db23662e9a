// A host whose clock the test turns. Time passes only while all its processes wait; then it leaps to the
// first wake-up. The test sets the lateness. Each process has its own thread, as a runner's loop needs, but
// only one runs at a time and hands over to the next. The scheduler has no influence: the same drive gives
// the same records on any machine, however busy.
//
//   TurnedHost host;
//   TurnedHost::Process &a = host.process(), &b = host.process(stopped(from, until));
//   host.at(from, [&] { medium.send(...); });
//   host.run({[&] { run_a(a); }, [&] { run_b(b); }});
//
// A single process may run on the test's own thread, without run().
#pragma once

#include <poll.h>

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "core/check.h"
#include "core/random.h"
#include "nodes/runner/machine_clock.h"

namespace ttf::nodes::runner {

// When a process wakes up that should at an instant: then or later.
using Wakes = std::function<bus::ports::MachineTime(bus::ports::MachineTime)>;

inline Wakes late_by(Duration by) {
  return [by](bus::ports::MachineTime due) { return due + by; };
}
// It stands still in between.
inline Wakes stopped(bus::ports::MachineTime from, bus::ports::MachineTime until) {
  return [=](bus::ports::MachineTime due) { return due >= from ? std::max(due, until) : due; };
}
// Up to `most` late, by a separate random stream.
inline Wakes drawn_late(Duration most, std::uint16_t process) {
  return [most, stream = RandomStream({1, 0, Purpose::kTest, process, 0})](bus::ports::MachineTime due) mutable {
    return due + Duration{stream.integer(0, most.ns)};
  };
}

class TurnedHost {
 public:
  class Process;
  // The least duration of a wait, even for a past instant.
  static constexpr Duration kShortest = Duration::microseconds(10);

  explicit TurnedHost(bus::ports::MachineTime begin = {1'000'000'000}) : now_(begin) {}

  bus::ports::MachineTime now() const { return now_; }
  // While no process runs.
  void turn_to(bus::ports::MachineTime later) { now_ = std::max(now_, later); }
  inline Process& process(Wakes wakes = late_by({}));
  // Adds an event before any process wakes up at that instant. It must not wait.
  void at(bus::ports::MachineTime when, std::function<void()> happens) { events_.emplace(when, std::move(happens)); }
  // Runs the processes, in the order in which they were made, until all have ended.
  inline void run(const std::vector<std::function<void()>>& bodies);

 private:
  inline void wait(Process& self, bus::ports::MachineTime until, bool watches);
  inline void hand_over();
  inline Process* first_to_wake();
  inline void look_for_arrivals();

  std::mutex mutex_;  // for handing over; all other members belong to the running process
  std::condition_variable ended_;
  bus::ports::MachineTime now_;
  Process* runs_ = nullptr;
  std::multimap<bus::ports::MachineTime, std::function<void()>> events_;
  std::vector<std::unique_ptr<Process>> processes_;
};

class TurnedHost::Process final : public MachineClock {
 public:
  Process(TurnedHost& host, Wakes wakes) : host_(host), wakes_(std::move(wakes)) {}

  bus::ports::MachineTime now() const override { return host_.now(); }
  void watch(int descriptor) override {
    if (descriptor >= 0) watched_.push_back({descriptor, POLLIN, 0});
  }
  void clear() override { watched_.clear(); }
  void wait_until(bus::ports::MachineTime until) override {
    waits_for_nothing += until <= host_.now();
    host_.wait(*this, until, true);
  }
  void sleep(Duration lasts) override {
    sleeps.push_back(lasts);
    host_.wait(*this, host_.now() + lasts, false);
  }
  bool readable(int descriptor) const override {
    pollfd one{descriptor, POLLIN, 0};
    return descriptor >= 0 && poll(&one, 1, 0) > 0;
  }
  recording::records::BinnedDurations floor() const override { return stated_floor; }

  recording::records::BinnedDurations stated_floor;  // stated lateness of the plain thread beside it
  std::vector<Duration> sleeps;                      // so far
  int waits_for_nothing = 0;                         // so far: for an instant that was over

 private:
  friend class TurnedHost;
  TurnedHost& host_;
  Wakes wakes_;
  std::vector<pollfd> watched_;
  std::condition_variable turn_;
  std::optional<bus::ports::MachineTime> wakes_up_;  // while it waits
  bool watches_ = false;                             // likewise, before an arrival
};

TurnedHost::Process& TurnedHost::process(Wakes wakes) {
  processes_.push_back(std::make_unique<Process>(*this, std::move(wakes)));
  return *processes_.back();
}

void TurnedHost::run(const std::vector<std::function<void()>>& bodies) {
  TTF_CHECK(bodies.size() == processes_.size(), "{} for {} processes", bodies.size(), processes_.size());
  std::vector<std::thread> threads;
  for (auto& process : processes_) process->wakes_up_ = now_;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    threads.emplace_back([this, &body = bodies[i], self = processes_[i].get()] {
      std::unique_lock lock(mutex_);
      self->turn_.wait(lock, [&] { return runs_ == self; });
      lock.unlock();
      body();
      lock.lock();
      hand_over();
    });
  std::unique_lock lock(mutex_);
  hand_over();
  ended_.wait(lock, [this] { return runs_ == nullptr; });
  lock.unlock();
  for (std::thread& thread : threads) thread.join();
}

void TurnedHost::wait(Process& self, bus::ports::MachineTime until, bool watches) {
  std::unique_lock lock(mutex_);
  self.wakes_up_ = self.wakes_(until > now_ ? until : now_ + kShortest);
  self.watches_ = watches;
  hand_over();
  self.turn_.wait(lock, [&] { return runs_ == &self; });
}

void TurnedHost::hand_over() {
  runs_ = first_to_wake();
  if (runs_ == nullptr) return ended_.notify_all();
  runs_->wakes_up_.reset();
  runs_->turn_.notify_all();
}

TurnedHost::Process* TurnedHost::first_to_wake() {
  while (true) {
    look_for_arrivals();
    Process* first = nullptr;
    for (const auto& process : processes_)
      if (process->wakes_up_ && (first == nullptr || *process->wakes_up_ < *first->wakes_up_)) first = process.get();
    if (first == nullptr) return nullptr;
    const auto event = events_.begin();
    if (event == events_.end() || event->first > *first->wakes_up_) {
      now_ = std::max(now_, *first->wakes_up_);
      return first;
    }
    now_ = std::max(now_, event->first);
    event->second();
    events_.erase(event);
  }
}

void TurnedHost::look_for_arrivals() {
  for (const auto& process : processes_) {
    if (!process->wakes_up_ || !process->watches_ || process->watched_.empty()) continue;
    if (poll(process->watched_.data(), process->watched_.size(), 0) <= 0) continue;
    process->watches_ = false;
    process->wakes_up_ = std::min(*process->wakes_up_, process->wakes_(now_));
  }
}

}  // namespace ttf::nodes::runner
