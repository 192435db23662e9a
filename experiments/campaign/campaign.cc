#include "experiments/campaign/campaign.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

namespace ttf::experiments::campaign {
namespace {

constexpr std::size_t kFaultsAtATime = 16;  // faults that a worker takes at a time
constexpr std::chrono::milliseconds kProgressInterval{500};

}  // namespace

std::vector<FaultResult> run_campaign(const CampaignFile& campaign, const CampaignBus& bus, results::Shard shard,
                                      unsigned workers, const std::function<void(std::uint64_t)>& progress) {
  std::vector<FaultResult> results;
  for (std::uint64_t i = shard.part; i < static_cast<std::uint64_t>(campaign.faults); i += shard.count)
    results.push_back({static_cast<std::uint32_t>(i), {}, {}});

  std::atomic<std::size_t> next{0};  // each result is written only by the worker that took it
  std::mutex mutex;
  std::condition_variable done;
  std::size_t finished = 0;  // guarded by mutex, as the two below
  unsigned running = std::max(1u, workers);
  std::exception_ptr failure;

  const auto work = [&] {
    try {
      for (std::size_t first = next.fetch_add(kFaultsAtATime); first < results.size();
           first = next.fetch_add(kFaultsAtATime)) {
        const std::size_t end = std::min(first + kFaultsAtATime, results.size());
        for (std::size_t r = first; r < end; ++r) {
          FaultResult& result = results[r];
          result.drawn = bus.draw(result.index);
          for (std::size_t v = 0; v < campaign.variants.size(); ++v)
            result.outcomes.push_back(bus.run(v, result.drawn, result.index));
        }
        const std::lock_guard lock(mutex);
        finished += end - first;
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!failure) failure = std::current_exception();
      next = results.size();
    }
    const std::lock_guard lock(mutex);
    if (--running == 0) done.notify_one();
  };

  std::vector<std::thread> threads;
  for (unsigned w = 0; w < std::max(1u, workers); ++w) threads.emplace_back(work);
  {
    std::unique_lock lock(mutex);
    while (!done.wait_for(lock, kProgressInterval, [&] { return running == 0; })) {
      const std::size_t count = finished;
      lock.unlock();
      if (progress) progress(count);
      lock.lock();
    }
  }
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
  return results;
}

}  // namespace ttf::experiments::campaign
