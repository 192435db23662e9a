// A strict reader of XML: content that was not read is reported with its path and line, never silently dropped.
//
// clang-format off
//   XmlFile file = XmlFile::load("cluster.xml");   // throws InputError on unreadable or damaged XML, with its line
//   Findings left_out;
//   XmlElement root = file.root(left_out);
//   for (XmlElement& one : root.children("fx:CLUSTER")) { ...; one.finish(); }
//   root.finish();                                 // reports elements, attributes and text that were not read
// clang-format on
//
// Elements are named with the customary prefix of their namespace (fx, ho, flexray), whatever prefix the file
// uses.
#pragma once

#include <memory>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "core/errors.h"

namespace ttf::schedules::exchange::fibex {

// The namespaces and their prefixes in this program. Elements of other namespaces keep the prefix of the file.
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
  // Returns the first child of that name. Further ones count as not read and are reported.
  std::optional<XmlElement> child(std::string_view name);
  std::vector<XmlElement> children(std::string_view name);
  // Returns children("fx:CLUSTER") of the child "fx:CLUSTERS"; empty if that is absent.
  std::vector<XmlElement> children_of(std::string_view list, std::string_view name);
  // Returns the text of the child without surrounding space; nullopt for an absent child.
  std::optional<std::string> text_of(std::string_view name);
  // Returns the child's attribute ID-REF; empty if either is absent.
  std::string reference(std::string_view name);
  // Returns this element's text without surrounding space.
  std::string text();
  // Returns the value of an attribute; empty if it is absent.
  std::string attribute(std::string_view name);
  // Marks an element as read although it has no effect here.
  void ignore(std::string_view name) { asked_.emplace_back(name); }

  // Returns all child elements in the order of the file, without marking them as read.
  std::vector<XmlElement> elements() const;

  std::string name() const;
  std::string path() const;
  int line() const;

  // Adds all content that was not read to the findings of root().
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
