// The signals of the real-time image on the bus, written by the fusion node and read by its receivers.
//
// x, y, heading, speed and acceleration are those of the object's centre, whatever its track follows
// (fusion/tracks/body/distance.h). The sigmas of length and width are rounded up to the next code, all other values to the
// nearest: a size's uncertainty is of the order of its resolution, and is never understated.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "bus/cni/list_buffer.h"
#include "fusion/tracks/view.h"
#include "nodes/host/step.h"
#include "recording/records/records.h"
#include "schedules/model/cluster.h"

namespace ttf::nodes::fusion {

// The element's signals in the code's order; a layout may have any order.
inline constexpr auto kImageSignals = std::to_array<std::string_view>(
    {"id", "x", "y", "heading", "speed", "acceleration", "length", "width", "sigma_x", "sigma_y", "correlation",
     "sigma_heading", "sigma_speed", "sigma_acceleration", "sigma_length", "sigma_width", "status"});
using ImageSignals = std::array<std::size_t, kImageSignals.size()>;
ImageSignals bind_image(const schedules::model::Cluster& cluster, const schedules::model::PduLayout& layout);

// Writes element `index` of the list begun in `out`.
void encode_image_object(const ttf::fusion::tracks::TrackView& view, host::Output& out, int index,
                         const ImageSignals& signals);
// Returns element `index` of an image list as its receivers decode it.
recording::records::ImageObject decode_image_object(const schedules::model::PduLayout& layout,
                                                    const bus::cni::ListView& list, int index,
                                                    const ImageSignals& signals);

}  // namespace ttf::nodes::fusion
