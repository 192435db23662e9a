// Decodes observation lists for the fusion node: maps signals to observations.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "bus/cni/list_buffer.h"
#include "fusion/sensors/observation.h"
#include "schedules/model/cluster.h"

namespace ttf::sensors {

// The bits of the signal `valid`.
inline constexpr int kValidHeading = 1, kValidLength = 2, kValidWidth = 4, kValidCorner = 8;
// Without a heading there is no length and no width: these bits say which end of a cut outline was seen.
inline constexpr int kRightmost = kValidLength, kLeftmost = kValidWidth;

// A codec is bound to a PDU once. A layout with x and y has positions: x, y, their covariance, and either
// heading and extent or the angle that the outline spans. Otherwise it has radar detections: range, bearing,
// range_rate and their sigmas. If it also has `returns`, a detection is the mean of so many of the visible outline.
// A layout with a span may have a `class` (fusion/config/classes.h), which counts once.
//
// The seen point of a position follows from the bits of the signal `valid`; a layout with a span locates silhouettes.
//   heading, corner               kCorner
//   heading, width                kEnd
//   heading, length               kSide
//   heading, length, width        kCentre: lists of earlier versions, whose position was the centre
//   corner                        kCentre: a recorded position of the whole object
//   length, or width              kRightmost, or kLeftmost
//   else                          kSilhouette
// Radar detections with returns are of the kSilhouette, others of the kCentre.
class ObservationCodec {
 public:
  ObservationCodec(const schedules::model::Cluster& cluster, PduId pdu);
  // Replaces `out` by the list's observations.
  void decode(const bus::cni::ListView& list, std::vector<ttf::fusion::sensors::Observation>& out) const;

 private:
  enum class Form { kLaser, kPosition, kRadar };
  const schedules::model::PduLayout* layout_;
  Form form_;
  std::vector<std::size_t> signals_;
  std::optional<std::size_t> returns_;  // of a radar
};

}  // namespace ttf::sensors
