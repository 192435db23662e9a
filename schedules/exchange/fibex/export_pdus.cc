#include "schedules/exchange/fibex/export_pdus.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

namespace ttf::schedules::exchange::fibex {
namespace {

// Returns the units in the order of first use.
std::vector<std::string> units_of(const model::Cluster& cluster) {
  std::vector<std::string> units;
  for (const model::PduLayout& pdu : cluster.pdus)
    for (const auto* signals : {&pdu.header, &pdu.element})
      for (const model::Signal& signal : *signals)
        if (!signal.unit.empty() && std::find(units.begin(), units.end(), signal.unit) == units.end())
          units.push_back(signal.unit);
  return units;
}

std::string unit_id(const std::vector<std::string>& units, const std::string& unit) {
  return fmt::format("unit_{}", std::find(units.begin(), units.end(), unit) - units.begin());
}

std::string header_id(std::size_t pdu) { return fmt::format("pdu_{}_header", pdu); }
std::string elements_id(std::size_t pdu) { return fmt::format("pdu_{}_elements", pdu); }
std::string header_signal_id(std::size_t pdu, std::size_t signal) {
  return fmt::format("signal_{}_header_{}", pdu, signal);
}
std::string element_signal_id(std::size_t pdu, std::size_t signal, int element) {
  return fmt::format("signal_{}_element_{}_{}", pdu, signal, element);
}
std::string coding_id(std::size_t pdu, bool header, std::size_t signal) {
  return fmt::format("coding_{}_{}_{}", pdu, header ? "header" : "element", signal);
}

// Returns the position of a signal with its most significant bit `offset` bits from the start: sawtooth
// counting, high-low order.
int position_of(int offset) { return offset / 8 * 8 + 7 - offset % 8; }

void put_instance(pugi::xml_node to, const std::string& signal, int offset) {
  pugi::xml_node one = to.append_child("fx:SIGNAL-INSTANCE");
  one.append_attribute("ID") = ("instance_of_" + signal).c_str();
  put(one, "fx:BIT-POSITION", std::to_string(position_of(offset)));
  put(one, "fx:IS-HIGH-LOW-BYTE-ORDER", "true");
  put_reference(one, "fx:SIGNAL-REF", signal);
}

pugi::xml_node put_pdu(pugi::xml_node pdus, const std::string& id, const std::string& name, int bytes) {
  pugi::xml_node one = put_named(pdus, "fx:PDU", id, name);
  put(one, "fx:BYTE-LENGTH", std::to_string(bytes));
  put(one, "fx:PDU-TYPE", "APPLICATION");
  return one;
}

// Whole bytes are the same in either byte order.
void put_segment(pugi::xml_node part, int first_bit, int bits) {
  pugi::xml_node segment = part.append_child("fx:SEGMENT-POSITIONS").append_child("fx:SEGMENT-POSITION");
  put(segment, "fx:BIT-POSITION", std::to_string(first_bit));
  put(segment, "fx:IS-HIGH-LOW-BYTE-ORDER", "false");
  put(segment, "ho:BIT-LENGTH", std::to_string(bits));
}

void put_multiplexer(pugi::xml_node multiplexer, const model::PduLayout& layout, std::size_t index) {
  const model::Signal& fragment = layout.header[*find_signal(layout.header, "fragment")];
  pugi::xml_node selector = put_named(multiplexer, "fx:SWITCH", fmt::format("switch_{}", index), "fragment");
  put(selector, "fx:BIT-POSITION", std::to_string(position_of(fragment.bit_offset)));
  put(selector, "fx:IS-HIGH-LOW-BYTE-ORDER", "true");
  put(selector, "ho:BIT-LENGTH", std::to_string(fragment.bits));
  pugi::xml_node dynamic =
      put_named(multiplexer, "fx:DYNAMIC-PART", fmt::format("dynamic_part_{}", index), layout.name + "_fragments");
  put_segment(dynamic, layout.header_bits, 8 * layout.fragment_bytes - layout.header_bits);
  pugi::xml_node instances = dynamic.append_child("fx:SWITCHED-PDU-INSTANCES");
  for (int f = 0; f < layout.max_fragments(); ++f) {
    pugi::xml_node one = instances.append_child("fx:SWITCHED-PDU-INSTANCE");
    one.append_attribute("ID") = fmt::format("switched_{}_{}", index, f).c_str();
    put_reference(one, "fx:PDU-REF", elements_id(index));
    put(one, "fx:SWITCH-CODE", std::to_string(f));
  }
  pugi::xml_node fixed =
      put_named(multiplexer, "fx:STATIC-PART", fmt::format("static_part_{}", index), layout.name + "_first_bytes");
  put_segment(fixed, 0, layout.header_bits);
  pugi::xml_node instance = fixed.append_child("fx:STATIC-PDU-INSTANCE");
  instance.append_attribute("ID") = fmt::format("static_{}", index).c_str();
  put_reference(instance, "fx:PDU-REF", header_id(index));
}

void put_coding(pugi::xml_node codings, const std::string& id, const std::string& name, const model::Signal& signal,
                const std::vector<std::string>& units) {
  pugi::xml_node coding = put_named(codings, "fx:CODING", id, name);
  pugi::xml_node type = coding.append_child("ho:CODED-TYPE");
  type.append_attribute("ho:BASE-DATA-TYPE") = signal.bits <= 8    ? "A_UINT8"
                                               : signal.bits <= 16 ? "A_UINT16"
                                                                   : "A_UINT32";
  type.append_attribute("CATEGORY") = "STANDARD-LENGTH-TYPE";
  type.append_attribute("ENCODING") = "UNSIGNED";
  put(type, "ho:BIT-LENGTH", std::to_string(signal.bits));
  pugi::xml_node method = coding.append_child("ho:COMPU-METHODS").append_child("ho:COMPU-METHOD");
  put(method, "ho:SHORT-NAME", name);
  put(method, "ho:CATEGORY", "LINEAR");
  if (!signal.unit.empty()) put_reference(method, "ho:UNIT-REF", unit_id(units, signal.unit));
  pugi::xml_node range = method.append_child("ho:PHYS-CONSTRS").append_child("ho:SCALE-CONSTR");
  range.append_attribute("VALIDITY") = "VALID";
  const auto limit = [&](const char* which, double value) {
    put(range, which, fmt::format("{}", value)).append_attribute("INTERVAL-TYPE") = "CLOSED";
  };
  limit("ho:LOWER-LIMIT", signal.low);
  limit("ho:UPPER-LIMIT", signal.high);
  // physical = (low + resolution * raw) / 1, as the shortest decimals that parse to the same numbers.
  pugi::xml_node coefficients = method.append_child("ho:COMPU-INTERNAL-TO-PHYS")
                                    .append_child("ho:COMPU-SCALES")
                                    .append_child("ho:COMPU-SCALE")
                                    .append_child("ho:COMPU-RATIONAL-COEFFS");
  pugi::xml_node numerator = coefficients.append_child("ho:COMPU-NUMERATOR");
  put(numerator, "ho:V", fmt::format("{}", signal.low));
  put(numerator, "ho:V", fmt::format("{}", signal.resolution));
  put(coefficients.append_child("ho:COMPU-DENOMINATOR"), "ho:V", "1");
}

}  // namespace

pugi::xml_node put(pugi::xml_node to, std::string_view name, const std::string& text) {
  pugi::xml_node child = to.append_child(std::string(name).c_str());
  child.append_child(pugi::node_pcdata).set_value(text.c_str());
  return child;
}

pugi::xml_node put_reference(pugi::xml_node to, std::string_view name, const std::string& id) {
  pugi::xml_node child = to.append_child(std::string(name).c_str());
  child.append_attribute("ID-REF") = id.c_str();
  return child;
}

pugi::xml_node put_named(pugi::xml_node to, std::string_view name, const std::string& id, const std::string& short_name,
                         const char* type) {
  pugi::xml_node child = to.append_child(std::string(name).c_str());
  child.append_attribute("ID") = id.c_str();
  if (type != nullptr) child.append_attribute("xsi:type") = type;
  put(child, "ho:SHORT-NAME", short_name);
  return child;
}

std::string fibex_pdu_id(PduId pdu) { return fmt::format("pdu_{}", index_of(pdu)); }

void put_fibex_pdus(pugi::xml_node pdus, const model::Cluster& cluster) {
  for (std::size_t i = 0; i < cluster.pdus.size(); ++i) {
    const model::PduLayout& layout = cluster.pdus[i];
    pugi::xml_node header = put_pdu(pdus, header_id(i), layout.name + "_header", layout.header_bits / 8)
                                .append_child("fx:SIGNAL-INSTANCES");
    for (std::size_t s = 0; s < layout.header.size(); ++s)
      put_instance(header, header_signal_id(i, s), layout.header[s].bit_offset);
    pugi::xml_node elements =
        put_pdu(pdus, elements_id(i), layout.name + "_elements", layout.fragment_bytes - layout.header_bits / 8)
            .append_child("fx:SIGNAL-INSTANCES");
    for (int e = 0; e < layout.elements_per_fragment; ++e)
      for (std::size_t s = 0; s < layout.element.size(); ++s)
        put_instance(elements, element_signal_id(i, s, e), e * layout.element_bits + layout.element[s].bit_offset);
    pugi::xml_node list = put_pdu(pdus, fibex_pdu_id(static_cast<PduId>(i)), layout.name, layout.fragment_bytes);
    put_multiplexer(list.append_child("fx:MULTIPLEXER"), layout, i);
    put(list.append_child("fx:MANUFACTURER-EXTENSION"), "ttf:MAX-ELEMENTS", std::to_string(layout.max_elements));
  }
}

void put_fibex_signals(pugi::xml_node signals, const model::Cluster& cluster) {
  for (std::size_t i = 0; i < cluster.pdus.size(); ++i) {
    const model::PduLayout& layout = cluster.pdus[i];
    for (std::size_t s = 0; s < layout.header.size(); ++s)
      put_reference(put_named(signals, "fx:SIGNAL", header_signal_id(i, s), layout.header[s].name), "fx:CODING-REF",
                    coding_id(i, true, s));
    for (int e = 0; e < layout.elements_per_fragment; ++e)
      for (std::size_t s = 0; s < layout.element.size(); ++s)
        put_reference(put_named(signals, "fx:SIGNAL", element_signal_id(i, s, e),
                                fmt::format("{}_{}", layout.element[s].name, e)),
                      "fx:CODING-REF", coding_id(i, false, s));
  }
}

void put_fibex_codings(pugi::xml_node processing, const model::Cluster& cluster) {
  const std::vector<std::string> units = units_of(cluster);
  pugi::xml_node unit_list = processing.append_child("ho:UNIT-SPEC").append_child("ho:UNITS");
  for (std::size_t i = 0; i < units.size(); ++i)
    put(put_named(unit_list, "ho:UNIT", fmt::format("unit_{}", i), fmt::format("unit_{}", i)), "ho:DISPLAY-NAME",
        units[i]);
  pugi::xml_node codings = processing.append_child("fx:CODINGS");
  for (std::size_t i = 0; i < cluster.pdus.size(); ++i)
    for (const bool header : {true, false}) {
      const std::vector<model::Signal>& signals = header ? cluster.pdus[i].header : cluster.pdus[i].element;
      for (std::size_t s = 0; s < signals.size(); ++s)
        put_coding(codings, coding_id(i, header, s), fmt::format("{}_{}", cluster.pdus[i].name, signals[s].name),
                   signals[s], units);
    }
}

}  // namespace ttf::schedules::exchange::fibex
