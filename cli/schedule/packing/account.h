// Prints a packing for `schedule synthesize --signals`, as text and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/schedule/packing/signal_file.h"
#include "schedules/synthesis/packing/packer.h"
#include "schedules/synthesis/packing/room.h"

namespace ttf::cli::schedule::packing {

struct Account {
  const SignalFile& file;
  const schedules::synthesis::packing::Solution& solution;
  const std::vector<schedules::synthesis::packing::SlotNumber>& numbers;
  const std::vector<schedules::synthesis::packing::Room>& rooms;
  schedules::synthesis::packing::ChannelUse use;
  int standing = 0;  // signals that kept their place
  int room_bits = 8;
  std::optional<int> slots;  // given

  // The slots that the cluster needs: those of the fuller channel.
  int slots_needed() const;
  // A number that no packing can do without, for slots_needed().
  int least_slots() const;
};

std::string account_text(const Account& account);
std::string account_json(const Account& account);

}  // namespace ttf::cli::schedule::packing
