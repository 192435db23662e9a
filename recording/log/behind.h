// Takes messages for a file off the hands of a thread that must not wait: they are kept in memory and written by a
// thread of its own some milliseconds later, in order.
//
// add() never waits for that thread, whatever it does, and were it preempted anywhere: what is added goes to a buffer
// of the adding thread's own, and with the next message from there to the writer, wherever that has emptied the place
// between the two: so the last burst before a silence stays there, and with it what a process that is killed then had
// not written. It allocates only while it keeps more than ever before: a disk that stands still costs memory, not
// time, and nothing is lost.
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
  // `write` is called from the other thread, and from close() when that has ended. It must not throw.
  explicit LogBehind(std::function<void(const ttf::recording::log::LogMessage&)> write);
  ~LogBehind();  // close()
  LogBehind(const LogBehind&) = delete;
  LogBehind& operator=(const LogBehind&) = delete;

  // From one thread.
  void add(const LogMessage& message);
  // Writes what is left; for that thread, and nothing may be added afterwards.
  void close();

 private:
  void run();
  void write_handed_over();
  void write_all(std::string& kept);  // and empties it

  const std::function<void(const ttf::recording::log::LogMessage&)> write_;
  std::string filling_;            // of the thread that adds
  std::string between_;            // of that one while it is empty, of the writer while it is full
  std::string writing_;            // of the writer
  std::atomic<bool> full_{false};  // between_
  std::mutex mutex_;               // of close() and the writer alone
  std::condition_variable wake_;
  bool closing_ = false;  // guarded by mutex_
  std::thread thread_;
};

}  // namespace ttf::recording::log
