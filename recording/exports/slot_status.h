// A receiver's problems with a slot, in words.
#pragma once

#include <cstdint>
#include <string>

namespace ttf::recording::exports {

// Joins the words for the bits of records::SlotProblem; returns "status 0" and the like if no bit is known.
std::string slot_status_words(std::uint8_t status);

}  // namespace ttf::recording::exports
