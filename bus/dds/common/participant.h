// A process's place in a DDS domain. DDS' own headers stay out of it: its entities are numbers here.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace ttf::bus::dds::common {

using Handle = std::int32_t;  // dds_entity_t

// Returns `result` if it is no error. Throws std::runtime_error "DDS: <what>: <why>".
std::int32_t checked(std::int32_t result, std::string_view what);

class Participant {
 public:
  // Joins the domain, 0..kMaxDomain, with the configuration of CYCLONEDDS_URI or, if that is not set, of
  // bus/dds/common/configuration.h. Participants of one process and domain share the configuration of the
  // first. Throws std::runtime_error if it cannot.
  Participant(std::uint32_t domain, std::chrono::milliseconds lease);
  ~Participant();  // also ends everything that was made in it
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  Handle handle() const { return handle_; }

 private:
  std::uint32_t domain_;
  bool configured_;  // this process made the domain and closes it
  Handle handle_ = 0;
};

}  // namespace ttf::bus::dds::common
