#include "experiments/sweep/engine.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <system_error>
#include <thread>
#include <vector>

#include "experiments/sweep/answers/answer.h"

namespace ttf::experiments::sweep {
namespace {

using results::Row;
using results::RowKey;

constexpr std::uint32_t kRowsAtATime = 8;           // for a worker
constexpr std::chrono::milliseconds kWritten{500};  // the longest wait until a result is written
constexpr std::chrono::milliseconds kTurn{2};       // between two looks at drives elsewhere
constexpr std::size_t kMostWaiting = 100'000;       // results

// The existing results, a bit each.
class Ledger {
 public:
  Ledger(const SweepFile& sweep, const results::Store& store)
      : replications_(sweep.replications), paradigms_(sweep.paradigms.size()),
        there_(sweep.points() * replications_ * paradigms_, false) {
    for (const RowKey& key : store.keys()) there_[index_of(key)] = true;
  }
  bool has(const RowKey& key) const { return there_[index_of(key)]; }
  void add(const RowKey& key) { there_[index_of(key)] = true; }

 private:
  std::size_t index_of(const RowKey& key) const {
    return (std::size_t{key.point} * replications_ + key.replication) * paradigms_ + key.paradigm;
  }
  std::size_t replications_, paradigms_;
  std::vector<bool> there_;
};

// Absent if preparation fails; run() reports the reason.
std::optional<PreparedDrive> try_prepare(const SweepDrives& drives, const RowKey& key) {
  try {
    return drives.prepare(key);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

// Drives `wanted` on all workers, and elsewhere; `take` receives the results now and then, on the calling
// thread.
class Workers {
 public:
  Workers(const SweepDrives& drives, const std::vector<RowKey>& wanted, Elsewhere* elsewhere)
      : drives_(drives), wanted_(wanted), elsewhere_(elsewhere) {}

  void work(unsigned workers, const std::function<void(std::vector<Row>)>& take) {
    std::vector<std::thread> threads;
    threads.reserve(workers);
    std::exception_ptr failure;
    try {
      for (unsigned w = 0; w < workers; ++w) {
        threads.emplace_back([this] { drive(); });
        const std::lock_guard lock(mutex_);
        ++running_;
      }
    } catch (const std::system_error&) {  // go on with fewer
      if (threads.empty()) throw;
    }
    for (bool last = false; !last;) {
      const bool all_back = await_rows();
      std::vector<Row> rows;
      {
        const std::lock_guard lock(mutex_);
        last = all_back && running_ == 0;
        rows.swap(waiting_);
      }
      changed_.notify_all();
      try {
        if (!failure) take(std::move(rows));
      } catch (...) {
        failure = std::current_exception();
        next_ = wanted_.size();
      }
    }
    for (std::thread& thread : threads) thread.join();
    if (failure) std::rethrow_exception(failure);
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  void drive() {
    std::exception_ptr failure;
    try {
      drive_all();
    } catch (...) {
      failure = std::current_exception();
      next_ = wanted_.size();
    }
    const std::lock_guard lock(mutex_);
    if (failure) failure_ = failure;
    --running_;
    changed_.notify_all();
  }

  // Returns the next few keys.
  std::span<const RowKey> grab() {
    const std::size_t first = next_.fetch_add(kRowsAtATime);
    if (first >= wanted_.size()) return {};
    return std::span(wanted_).subspan(first, std::min<std::size_t>(kRowsAtATime, wanted_.size() - first));
  }

  void drive_all() {
    Driver driver(drives_);
    for (std::span<const RowKey> some = grab(); !some.empty(); some = grab())
      driver.drive(some, [this](Row row) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return waiting_.size() < kMostWaiting; });
        waiting_.push_back(std::move(row));
      });
  }

  bool nobody_runs() {
    const std::lock_guard lock(mutex_);
    return running_ == 0;
  }

  // Waits until results should be written, or all are there. Returns whether no result is pending elsewhere.
  bool await_rows() {
    if (elsewhere_ == nullptr) {
      std::unique_lock lock(mutex_);
      changed_.wait_for(lock, kWritten, [&] { return running_ == 0; });
      return true;
    }
    const auto until = std::chrono::steady_clock::now() + kWritten;
    while (true) {
      const bool all_here = nobody_runs();
      const std::size_t away = elsewhere_->turn([this] { return grab(); },
                                                [this](std::vector<Row> rows) {
                                                  const std::lock_guard lock(mutex_);
                                                  for (Row& row : rows) waiting_.push_back(std::move(row));
                                                });
      if (away == 0 && all_here) return true;
      if (std::chrono::steady_clock::now() >= until) return away == 0;
      std::this_thread::sleep_for(kTurn);
    }
  }

  const SweepDrives& drives_;
  const std::vector<RowKey>& wanted_;
  Elsewhere* const elsewhere_;
  std::atomic<std::size_t> next_{0};
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Row> waiting_;  // guarded, as the next two
  int running_ = 0;           // may be below 0 for a moment: a worker may end before it is counted
  std::exception_ptr failure_;
};

}  // namespace

void Driver::drive(std::span<const RowKey> wanted, const std::function<void(Row)>& take) {
  const bool shared = drives_.sweep().drawn().empty();
  for (const RowKey& key : wanted) {
    const bool same = newest_ && key.point == newest_->point && key.paradigm == newest_->paradigm;
    if (!same) prepared_.reset();
    newest_ = key;
    if (shared && !prepared_) prepared_ = try_prepare(drives_, key);
    take(prepared_ ? drives_.run(key, *prepared_) : drives_.run(key));
  }
}

void run_sweep(const SweepDrives& drives, results::Store& store, results::Shard shard, unsigned workers,
               const std::function<void(const ttf::experiments::sweep::SweepProgress&)>& progress,
               Elsewhere* elsewhere) {
  const SweepFile& sweep = drives.sweep();
  const auto points = static_cast<std::uint32_t>(sweep.points());
  const auto paradigms = static_cast<std::uint32_t>(sweep.paradigms.size());
  Ledger ledger(sweep, store);
  SweepProgress now;
  now.done = store.count();
  for (std::uint32_t r = 0; r < sweep.replications; ++r)
    if (shard.has(r)) now.all += std::uint64_t{points} * paradigms;

  std::vector<bool> enough(points, false);
  const std::uint32_t batch = sweep.stop ? sweep.stop->batch : sweep.replications;
  for (std::uint32_t from = 0; from < sweep.replications; from += batch) {
    const std::uint32_t to = std::min(sweep.replications, from + batch);
    std::vector<RowKey> wanted;
    for (std::uint32_t point = 0; point < points; ++point)
      for (std::uint32_t paradigm = 0; paradigm < paradigms && !enough[point]; ++paradigm)
        for (std::uint32_t r = from; r < to; ++r)
          if (const RowKey key{point, r, paradigm}; shard.has(r) && !ledger.has(key)) wanted.push_back(key);
    Workers(drives, wanted, elsewhere).work(workers, [&](std::vector<Row> rows) {
      store.add(rows);
      for (const Row& row : rows) ledger.add(row.key);
      now.done += rows.size();
      now.driven += rows.size();
      progress(now);
    });
    if (!sweep.stop) continue;
    for (std::uint32_t point = 0; point < points; ++point)
      if (!enough[point]) enough[point] = answers::sure_enough(sweep, store.of_point(point), to);
    if (std::find(enough.begin(), enough.end(), false) == enough.end()) return;
  }
}

}  // namespace ttf::experiments::sweep
