// Metadata records: a name, and entries of a key and a value. Private to the module.
//
// A metadata record is consistent if its entries fill it exactly. In a damaged file a candidate may begin at any byte.
// Its entries may reach to the file's end. Candidates whose entries meet share all further ones. They are followed
// together, so each entry is read once.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace ttf::recording::mcap {

// Reads a metadata record's content; `entries` may be null. Returns whether it is consistent.
bool read_metadata(std::string_view content, std::string_view& name,
                   std::vector<std::pair<std::string, std::string>>* entries);

// Returns where consistent metadata records begin, from `from` on, in ascending order. Adds to `work` the bytes,
// candidates and entries that it looked at.
std::vector<std::size_t> consistent_metadata(std::string_view bytes, std::size_t from, std::uint64_t& work);

}  // namespace ttf::recording::mcap
