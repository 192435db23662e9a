// A made-up drive as records, written out by hand arithmetic. Two free-running sensors have different
// preprocessing times, so that camera lists overtake laser lists. A 5 ms cycle has two slots per list. Fusion
// runs every 10 ms, images come every 40 ms. Only for the pictures; it obeys no schedule checker.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "recording/records/records.h"
#include "report/drawing/names.h"

namespace ttf::report {

inline drawing::Names synthetic_names() {
  drawing::Names names;
  names.nodes = {"laser_device", "camera_device", "laser_pc", "camera_pc", "gateway", "fusion", "feature"};
  names.pdus = {"laser_points", "camera_frame", "laser_objects", "camera_objects", "image"};
  names.sensors = {"laser", "camera"};
  names.can_buses = {"laser_can", "camera_can", "object_can"};
  names.tasks = {{"emulate"},        {"emulate"}, {"extract"}, {"extract"}, {"forward_laser", "forward_camera"},
                 {"track", "image"}, {"serve"}};
  return names;
}

inline TrueTime at_us(std::int64_t us) { return {us * 1000}; }

struct SyntheticDrive {
  bool missed_deadline = true;
  std::int64_t global_offset_us = 3;  // global minus true time

  recording::records::Stamp stamp(std::int64_t us, int node) const {
    return {at_us(us), {us * 1000}, {(us + global_offset_us) * 1000}, NodeId(static_cast<std::uint8_t>(node))};
  }

  void slot(recording::records::Sink& sink, std::int64_t cycle, int number, int node, PduId pdu, std::uint32_t sequence,
            int fragment, bool null_frame) const {
    recording::records::SlotFrameSent f;
    const std::int64_t start = cycle * 5000 + (number - 1) * 84 + 7 - global_offset_us;
    f.stamp = stamp(start, node);
    f.end = stamp(start + 74, node);
    f.cycle = cycle;
    f.slot = static_cast<std::uint16_t>(number);
    f.null_frame = null_frame;
    f.pdu = pdu;
    f.sensor = sensor_of(pdu);
    f.sequence = sequence;
    f.fragment = static_cast<std::uint8_t>(fragment);
    for (f.channel = 0; f.channel < 2; ++f.channel) sink.on(f);
  }

  // The sensor of a PDU's list: raw data and objects of the two sensors in turn, then the image.
  static SensorId sensor_of(PduId pdu) {
    return index_of(pdu) < 4 ? SensorId(static_cast<std::uint8_t>(index_of(pdu) % 2)) : kNoSensor;
  }

  void hop(recording::records::Sink& sink, std::int64_t us, int node, recording::records::Hop what, int pdu,
           std::uint32_t sequence, int bus = -1) const {
    const PduId list{static_cast<std::uint8_t>(pdu)};
    sink.on(recording::records::ListHop{stamp(us, node), what, list, sensor_of(list), sequence,
                                        static_cast<std::int8_t>(bus)});
  }

  void task(recording::records::Sink& sink, std::int64_t activated, std::int64_t start, std::int64_t end, int node,
            int number, bool in_time = true) const {
    sink.on(recording::records::TaskRun{stamp(start, node), static_cast<std::uint8_t>(number), stamp(activated, node),
                                        stamp(end, node), in_time});
  }

  void can(recording::records::Sink& sink, std::int64_t start, std::int64_t end, int bus, int sender, int pdu,
           std::uint32_t sequence) const {
    for (int i = 0; i < 4; ++i) {
      recording::records::CanFrameSent f;
      f.bus = static_cast<std::uint8_t>(bus);
      f.start = stamp(start + (end - start) * i / 4, sender);
      f.end = stamp(start + (end - start) * (i + 1) / 4 - 20, sender);
      f.pdu = PduId(static_cast<std::uint8_t>(pdu));
      f.sensor = sensor_of(f.pdu);
      f.sequence = sequence;
      f.fragment = static_cast<std::uint8_t>(i);
      sink.on(f);
    }
  }

  static double x_at(double t) { return 30 + 4 * t + 1.5 * t * t; }
  static double y_at(double t) { return -0.4 + 0.9 * std::sin(1.6 * t); }
  static double noise(std::uint32_t i, double sigma) { return sigma * std::sin(12.9898 * i + 4.1 * i * i); }

  struct Arrival {
    std::int64_t at_us;
    MeasurementId id;
    std::int64_t measured_us;
    bool taken = false;
  };

  // From 0 to `end_us`, unordered (a merged log has each process in turn).
  void drive(recording::records::Sink& sink, std::int64_t end_us) const {
    std::vector<Arrival> arrivals;
    struct Kind {
      std::int64_t period, phase, can_time, wait, work;
    };
    const std::array<Kind, 2> kinds{Kind{80000, 4000, 6000, 300, 31000}, Kind{50000, 11000, 2500, 200, 8000}};
    for (int s = 0; s < 2; ++s) {
      const Kind& k = kinds[static_cast<std::size_t>(s)];
      std::uint32_t n = 0;
      for (std::int64_t t = k.phase; t < end_us; t += k.period, ++n) {
        const MeasurementId id{SensorId(static_cast<std::uint8_t>(s)), n};
        sink.on(recording::records::Measured{stamp(t, 2 + s), id, {}});
        task(sink, t, t + 50, t + 400, s, 0);
        hop(sink, t + 400, s, recording::records::Hop::kWritten, s, n, s);
        can(sink, t + 500, t + 500 + k.can_time, s, s, s, n);
        hop(sink, t + 500 + k.can_time, s, recording::records::Hop::kSent, s, n, s);
        const std::int64_t received = t + 500 + k.can_time, start = received + k.wait,
                           done = start + k.work + (n % 3) * 700;
        hop(sink, received, 2 + s, recording::records::Hop::kReceived, s, n, s);
        hop(sink, start, 2 + s, recording::records::Hop::kRead, s, n, s);
        task(sink, received, start, done, 2 + s, 0, !(missed_deadline && s == 0 && n == 1));
        hop(sink, done, 2 + s, recording::records::Hop::kWritten, 2 + s, n, 2);
        can(sink, done + 100, done + 1100, 2, 2 + s, 2 + s, n);
        hop(sink, done + 1100, 4, recording::records::Hop::kReceived, 2 + s, n, 2);
        hop(sink, done + 1200, 4, recording::records::Hop::kRead, 2 + s, n, 2);
        task(sink, done + 1100, done + 1200, done + 1500, 4, s);
        hop(sink, done + 1500, 4, recording::records::Hop::kWritten, 2 + s, n);
        const std::int64_t cycle = (done + 1500) / 5000 + 1;
        for (int f = 0; f < 3; ++f)
          slot(sink, cycle, 3 + 4 * s + f, 4, PduId(static_cast<std::uint8_t>(2 + s)), n, f, false);
        arrivals.push_back({cycle * 5000 + 1200, id, t});
      }
    }
    for (std::int64_t c = 0; c * 5000 < end_us; ++c) {
      slot(sink, c, 1, 4, kNoPdu, 0, 0, false);
      slot(sink, c, 2, 5, kNoPdu, 0, 0, false);
      if (c % 3 == 0) slot(sink, c, 20, 6, kNoPdu, 0, 0, true);
    }
    fuse(sink, arrivals, end_us);
    for (std::int64_t t = 0; t <= end_us; t += 10000) {
      recording::records::TruthState truth;
      truth.at = at_us(t);
      truth.x = x_at(1e-6 * static_cast<double>(t));
      truth.y = y_at(1e-6 * static_cast<double>(t));
      sink.on(truth);
      if (t % 100000 != 0) continue;
      const auto i = static_cast<std::uint32_t>(t / 100000);
      recording::records::ReferenceFix fix;
      fix.measured_true = at_us(t);
      fix.measured = {(t + global_offset_us) * 1000};
      fix.x = truth.x + noise(i, 0.7);
      fix.y = truth.y + noise(i + 50, 0.5);
      sink.on(fix);
    }
  }

  void fuse(recording::records::Sink& sink, std::vector<Arrival>& arrivals, std::int64_t end_us) const {
    std::uint32_t step = 0, image_sequence = 0;
    std::int64_t newest = -1;
    std::array<MeasurementId, 2> newest_ids{};
    for (std::int64_t t = 3000; t < end_us; t += 10000) {
      ++step;
      task(sink, t, t, t + 1800, 5, 0);
      for (Arrival& a : arrivals) {
        if (a.taken || a.at_us > t) continue;
        a.taken = true;
        const bool late = a.measured_us < newest;
        newest = std::max(newest, a.measured_us);
        newest_ids[index_of(a.id.sensor)] = a.id;
        const double tm = 1e-6 * static_cast<double>(a.measured_us);
        for (std::uint16_t i = 0; i < 2; ++i) {
          recording::records::ObservationSeen o;
          o.stamp = stamp(t, 5);
          o.id = a.id;
          o.measured = {(a.measured_us + global_offset_us) * 1000};
          o.index = i;
          o.x = x_at(tm) + noise(a.id.sequence * 7, 0.25) + 20.0 * i;  // the second belongs to another object
          o.y = y_at(tm) + noise(a.id.sequence * 7 + 3, 0.2);
          sink.on(o);
        }
        recording::records::ListFused fused{stamp(t, 5),
                                            step,
                                            a.id,
                                            {(a.measured_us + global_offset_us) * 1000},
                                            recording::records::Disposition::kFused};
        if (late) fused.disposition = recording::records::Disposition::kFusedLate;
        sink.on(fused);
      }
      const double now = 1e-6 * static_cast<double>(t);
      const std::array<double, 6> state{x_at(now) + noise(step, 0.08), y_at(now) + noise(step + 9, 0.06), 4, 0, 0, 0};
      const std::array<double, 36> covariance{};
      recording::records::TrackState track{stamp(t, 5), step,       TrackId(1), {(t + global_offset_us) * 1000},
                                           state,       covariance, false};
      sink.on(track);
      sink.on(recording::records::FusionStep{stamp(t, 5), step, 1, 0});
      if (step % 4 != 1) continue;
      const std::int64_t written = t + 1800, use = t + 37000;
      task(sink, written, written, written + 500, 5, 1);
      recording::records::ImageObject object;
      object.x = x_at(1e-6 * static_cast<double>(use)) + noise(step, 0.1);
      object.y = y_at(1e-6 * static_cast<double>(use)) + noise(step + 1, 0.08);
      recording::records::ImageWritten image;
      image.stamp = stamp(written, 5);
      image.sequence = image_sequence;
      image.valid_at = {(use + global_offset_us) * 1000};
      image.objects = {&object, 1};
      image.newest = newest_ids;
      sink.on(image);
      const std::int64_t cycle = written / 5000 + 1;
      for (int f = 0; f < 2; ++f) slot(sink, cycle, 12 + f, 5, PduId(4), image_sequence, f, false);
      task(sink, use, use, use + 300, 6, 0);
      recording::records::FeatureUsed used;
      used.stamp = stamp(use, 6);
      used.image_sequence = image_sequence;
      used.image_valid_at = image.valid_at;
      sink.on(used);
      ++image_sequence;
    }
  }
};

}  // namespace ttf::report
