// What receivers find wrong with a slot, in words.
#pragma once

#include <cstdint>
#include <string>

namespace ttf::recording::exports {

// Of the bits of records::SlotProblem, joined; "status 0" and the like where none of them is known.
std::string slot_status_words(std::uint8_t status);

}  // namespace ttf::recording::exports
