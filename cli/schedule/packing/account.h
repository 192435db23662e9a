// Prints a packing for `schedule synthesize --signals`, as text and as JSON.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/schedule/packing/signal_file.h"
#include "schedules/packing/packer.h"
#include "schedules/packing/room.h"

namespace ttf::cli::schedule::packing {

struct Account {
  const SignalFile& file;
  const schedules::packing::Solution& solution;
  const std::vector<schedules::packing::SlotNumber>& numbers;
  const std::vector<schedules::packing::Room>& rooms;
  // The packing of all signals as those of one vehicle, if there are variants.
  const schedules::packing::Solution* one_vehicle = nullptr;
  schedules::packing::ChannelUse use;
  int standing = 0;  // signals that kept their place
  int room_bits = 8;
  int first_slot = 1;
  std::optional<int> slots;  // given

  // The numbers that may be used are first_slot..last_slot().
  int last_slot() const;
  int highest_slot() const;
  bool suffices() const { return highest_slot() <= last_slot(); }
  int free_slots() const;  // the numbers that no channel has in use
  // The slots that the cluster needs: those of the fuller channel.
  int slots_needed() const;
  // A number that no packing can do without, for slots_needed().
  int least_slots() const;
};

// Returns the subject of least_slots() in a sentence: "no packing", or "no packing that keeps the places that stand".
std::string no_packing(const Account& account);

std::string account_text(const Account& account);
std::string account_json(const Account& account);

}  // namespace ttf::cli::schedule::packing
