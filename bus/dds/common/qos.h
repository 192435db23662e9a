// Qualities of service, released with their holder, and the partition that separates sessions. Only sources of
// this module include it.
#pragma once

#include <dds/dds.h>

#include <memory>
#include <string>

namespace ttf::bus::dds::common {

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

inline Qos new_qos() { return {dds_create_qos(), dds_delete_qos}; }

inline Qos partition(const std::string& session) {
  Qos qos = new_qos();
  dds_qset_partition1(qos.get(), session.c_str());
  return qos;
}

}  // namespace ttf::bus::dds::common
