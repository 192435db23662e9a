// A strict reader of XML: what nobody asked for is named by its path and line, never silently dropped.
//
// clang-format off
//   XmlFile file = XmlFile::load("cluster.xml");   // throws InputError on unreadable or damaged XML, with its line
//   Findings left_out;
//   XmlElement root = file.root(left_out);
//   for (XmlElement& one : root.children("fx:CLUSTER")) { ...; one.finish(); }
//   root.finish();                                 // names elements, attributes and text nobody asked for
// clang-format on
//
// Elements are called by the customary prefix of their namespace (fx, ho, flexray), whatever prefix the file
// gave it.
#pragma once

#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"

namespace ttf::schedules::exchange::fibex {

// Namespaces and the prefixes elements are called by here. Elements of other namespaces keep the prefix the
// file gave them.
struct XmlNamespace {
  std::string_view prefix;
  std::string_view name;
};
inline constexpr XmlNamespace kFibexNamespaces[] = {
    {"fx", "http://www.asam.net/xml/fbx"},
    {"ho", "http://www.asam.net/xml"},
    {"flexray", "http://www.asam.net/xml/fbx/flexray"},
    {"xsi", "http://www.w3.org/2001/XMLSchema-instance"},
    {"ttf", "urn:ttfusion:fibex"},
};

class XmlElement {
 public:
  bool has(std::string_view name) const;
  // The child of that name; if there are more, they stay unasked for, and are named.
  std::optional<XmlElement> child(std::string_view name);
  std::vector<XmlElement> children(std::string_view name);
  // children("fx:CLUSTER") of the child "fx:CLUSTERS"; none where it is absent.
  std::vector<XmlElement> children_of(std::string_view list, std::string_view name);
  // Text of the child, without the space around it; nothing where there is no such child.
  std::optional<std::string> text_of(std::string_view name);
  // The child's attribute ID-REF; empty where either is absent.
  std::string reference(std::string_view name);
  // This element's text without the space around it.
  std::string text();
  // Of an attribute; empty where it is absent.
  std::string attribute(std::string_view name);
  // Known, and deliberately without effect here.
  void ignore(std::string_view name) { asked_.emplace_back(name); }

  // All child elements, in the order of the file; none of them counts as asked for.
  std::vector<XmlElement> elements() const;

  std::string name() const;
  std::string path() const;
  int line() const;

  // Adds what nobody asked for to the findings of root().
  void finish();

 private:
  friend class XmlFile;
  struct Content;
  XmlElement(std::shared_ptr<const Content> content, pugi::xml_node node, Findings* left_out)
      : content_(std::move(content)), node_(node), left_out_(left_out) {}
  bool is_asked(std::string_view name) const;
  void leave_out(std::string path, int line);

  std::shared_ptr<const Content> content_;
  pugi::xml_node node_;
  Findings* left_out_;
  std::vector<std::string> asked_;  // children by name, attributes as "@name"
  bool text_asked_ = false;
};

class XmlFile {
 public:
  static XmlFile load(const std::string& path);
  static XmlFile parse(std::string text, std::string name);

  XmlElement root(Findings& left_out) const;
  const std::string& name() const;

 private:
  XmlFile() = default;
  std::shared_ptr<const XmlElement::Content> content_;
};

}  // namespace ttf::schedules::exchange::fibex
