// Follows pictures into images, images into commands and commands to the actuator, in the records of a drive alone.
#pragma once

#include <algorithm>
#include <cstdint>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "recording/records/records.h"
#include "schedules/analysis/chain/chains.h"

namespace ttf::sim::drives::ages {

class FollowedChains final : public recording::records::Sink {
 public:
  struct Seen {
    std::size_t pictures = 0, readings = 0;
    Duration first_least = Duration::milliseconds(100'000),
             first_most{};  // from a picture to its first command's reading
    Duration age_most{}, age_until_next_most{};
  };
  // From a picture to the reading of the first command that rests on it.
  struct First {
    PduId command{};
    MeasurementId picture;
    Duration time{};
  };

  FollowedChains(const schedules::model::Cluster& cluster, TrueTime from) : from_(from) {
    for (const schedules::analysis::chain::Chain& chain : schedules::analysis::chain::chains(cluster))
      commands_.insert(chain.command);
  }

  const std::vector<First>& firsts() const { return firsts_; }

  const Seen& seen(PduId command, SensorId sensor) { return seen_[{command, sensor}]; }

  bool wants_frames() const override { return false; }
  using recording::records::Sink::on;
  void on(const recording::records::Measured& r) override { pictures_[r.id.sensor][r.id.sequence] = r.stamp.true_time; }
  void on(const recording::records::ImageWritten& r) override {
    shown_[r.sequence].assign(r.newest.begin(), r.newest.end());
  }
  void on(const recording::records::ListHop& r) override {
    if (r.hop != recording::records::Hop::kRead) return;
    if (commands_.contains(r.pdu)) return read(r);
    // A service reads at its start, which is the instant of its command. Its other tasks start at other instants.
    if (r.sensor == kNoSensor)
      now_[r.stamp.node].image = {r.stamp.true_time, r.sequence};
    else
      now_[r.stamp.node].samples[r.sensor] = {r.stamp.true_time, r.sequence};
  }
  void on(const recording::records::CommandIssued& r) override {
    Inputs& newest = inputs_[r.pdu];
    const Inputs& now = now_[r.stamp.node];
    if (now.image.first == r.stamp.true_time) newest.image = now.image;
    for (const auto& [sensor, sample] : now.samples)
      if (sample.first == r.stamp.true_time) newest.samples[sensor] = sample;
    std::map<SensorId, std::uint32_t>& rests = rests_[{r.pdu, r.sequence}];
    for (const auto& [sensor, sample] : newest.samples) rests[sensor] = sample.second;
    for (const MeasurementId& id : shown_[newest.image.second]) rests.try_emplace(id.sensor, id.sequence);
  }

 private:
  struct Inputs {
    std::pair<TrueTime, std::uint32_t> image;
    std::map<SensorId, std::pair<TrueTime, std::uint32_t>> samples;
  };

  void read(const recording::records::ListHop& r) {
    for (const auto& [sensor, newest] : rests_[{r.pdu, r.sequence}]) {
      Seen& seen = seen_[{r.pdu, sensor}];
      std::uint32_t& known = known_[{r.pdu, sensor}];
      const std::map<std::uint32_t, TrueTime>& pictures = pictures_[sensor];
      if (const auto before = pictures.find(known); before != pictures.end() && before->second >= from_)
        seen.age_until_next_most = std::max(seen.age_until_next_most, r.stamp.true_time - before->second);
      // The command also rests on all pictures since the one that the last command rested on.
      for (auto one = pictures.upper_bound(known); one != pictures.end() && one->first <= newest; ++one) {
        if (one->second < from_) continue;
        const Duration first = r.stamp.true_time - one->second;
        ++seen.pictures;
        firsts_.push_back({r.pdu, {sensor, one->first}, first});
        seen.first_least = std::min(seen.first_least, first);
        seen.first_most = std::max(seen.first_most, first);
      }
      known = newest;
      if (const auto now = pictures.find(newest); now != pictures.end() && now->second >= from_) {
        ++seen.readings;
        seen.age_most = std::max(seen.age_most, r.stamp.true_time - now->second);
      }
    }
  }

  TrueTime from_;
  std::set<PduId> commands_;
  std::map<SensorId, std::map<std::uint32_t, TrueTime>> pictures_;
  std::map<std::uint32_t, std::vector<MeasurementId>> shown_;
  std::map<NodeId, Inputs> now_;
  std::map<PduId, Inputs> inputs_;  // those of the newest command
  std::map<std::pair<PduId, std::uint32_t>, std::map<SensorId, std::uint32_t>> rests_;
  std::map<std::pair<PduId, SensorId>, std::uint32_t> known_;
  std::map<std::pair<PduId, SensorId>, Seen> seen_;
  std::vector<First> firsts_;
};

}  // namespace ttf::sim::drives::ages
