#include "nodes/runner/health_teller.h"

#include <cerrno>
#include <utility>

#include "core/check.h"

namespace ttf::nodes::runner {

HealthTeller::HealthTeller(std::function<void(const ttf::nodes::runner::Health&, ttf::bus::ports::MachineTime)> tell)
    : tell_(std::move(tell)) {
  TTF_CHECK(sem_init(&called_, 0, 0) == 0);
  thread_ = std::thread([this] { run(); });
}

HealthTeller::~HealthTeller() {
  close();
  sem_destroy(&called_);
}

bool HealthTeller::hand_over(const Health& health) {
  if (waits_.load(std::memory_order_acquire)) {
    ++left_out_;
    return false;
  }
  health_ = health;
  at_ = bus::ports::host_now();
  waits_.store(true, std::memory_order_release);
  sem_post(&called_);  // never waits
  return true;
}

void HealthTeller::run() {
  for (bool last = false; !last;) {
    while (sem_wait(&called_) != 0) TTF_CHECK(errno == EINTR, "errno {}", errno);
    last = closing_.load(std::memory_order_acquire);
    if (!waits_.load(std::memory_order_acquire)) continue;
    tell_(health_, at_);
    waits_.store(false, std::memory_order_release);
  }
}

void HealthTeller::close() {
  if (!thread_.joinable()) return;
  closing_.store(true, std::memory_order_release);
  sem_post(&called_);
  thread_.join();
}

}  // namespace ttf::nodes::runner
