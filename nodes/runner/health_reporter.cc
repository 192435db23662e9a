#include "nodes/runner/health_reporter.h"

#include <cerrno>
#include <utility>

#include "core/check.h"

namespace ttf::nodes::runner {

HealthReporter::HealthReporter(
    std::function<void(const ttf::nodes::runner::Health&, ttf::bus::ports::MachineTime)> report)
    : report_(std::move(report)) {
  TTF_CHECK(sem_init(&called_, 0, 0) == 0);
  thread_ = std::thread([this] { run(); });
}

HealthReporter::~HealthReporter() {
  close();
  sem_destroy(&called_);
}

bool HealthReporter::hand_over(const Health& health) {
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

void HealthReporter::run() {
  for (bool last = false; !last;) {
    while (sem_wait(&called_) != 0) TTF_CHECK(errno == EINTR, "errno {}", errno);
    last = closing_.load(std::memory_order_acquire);
    if (!waits_.load(std::memory_order_acquire)) continue;
    report_(health_, at_);
    waits_.store(false, std::memory_order_release);
  }
}

void HealthReporter::close() {
  if (!thread_.joinable()) return;
  closing_.store(true, std::memory_order_release);
  sem_post(&called_);
  thread_.join();
}

}  // namespace ttf::nodes::runner
