// Receives frames on DDS topics (bus/ports/listener.h). It has readers only, and names no node: the members of the
// session neither await it nor notice it. A sample is malformed if no member would use it, though it has a received
// slot or identifier: its fields contradict each other, its sender is not on the line, or its number was used
// before. A sample that states its lateness is received as a frame and its follow-up.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bus/dds/common/participant.h"
#include "bus/dds/common/session.h"
#include "bus/dds/live/line.h"
#include "bus/ports/listener.h"

namespace ttf::bus::dds::live {

class DdsListener final : public ports::Listener {
 public:
  // Uses the session's domain, name and lease. `lines`: each once, with all its nodes; lines without received identifiers
  // are left out. Throws InputError on an invalid session, std::runtime_error if DDS cannot.
  DdsListener(const common::Session& session, const std::vector<LiveLinePlan>& lines,
              const ports::ReceivedIdentifiers& identifiers);

  std::optional<ports::ReceivedFrame> receive() override;
  std::uint64_t lost() const override;
  const std::string& failure() const override;

 private:
  struct OnLine {
    LiveLinePlan plan;
    std::unique_ptr<Reception> reception;
  };
  ports::ReceivedFrame on_channel();

  common::Participant participant_;
  std::vector<OnLine> lines_;
  LiveItem last_;  // the last result of receive()
  std::optional<ports::ReceivedFrame> follow_up_;
  mutable std::string failure_;
};

}  // namespace ttf::bus::dds::live
