#include "recording/log/behind.h"

#include <chrono>
#include <cstring>

namespace ttf::recording::log {
namespace {

constexpr std::size_t kRoom = 4 << 20;  // bytes: some seconds of a busy node
constexpr std::chrono::milliseconds kPause{20};

struct Head {
  std::uint64_t log_time = 0, publish_time = 0;
  std::uint32_t size = 0;
  std::uint8_t kind = 0;
};

}  // namespace

LogBehind::LogBehind(std::function<void(const ttf::recording::log::LogMessage&)> write) : write_(std::move(write)) {
  for (std::string* buffer : {&filling_, &between_, &writing_}) buffer->reserve(kRoom);
  thread_ = std::thread([this] { run(); });
}

LogBehind::~LogBehind() { close(); }

void LogBehind::add(const LogMessage& message) {
  Head head;
  head.log_time = message.log_time;
  head.publish_time = message.publish_time;
  head.size = static_cast<std::uint32_t>(message.payload.size());
  head.kind = message.kind;
  char bytes[sizeof head];
  std::memcpy(bytes, &head, sizeof head);
  filling_.append(bytes, sizeof bytes);
  filling_.append(message.payload);
  if (full_.load(std::memory_order_acquire)) return;
  filling_.swap(between_);  // it is empty
  full_.store(true, std::memory_order_release);
}

// add() wakes no thread, since that takes time: the writer looks every kPause.
void LogBehind::run() {
  for (bool last = false; !last;) {
    {
      std::unique_lock lock(mutex_);
      wake_.wait_for(lock, kPause, [this] { return closing_; });
      last = closing_;
    }
    write_handed_over();
  }
}

void LogBehind::write_handed_over() {
  if (!full_.load(std::memory_order_acquire)) return;
  between_.swap(writing_);
  full_.store(false, std::memory_order_release);  // before writing, so that more can come meanwhile
  write_all(writing_);
}

void LogBehind::write_all(std::string& kept) {
  for (std::size_t at = 0; at < kept.size();) {
    Head head;
    std::memcpy(&head, kept.data() + at, sizeof head);
    at += sizeof head;
    write_({head.kind, head.log_time, head.publish_time, std::string_view(kept).substr(at, head.size)});
    at += head.size;
  }
  kept.clear();
}

void LogBehind::close() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_one();
  thread_.join();
  write_handed_over();
  write_all(filling_);
}

}  // namespace ttf::recording::log
