// SPDX-License-Identifier: Apache-2.0
// 3MF: the zip archive, its parts, most of which are XML, and the contents of model parts. Parts are found by name, and
// unpacked and parsed piece by piece, so that no part is ever in memory as a whole.
//
//   _rels/.rels               says which part is the model
//   3D/3dmodel.model          the model: XML
//   3D/Objects/lid.model      a part that the model refers to
//   Metadata/...              not read
#pragma once

#include <array>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include "io/models/reader.h"

struct zip;
struct XML_ParserStruct;

namespace frontmost::threemf {

/// Returns a part's name without its leading slash, for messages and for Package: "3D/3dmodel.model".
[[nodiscard]] std::string part_name(std::string_view reference);

class Package {
 public:
  /// Opens an archive. Borrows the bytes and the source. \throws Error file_malformed if the bytes are no zip archive,
  /// or a truncated one.
  Package(Bytes bytes, const ModelSource& source);

  [[nodiscard]] bool has(const std::string& part) const { return numbers_.count(key_of(part)) > 0; }

  /// Passes the contents of a part to `receive(text, is_last)`, some 64 KiB at a time. \throws Error file_malformed
  /// with the part's name (missing, encrypted, damaged), cancelled, and limit_exceeded before all parts together unpack
  /// to more than the limit for the file's size.
  void unpack(const std::string& part, const std::function<void(std::string_view, bool)>& receive);

 private:
  struct Close {
    void operator()(zip* archive) const;
  };
  /// Returns a part's name in lower case, because names that differ in case only are equal.
  [[nodiscard]] static std::string key_of(const std::string& part);

  const ModelSource& source_;
  std::unique_ptr<zip, Close> archive_;
  std::unordered_map<std::string, std::uint64_t> numbers_;  ///< in the archive, by key
  std::uint64_t most_, unpacked_ = 0;
};

/// The attributes of a tag. Names outside the tag's own namespace are "namespace|name".
class Attributes {
 public:
  explicit Attributes(const char** pairs) : pairs_(pairs) {}
  /// Returns the value of an attribute, or null.
  [[nodiscard]] const char* find(std::string_view name) const {
    for (const char** p = pairs_; *p != nullptr; p += 2)
      if (name == *p) return p[1];
    return nullptr;
  }

 private:
  const char** pairs_;
};

/// Base of readers of XML parts. Derived classes interpret the tags. Text between tags is skipped. Tags of more than a
/// megabyte, more than 256 levels, and more than 4096 different names are refused.
class XmlPart {
 public:
  XmlPart(std::string name, const ModelSource& source);
  virtual ~XmlPart();
  XmlPart(const XmlPart&) = delete;
  XmlPart& operator=(const XmlPart&) = delete;

  /// Reads the part. \throws Error "file: part: line N: reason", and as Package::unpack() does.
  void read(Package& package);

 protected:
  /// Called for each tag that starts. `name` is "namespace|name".
  virtual void start(std::string_view name, const Attributes& attributes) = 0;
  virtual void end() = 0;
  /// Called for each namespace that the next tag declares.
  virtual void declare(std::string_view prefix, std::string_view space) { (void)prefix, (void)space; }

  [[nodiscard]] const std::string& name() const { return name_; }
  [[nodiscard]] const ModelSource& source() const { return source_; }
  [[nodiscard]] std::size_t line() const;
  /// Returns the part and its current line, for messages.
  [[nodiscard]] std::string place() const;
  [[noreturn]] void fail(const std::string& reason) const { source_.fail(place(), reason); }

 private:
  struct Callbacks;
  struct Free {
    void operator()(XML_ParserStruct* parser) const;
  };
  void feed(std::string_view text, bool is_last);
  void note(std::string_view name);

  std::string name_;
  const ModelSource& source_;
  std::unique_ptr<XML_ParserStruct, Free> parser_;
  std::exception_ptr failure_;  ///< thrown by a callback, which must not throw through the parser
  std::size_t since_event_ = 0;
  int depth_ = 0;
  struct Hash : std::hash<std::string_view> {
    using is_transparent = void;
  };
  std::unordered_set<std::string, Hash, std::equal_to<>> names_;
};

/// Returns the model's part, by the package's relationships or, if these name none, by its content types. \throws Error
/// file_malformed if no part is a model.
[[nodiscard]] std::string find_start_part(Package& package, const ModelSource& source);

/// A group of colours or materials. Triangles refer to them by the group's number and an index in the group.
struct PropertyGroup {
  enum class Kind : std::uint8_t { materials, colors, unknown };
  Kind kind = Kind::unknown;
  std::string element;               ///< element name of unknown groups
  std::uint32_t first_material = 0;  ///< number in the scene, for groups of materials
  std::uint32_t count = 0;
  std::vector<glm::vec4> colors;  ///< linear, for groups of colours
};

/// Indices of a triangle's corners in a group: the same for all corners, or one for each. no_index means none.
struct Property {
  std::uint32_t group = no_index;
  std::array<std::uint32_t, 3> corners{no_index, no_index, no_index};
};

/// An object with a transform: a component of another object, or an item to build.
struct PlacedObject {
  std::string part;  ///< empty: this part
  std::uint32_t object = 0;
  glm::dmat4 outer_from_object{1.0};
  std::size_t line = 0;
};

struct Object {
  std::string name;
  std::size_t line = 0;
  std::uint32_t mesh = no_index;              ///< number in the scene; none for objects of components
  Property property;                          ///< for triangles without one of their own
  std::vector<Property> triangle_properties;  ///< one per triangle, or none at all
  std::vector<PlacedObject> components;
};

/// Contents of one model part of a 3MF file: objects, their colours, and the items to build.
///
///   build      item ----> object 7 (components)
///                            component ----> object 3 (mesh)      each with a transform
///                            component ----> object 3 again
///              item ----> object 3
///
///   triangle   property of a group, or the object's own            a material, or a colour for each corner
struct ModelPart {
  std::string name;
  double metres_per_unit = 0.001;
  std::map<std::uint32_t, Object> objects;
  std::map<std::uint32_t, PropertyGroup> groups;
  std::vector<PlacedObject> items;
  std::vector<std::string> warnings;
};

/// Reads a model part. Adds its meshes, without their colours, and its materials to `scene`.
[[nodiscard]] ModelPart read_model_part(const std::string& name, Package& package, const ModelSource& source,
                                        Scene& scene);

}  // namespace frontmost::threemf
