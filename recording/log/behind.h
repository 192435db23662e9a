// Takes messages for a file from a thread that must not wait. A thread of its own writes them, in order, some
// milliseconds later.
//
// add() never waits for the writer, even if the writer is preempted. It appends to a buffer of the adding
// thread. If the writer has emptied the place between the two threads, add() swaps it with that buffer. The
// last burst before a pause thus stays in the buffer until the next message; a killed process loses it. add()
// allocates only while the buffer is longer than ever before: a stalled disk costs memory, not time, and loses
// no message.
#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace ttf::recording::log {

struct LogMessage {
  std::uint8_t kind = 0;
  std::uint64_t log_time = 0, publish_time = 0;
  std::string_view payload;
};

class LogBehind {
 public:
  // `write` is called by the other thread, and by close() after that thread has ended. It must not throw.
  explicit LogBehind(std::function<void(const ttf::recording::log::LogMessage&)> write);
  ~LogBehind();  // close()
  LogBehind(const LogBehind&) = delete;
  LogBehind& operator=(const LogBehind&) = delete;

  // Call it from one thread only.
  void add(const LogMessage& message);
  // Writes the rest. Call it from the thread that adds; add() may not follow.
  void close();

 private:
  void run();
  void write_handed_over();
  void write_all(std::string& kept);  // and empties it

  const std::function<void(const ttf::recording::log::LogMessage&)> write_;
  std::string filling_;            // belongs to the thread that adds
  std::string between_;            // belongs to that thread while empty, to the writer while full
  std::string writing_;            // belongs to the writer
  std::atomic<bool> full_{false};  // whether between_ is full
  std::mutex mutex_;               // for close() and the writer only
  std::condition_variable wake_;
  bool closing_ = false;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace ttf::recording::log
