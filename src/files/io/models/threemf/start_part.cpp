// SPDX-License-Identifier: Apache-2.0
// Finds the model's part: by the package's relationships or, if these name none, by the content types. Both are XML,
// read by the same reader as the model.
#include "io/models/threemf/package.h"
#include "io/models/threemf/xml_part.h"

namespace frontmost::threemf {
namespace {

/// A tag that names a part, and the kind that it must state for the model.
struct Naming {
  const char* part;
  std::string_view tag, kind_attribute, kind, name_attribute;
};
constexpr Naming namings[] = {
    {"_rels/.rels", "http://schemas.openxmlformats.org/package/2006/relationships|Relationship", "Type",
     "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel", "Target"},
    {"[Content_Types].xml", "http://schemas.openxmlformats.org/package/2006/content-types|Override", "ContentType",
     "application/vnd.ms-package.3dmanufacturing-3dmodel+xml", "PartName"}};

class NamingReader : public XmlPart {
 public:
  NamingReader(const Naming& naming, const ModelSource& source) : XmlPart(naming.part, source), naming_(naming) {}

  /// The named part; empty if there is none.
  std::string find(Package& package) {
    read(package);
    return found_;
  }

 protected:
  void start(std::string_view name, const Attributes& attributes) override {
    if (!found_.empty() || name != naming_.tag) return;
    const char* const kind = attributes.find(naming_.kind_attribute);
    const char* const part = attributes.find(naming_.name_attribute);
    if (kind != nullptr && part != nullptr && kind == naming_.kind) found_ = part_name(part);
  }
  void end() override {}

 private:
  const Naming& naming_;
  std::string found_;
};

}  // namespace

std::string find_start_part(Package& package, const ModelSource& source) {
  for (const Naming& naming : namings) {
    if (!package.has(naming.part)) continue;
    const std::string part = NamingReader(naming, source).find(package);
    if (!part.empty()) return part;
  }
  source.fail("_rels/.rels", "no part of the archive is said to be a 3D model, so it is no 3MF file");
}

}  // namespace frontmost::threemf
