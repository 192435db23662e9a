// Codings, signals, PDUs and frames of a FIBEX file.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/decimal.h"
#include "schedules/exchange/fibex/file.h"
#include "schedules/model/limits.h"

namespace ttf::schedules::exchange::fibex {

std::optional<int> FibexSignal::offset() const {
  const int byte = position / 8;
  if (high_low) return 8 * byte + 7 - position % 8;
  const int top = position % 8 + meaning.bits - 1;
  return top < 8 ? std::optional<int>(8 * byte + 7 - top) : std::nullopt;
}

namespace {

constexpr int kMostBits = 8 * model::kMostFragmentBytes;

using Units = std::map<std::string, std::string>;

Units read_units(XmlElement& where) {
  Units units;
  for (XmlElement& unit : where.children_of("ho:UNITS", "ho:UNIT")) {
    const std::string name = unit.text_of("ho:SHORT-NAME").value_or("");
    units.emplace(unit.attribute("ID"), unit.text_of("ho:DISPLAY-NAME").value_or(name));
    unit.finish();
  }
  return units;
}

// physical = (n0 + n1 raw) / d0
void read_linear(XmlElement& scale, FibexCoding& coding, FibexReader& reader) {
  auto coefficients = scale.child("ho:COMPU-RATIONAL-COEFFS");
  if (!coefficients) {
    coding.unlike = "it has no linear COMPU-SCALE";
    return;
  }
  const auto part = [&](const char* name) {
    std::vector<double> values;
    if (auto one = coefficients->child(name)) {
      values = reader.numbers(*one, "ho:V");
      one->finish();
    }
    return values;
  };
  const std::vector<double> above = part("ho:COMPU-NUMERATOR"), below = part("ho:COMPU-DENOMINATOR");
  coefficients->finish();
  if (above.size() != 2 || below.size() > 1 || (below.size() == 1 && below[0] == 0.0)) {
    coding.unlike = "it has no linear COMPU-SCALE";
    return;
  }
  const double denominator = below.empty() ? 1.0 : below[0];
  coding.meaning.low = above[0] / denominator;
  coding.meaning.resolution = above[1] / denominator;
  if (!(coding.meaning.resolution > 0.0)) coding.unlike = "its physical value falls as the raw one rises";
}

void read_limits(XmlElement& method, FibexCoding& coding, FibexReader& reader) {
  for (XmlElement& range : method.children_of("ho:PHYS-CONSTRS", "ho:SCALE-CONSTR")) {
    if (const std::string validity = range.attribute("VALIDITY"); !validity.empty() && validity != "VALID") {
      reader.leave_out(range, validity, "is left out: only one valid range is kept");
      continue;
    }
    const auto lower = reader.number(range, "ho:LOWER-LIMIT"), upper = reader.number(range, "ho:UPPER-LIMIT");
    range.finish();
    if (lower && *lower != coding.meaning.low)
      reader.leave_out(
          range, fmt::format("{}", *lower),
          fmt::format("has a lower limit other than {}, the value of raw 0; it is left out", coding.meaning.low));
    if (upper) coding.meaning.high = *upper;
  }
}

void read_method(XmlElement& method, const Units& units, FibexCoding& coding, FibexReader& reader) {
  method.ignore("ho:SHORT-NAME");
  const std::string category = method.text_of("ho:CATEGORY").value_or("IDENTICAL");
  if (const std::string id = method.reference("ho:UNIT-REF"); !id.empty()) {
    const auto unit = units.find(id);
    if (unit != units.end())
      coding.meaning.unit = unit->second;
    else
      reader.fail(method, id, "has a UNIT-REF to no unit of this file");
  }
  if (category == "LINEAR") {
    auto scales = method.children_of("ho:COMPU-INTERNAL-TO-PHYS", "ho:COMPU-SCALES");
    std::vector<XmlElement> found;
    for (XmlElement& list : scales) {
      for (XmlElement& scale : list.children("ho:COMPU-SCALE")) found.push_back(std::move(scale));
      list.finish();
    }
    if (found.size() == 1) {
      read_linear(found[0], coding, reader);
      found[0].finish();
    } else {
      coding.unlike = "it has no linear COMPU-SCALE";
    }
  } else if (category != "IDENTICAL") {
    reader.leave_out(method, category, "is left out: only LINEAR and IDENTICAL are understood");
    coding.unlike = fmt::format("its numbers are coded as {}", category);
    method.ignore("ho:COMPU-INTERNAL-TO-PHYS");
  }
  // Without limits all raw numbers are valid.
  model::Signal& meaning = coding.meaning;
  meaning.high = meaning.low + (std::ldexp(1.0, meaning.bits) - 1.0) * meaning.resolution;
  read_limits(method, coding, reader);
  method.finish();
}

FibexCoding read_coding(XmlElement& element, const Units& units, FibexReader& reader) {
  FibexCoding coding;
  element.ignore("ho:SHORT-NAME");
  model::Signal& meaning = coding.meaning;
  if (auto type = element.child("ho:CODED-TYPE")) {
    meaning.bits = reader.integer(*type, "ho:BIT-LENGTH", 1, kMostBits);
    const std::string base = type->attribute("ho:BASE-DATA-TYPE"), encoding = type->attribute("ENCODING");
    if (const std::string kind = type->attribute("CATEGORY"); !kind.empty() && kind != "STANDARD-LENGTH-TYPE")
      coding.unlike = fmt::format("its type is a {}", kind);
    if (!base.starts_with("A_UINT") || (!encoding.empty() && encoding != "UNSIGNED"))
      coding.unlike = fmt::format("its raw numbers are {}, not unsigned", encoding.empty() ? base : encoding);
    type->finish();
  } else {
    reader.fail(element, "", "must have a ho:CODED-TYPE");
  }
  if (meaning.bits > 32) coding.unlike = "it has more than 32 bits";
  meaning.high = std::ldexp(1.0, meaning.bits) - 1.0;
  auto methods = element.children_of("ho:COMPU-METHODS", "ho:COMPU-METHOD");
  for (std::size_t i = 0; i < methods.size(); ++i) {
    if (i == 0)
      read_method(methods[i], units, coding, reader);
    else
      reader.leave_out(methods[i], "", "is left out: a coding has one COMPU-METHOD");
  }
  element.finish();
  return coding;
}

struct NamedCoding {
  std::string name, coding;
};

std::map<std::string, NamedCoding> read_signals(XmlElement& elements, FibexReader& reader) {
  std::map<std::string, NamedCoding> signals;
  for (XmlElement& element : elements.children_of("fx:SIGNALS", "fx:SIGNAL")) {
    NamedCoding signal{reader.name_of(element), element.reference("fx:CODING-REF")};
    element.finish();
    if (!signals.emplace(element.attribute("ID"), std::move(signal)).second)
      reader.fail(element, element.attribute("ID"), "must have an ID of its own");
  }
  return signals;
}

// Reads the segments of a static or a dynamic part. Our lists need one contiguous segment.
std::optional<int> read_segment(XmlElement& part, FibexReader& reader) {
  auto segments = part.children_of("fx:SEGMENT-POSITIONS", "fx:SEGMENT-POSITION");
  std::optional<int> first;
  for (XmlElement& segment : segments) {
    FibexSignal area;
    area.meaning.bits = reader.integer(segment, "ho:BIT-LENGTH", 1, kMostBits);
    area.position = reader.integer(segment, "fx:BIT-POSITION", 0, kMostBits - 1);
    area.high_low = reader.boolean(segment, "fx:IS-HIGH-LOW-BYTE-ORDER", false);
    segment.finish();
    // Whole bytes are the same in either order.
    first = !area.high_low && area.position % 8 == 0 ? area.position : area.offset();
  }
  return segments.size() == 1 ? first : std::nullopt;
}

FibexMultiplexer read_multiplexer(XmlElement& element, FibexReader& reader) {
  FibexMultiplexer out;
  if (auto selector = element.child("fx:SWITCH")) {
    selector->ignore("ho:SHORT-NAME");
    out.switch_position = reader.integer(*selector, "fx:BIT-POSITION", 0, kMostBits - 1);
    out.switch_high_low = reader.boolean(*selector, "fx:IS-HIGH-LOW-BYTE-ORDER", false);
    out.switch_bits = reader.integer(*selector, "ho:BIT-LENGTH", 1, 32);
    selector->finish();
  } else {
    reader.fail(element, "", "must have a fx:SWITCH");
  }
  if (auto part = element.child("fx:DYNAMIC-PART")) {
    part->ignore("ho:SHORT-NAME");
    if (const auto first = read_segment(*part, reader))
      out.dynamic_position = *first;
    else
      out.unlike = "its dynamic part is not one segment";
    for (XmlElement& instance : part->children_of("fx:SWITCHED-PDU-INSTANCES", "fx:SWITCHED-PDU-INSTANCE")) {
      out.layouts.emplace_back(reader.integer(instance, "fx:SWITCH-CODE", 0, INT32_MAX),
                               instance.reference("fx:PDU-REF"));
      instance.finish();
    }
    part->finish();
  }
  if (auto part = element.child("fx:STATIC-PART")) {
    part->ignore("ho:SHORT-NAME");
    if (read_segment(*part, reader) != 0) out.unlike = "its static part does not begin at its first bit";
    if (auto instance = part->child("fx:STATIC-PDU-INSTANCE")) {
      out.static_pdu = instance->reference("fx:PDU-REF");
      instance->finish();
    }
    part->finish();
  }
  element.finish();
  return out;
}

}  // namespace

std::map<std::string, FibexCoding> read_codings(XmlElement& root, XmlElement& elements, FibexReader& reader) {
  Units units;
  std::map<std::string, FibexCoding> codings;
  const auto add = [&](XmlElement& where) {
    for (XmlElement& element : where.children_of("fx:CODINGS", "fx:CODING"))
      if (!codings.emplace(element.attribute("ID"), read_coding(element, units, reader)).second)
        reader.fail(element, element.attribute("ID"), "must have an ID of its own");
  };
  auto processing = root.child("fx:PROCESSING-INFORMATION");
  if (processing) {
    if (auto specification = processing->child("ho:UNIT-SPEC")) {
      units = read_units(*specification);
      specification->finish();
    }
    units.merge(read_units(*processing));
  }
  units.merge(read_units(elements));  // some tools put units and codings among the elements
  if (processing) {
    add(*processing);
    processing->finish();
  }
  add(elements);
  return codings;
}

std::vector<FibexPdu> read_pdus(XmlElement& elements, const std::map<std::string, FibexCoding>& codings,
                                FibexReader& reader) {
  const auto signals = read_signals(elements, reader);
  std::vector<FibexPdu> pdus;
  for (XmlElement& element : elements.children_of("fx:PDUS", "fx:PDU")) {
    FibexPdu pdu;
    pdu.id = element.attribute("ID");
    pdu.name = reader.name_of(element);
    pdu.line = element.line();
    pdu.bytes = reader.integer(element, "fx:BYTE-LENGTH", 0, 65535);
    element.ignore("fx:PDU-TYPE");
    for (XmlElement& instance : element.children_of("fx:SIGNAL-INSTANCES", "fx:SIGNAL-INSTANCE")) {
      FibexSignal signal;
      signal.line = instance.line();
      signal.position = reader.integer(instance, "fx:BIT-POSITION", 0, 8 * 65535);
      signal.high_low = reader.boolean(instance, "fx:IS-HIGH-LOW-BYTE-ORDER", false);
      const std::string id = instance.reference("fx:SIGNAL-REF");
      instance.finish();
      const auto found = signals.find(id);
      if (found == signals.end()) {
        reader.fail(instance, id, "must have a SIGNAL-REF to a signal of this file");
        continue;
      }
      signal.name = found->second.name;
      const auto coding = codings.find(found->second.coding);
      if (coding == codings.end()) {
        reader.leave_out(instance, signal.name, "has a signal without coding, thus of unknown length, and is left out");
        continue;
      }
      signal.meaning = coding->second.meaning;
      signal.meaning.name = signal.name;
      signal.unlike = coding->second.unlike;
      pdu.signals.push_back(std::move(signal));
    }
    std::stable_sort(pdu.signals.begin(), pdu.signals.end(), [](const FibexSignal& a, const FibexSignal& b) {
      return a.offset().value_or(a.position) < b.offset().value_or(b.position);
    });
    if (auto multiplexer = element.child("fx:MULTIPLEXER")) pdu.multiplexer = read_multiplexer(*multiplexer, reader);
    if (auto extension = element.child("fx:MANUFACTURER-EXTENSION")) {
      if (extension->has("ttf:MAX-ELEMENTS"))
        pdu.max_elements = reader.integer(*extension, "ttf:MAX-ELEMENTS", 1, 65535);
      extension->finish();
    }
    element.finish();
    pdus.push_back(std::move(pdu));
  }
  return pdus;
}

std::vector<FibexFrame> read_frames(XmlElement& elements, FibexReader& reader) {
  std::vector<FibexFrame> frames;
  for (XmlElement& element : elements.children_of("fx:FRAMES", "fx:FRAME")) {
    FibexFrame frame;
    frame.id = element.attribute("ID");
    frame.name = reader.name_of(element);
    frame.line = element.line();
    frame.bytes = reader.integer(element, "fx:BYTE-LENGTH", 0, model::kMostFragmentBytes);
    element.ignore("fx:FRAME-TYPE");
    for (XmlElement& instance : element.children_of("fx:PDU-INSTANCES", "fx:PDU-INSTANCE")) {
      frame.places.push_back(
          {instance.reference("fx:PDU-REF"), reader.integer(instance, "fx:BIT-POSITION", 0, kMostBits - 1) / 8});
      instance.ignore("fx:IS-HIGH-LOW-BYTE-ORDER");  // PDUs begin at whole bytes in either order
      instance.finish();
    }
    if (auto extension = element.child("fx:MANUFACTURER-EXTENSION")) {
      if (extension->has("ttf:FRAGMENT")) frame.fragment = reader.integer(*extension, "ttf:FRAGMENT", 0, 255);
      frame.network_management = reader.boolean(*extension, "ttf:NETWORK-MANAGEMENT", false);
      if (extension->has("ttf:MESSAGE-ID")) frame.message_id = reader.integer(*extension, "ttf:MESSAGE-ID", 0, 65535);
      extension->finish();
    }
    element.finish();
    frames.push_back(std::move(frame));
  }
  return frames;
}

}  // namespace ttf::schedules::exchange::fibex
