// Any fragments, in any order, to a list buffer. Laws: a list handed out is whole and has one sequence
// number. Its bytes are the arrived ones. A copy sent on is the same. Every signal can be written back in
// place.
//
// Input: a PDU of a shipped cluster (2 bytes), then fragments. Each begins with a byte. Bit 0 makes the
// header plausible (sequence, fragment and count taken into range, as random bytes seldom are). Bit 1 repeats
// the previous one.
#include <algorithm>
#include <map>
#include <vector>

#include "bus/cni/list_buffer.h"
#include "bus/wire/pdu_codec.h"
#include "core/check.h"
#include "schedules/file/loader.h"
#include "tests/fuzz/harness.h"

namespace {

using namespace ttf;
using schedules::model::PduLayout;

std::size_t header_of(const PduLayout& layout, std::string_view name) {
  return *schedules::model::find_signal(layout.header, name);
}

void make_plausible(const PduLayout& layout, std::span<std::byte> payload) {
  const std::size_t sequence = header_of(layout, "sequence"), fragment = header_of(layout, "fragment"),
                    count = header_of(layout, "count");
  const auto bounded = [&](std::size_t signal, std::uint32_t below) {
    const std::uint32_t raw = bus::wire::read_header_raw(layout, payload, signal);
    bus::wire::write_header_raw(layout, payload, signal, raw % below);
    return raw % below;
  };
  bounded(sequence, 3);
  const auto elements = bounded(count, static_cast<std::uint32_t>(std::min(layout.max_elements, 40)) + 1);
  bounded(fragment, static_cast<std::uint32_t>(layout.fragments_of(static_cast<int>(elements))));
}

// Reading every signal and writing it back changes nothing.
void check_codec(const PduLayout& layout, std::span<const std::byte> payload) {
  std::vector<std::byte> copy(payload.begin(), payload.end());
  for (std::size_t s = 0; s < layout.header.size(); ++s)
    bus::wire::write_header_raw(layout, copy, s, bus::wire::read_header_raw(layout, payload, s));
  for (int i = 0; i < layout.elements_per_fragment; ++i)
    for (std::size_t s = 0; s < layout.element.size(); ++s) {
      const std::uint32_t raw = bus::wire::read_element_raw(layout, payload, i, s);
      bus::wire::write_element_raw(layout, copy, i, s, raw);
      const double physical = bus::wire::to_physical(layout.element[s], raw);
      if (raw <= bus::wire::highest_code(layout.element[s]))
        TTF_CHECK(bus::wire::to_raw(layout.element[s], physical) == raw, "{}: {} is {}", layout.element[s].name, raw,
                  physical);
    }
  TTF_CHECK(std::equal(copy.begin(), copy.end(), payload.begin()), "{}: other bytes", layout.name);
}

void check_list(const PduLayout& layout, const bus::cni::ListView& list,
                const std::vector<std::vector<std::byte>>& seen) {
  const auto bytes = static_cast<std::size_t>(layout.fragment_bytes);
  TTF_CHECK(list.fragments >= 1 && list.fragments <= layout.max_fragments() &&
                list.bytes.size() == bytes * static_cast<std::size_t>(list.fragments),
            "{} fragments, {} bytes", list.fragments, list.bytes.size());
  const auto sequence = header_of(layout, "sequence"), count = header_of(layout, "count");
  const auto first = list.bytes.first(bytes);
  const auto elements = static_cast<int>(bus::wire::read_header_raw(layout, first, count));
  TTF_CHECK(elements <= layout.max_elements && layout.fragments_of(elements) == list.fragments,
            "{} elements in {} fragments", elements, list.fragments);
  const std::uint32_t raw = bus::wire::read_header_raw(layout, first, sequence);
  TTF_CHECK(((list.sequence - raw) & ((std::uint64_t{1} << layout.header[sequence].bits) - 1)) == 0,
            "sequence {} of raw {}", list.sequence, raw);
  for (int f = 0; f < list.fragments; ++f) {
    const auto fragment = list.bytes.subspan(static_cast<std::size_t>(f) * bytes, bytes);
    TTF_CHECK(bus::wire::read_header_raw(layout, fragment, sequence) == raw &&
                  bus::wire::read_header_raw(layout, fragment, count) == static_cast<std::uint32_t>(elements) &&
                  bus::wire::read_header_raw(layout, fragment, header_of(layout, "fragment")) ==
                      static_cast<std::uint32_t>(f),
              "fragment {} is of another list", f);
    TTF_CHECK(std::any_of(seen.begin(), seen.end(),
                          [&](const auto& one) { return std::equal(one.begin(), one.end(), fragment.begin()); }),
              "fragment {} never arrived", f);
  }
  bus::cni::OutgoingList out(layout);
  out.write(list);
  for (int f = 0; f < list.fragments; ++f) {
    const auto fragment = out.fragment(f);
    TTF_CHECK(std::equal(fragment.begin(), fragment.end(), list.bytes.begin() + f * layout.fragment_bytes),
              "fragment {} is sent otherwise", f);
  }
  TTF_CHECK(out.fragment(list.fragments).empty() && out.fragment(-1).empty(), "a fragment too many");
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const schedules::model::Cluster kClusters[] = {
      schedules::file::parse_cluster(fuzz::shipped_cluster("paper_synchronised"), "paper"),
      schedules::file::parse_cluster(fuzz::shipped_cluster("laser_radar"), "recorded")};
  fuzz::Source source(data, size);
  const schedules::model::Cluster& cluster = kClusters[source.take<std::uint8_t>() % 2];
  const PduLayout& layout = cluster.pdus[source.take<std::uint8_t>() % cluster.pdus.size()];
  bus::cni::IncomingList list(layout);
  std::vector<std::vector<std::byte>> seen;
  std::optional<std::uint32_t> latest;
  while (!source.empty()) {
    const auto how = source.take<std::uint8_t>();
    std::vector<std::byte> payload(static_cast<std::size_t>(layout.fragment_bytes));
    if ((how & 2) != 0 && !seen.empty()) {
      payload = seen.back();
    } else {
      const auto taken = source.bytes(payload.size());
      std::copy(taken.begin(), taken.end(), payload.begin());
      if ((how & 1) != 0) make_plausible(layout, payload);
    }
    seen.push_back(payload);
    check_codec(layout, payload);
    const bus::cni::ArrivalEffect effect = list.arrive(payload);
    const auto view = list.latest();
    if (effect == bus::cni::ArrivalEffect::kCompleted) {
      TTF_CHECK(view && view->sequence == list.arrived(), "a complete list is not there");
    } else {
      TTF_CHECK((view ? std::optional(view->sequence) : std::nullopt) == latest, "the latest changed unasked");
    }
    if (view) {
      latest = view->sequence;
      check_list(layout, *view, seen);
    }
  }
  return 0;
}
