// SPDX-License-Identifier: Apache-2.0
// Unpacks and parses parts piece by piece. The unpacked size is checked against a limit for archives of this size
// before memory is allocated: a kilobyte of zip can hold a megabyte of blanks.
//
// The XML parser is C code and calls back into XmlPart. Exceptions must not pass through the parser, so an exception is
// kept until the parser returns. Memory is bounded for any text. Document types are refused, and with them all entities
// that would grow on use. Tags, levels and different names have limits, because the parser keeps data about them.
#include <expat.h>
#include <zip.h>

#include <algorithm>

#include "base/parallel.h"
#include "io/models/reader.h"
#include "io/models/threemf/threemf.h"

namespace frontmost::threemf {
namespace {

// Models are 4 to 30 times as large as their archives. Each byte of the file allows 64 unpacked bytes; 256 MiB more are
// free.
constexpr std::uint64_t free_bytes = std::uint64_t(1) << 28, bytes_per_byte = 64;

struct CloseFile {
  void operator()(zip_file* file) const { zip_fclose(file); }
};

constexpr std::size_t longest_tag = std::size_t(1) << 20, most_names = 4096;
constexpr int most_tag_levels = 256;

/// A tag that names a part, and the kind that the tag must state if the part is the model.
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

  /// Returns the named part, or an empty text if there is none, or before read().
  [[nodiscard]] const std::string& found() const { return found_; }

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

std::string part_name(std::string_view reference) {
  std::string name(reference);
  std::replace(name.begin(), name.end(), '\\', '/');
  name.erase(0, std::min(name.find_first_not_of('/'), name.size()));
  return name;
}

std::string Package::key_of(const std::string& part) {
  std::string key = part_name(part);
  for (char& c : key)
    if (c >= 'A' && c <= 'Z') c = char(c - 'A' + 'a');
  return key;
}

void Package::Close::operator()(zip* archive) const { zip_discard(archive); }

Package::Package(Bytes bytes, const ModelSource& source)
    : source_(source), most_(free_bytes + bytes_per_byte * bytes.size()) {
  zip_error_t error;
  zip_error_init(&error);
  zip_source_t* const contents = zip_source_buffer_create(bytes.data(), bytes.size(), 0, &error);
  if (contents != nullptr) archive_.reset(zip_open_from_source(contents, ZIP_RDONLY, &error));
  if (!archive_) {
    const std::string why = zip_error_strerror(&error);
    zip_error_fini(&error);
    if (contents != nullptr) zip_source_free(contents);
    source.fail("zip archive", why + "; the file may have been cut short");
  }
  zip_error_fini(&error);
  const zip_int64_t count = zip_get_num_entries(archive_.get(), 0);
  for (zip_int64_t i = 0; i < count; ++i)
    // The first of several parts with one name counts.
    if (const char* const name = zip_get_name(archive_.get(), zip_uint64_t(i), ZIP_FL_ENC_RAW))
      numbers_.try_emplace(key_of(name), std::uint64_t(i));
}

void Package::unpack(const std::string& part, const std::function<void(std::string_view, bool)>& receive) {
  const std::string place = printable(part);
  const auto found = numbers_.find(key_of(part));
  if (found == numbers_.end()) source_.fail(place, "there is no such part in the archive");
  const std::uint64_t number = found->second;
  zip_stat_t stated;
  zip_stat_init(&stated);
  const bool is_stated = zip_stat_index(archive_.get(), number, 0, &stated) == 0 && (stated.valid & ZIP_STAT_SIZE) != 0;
  if (is_stated && stated.size > most_ - unpacked_)
    source_.fail_limit(place, "unpacks to " + std::to_string(stated.size) +
                                  " bytes, far more than an archive of this " + "size should hold");
  const std::unique_ptr<zip_file, CloseFile> file(zip_fopen_index(archive_.get(), number, 0));
  if (!file) source_.fail(place, zip_strerror(archive_.get()));
  std::vector<char> piece(std::size_t(1) << 16);
  const std::uint64_t before = unpacked_;
  for (;;) {
    check_cancelled(source_.execution());
    if (is_stated && stated.size > 0)
      report_progress(source_.execution(), "load", std::min(1.0, double(unpacked_ - before) / double(stated.size)));
    const zip_int64_t size = zip_fread(file.get(), piece.data(), piece.size());
    if (size < 0) source_.fail(place, std::string(zip_file_strerror(file.get())) + "; the archive is damaged");
    // Sizes stated in an archive may be wrong, so the unpacked bytes are counted.
    if (std::uint64_t(size) > most_ - unpacked_)
      source_.fail_limit(place, "unpacks to far more than an archive of this size should hold");
    unpacked_ += std::uint64_t(size);
    receive({piece.data(), std::size_t(size)}, size == 0);
    if (size == 0) return;
  }
}

/// The parser's callbacks, each with its XmlPart as user data.
struct XmlPart::Callbacks {
  template <class Body>
  static void guarded(void* user, const Body& body) {
    XmlPart& part = *static_cast<XmlPart*>(user);
    part.since_event_ = 0;
    if (part.failure_) return;
    try {
      body(part);
    } catch (...) {
      part.failure_ = std::current_exception();
      XML_StopParser(part.parser_.get(), XML_FALSE);
    }
  }

  static void start(void* user, const char* name, const char** attributes) {
    guarded(user, [&](XmlPart& part) {
      if (++part.depth_ > most_tag_levels)
        part.source_.fail_limit(part.place(), "tags within more than " + std::to_string(most_tag_levels) + " others");
      part.note(name);
      for (const char** p = attributes; *p != nullptr; p += 2) part.note(*p);
      part.start(name, Attributes(attributes));
    });
  }
  static void end(void* user, const char*) {
    guarded(user, [&](XmlPart& part) {
      --part.depth_;
      part.end();
    });
  }
  static void declare(void* user, const char* prefix, const char* space) {
    guarded(user, [&](XmlPart& part) {
      const std::string_view name(prefix == nullptr ? "" : prefix);
      part.note(name);
      part.declare(name, space == nullptr ? "" : space);
    });
  }
  static void other(void* user, const char*, int) {
    guarded(user, [](XmlPart&) {});
  }
  static void document_type(void* user, const char*, const char*, const char*, int) {
    guarded(user, [](XmlPart& part) { part.fail("has a document type, which 3MF forbids"); });
  }
};

void XmlPart::Free::operator()(XML_ParserStruct* parser) const { XML_ParserFree(parser); }

XmlPart::XmlPart(std::string name, const ModelSource& source)
    : name_(std::move(name)), source_(source), parser_(XML_ParserCreateNS(nullptr, '|')) {
  if (!parser_) throw std::bad_alloc();
  XML_SetUserData(parser_.get(), this);
  XML_SetElementHandler(parser_.get(), Callbacks::start, Callbacks::end);
  XML_SetStartNamespaceDeclHandler(parser_.get(), Callbacks::declare);
  XML_SetStartDoctypeDeclHandler(parser_.get(), Callbacks::document_type);
  // Text and comments are not used, but show that the parser makes progress.
  XML_SetDefaultHandler(parser_.get(), Callbacks::other);
}

XmlPart::~XmlPart() = default;

std::size_t XmlPart::line() const { return XML_GetCurrentLineNumber(parser_.get()); }

std::string XmlPart::place() const { return printable(name_) + ": line " + std::to_string(line()); }

void XmlPart::read(Package& package) {
  package.unpack(name_, [this](std::string_view text, bool is_last) { feed(text, is_last); });
}

/// Counts different names, because the parser keeps each one.
void XmlPart::note(std::string_view name) {
  if (names_.find(name) != names_.end()) return;
  if (names_.size() == most_names)
    source_.fail_limit(place(), "more than " + std::to_string(most_names) + " different names");
  names_.emplace(name);
}

void XmlPart::feed(std::string_view text, bool is_last) {
  since_event_ += text.size();
  const XML_Status status = XML_Parse(parser_.get(), text.data(), int(text.size()), is_last ? XML_TRUE : XML_FALSE);
  if (failure_) std::rethrow_exception(failure_);
  if (status != XML_STATUS_OK) fail(XML_ErrorString(XML_GetErrorCode(parser_.get())));
  // The parser holds a tag in memory until the tag ends.
  if (since_event_ > longest_tag) source_.fail_limit(place(), "a tag is longer than a megabyte");
}

std::string find_start_part(Package& package, const ModelSource& source) {
  for (const Naming& naming : namings) {
    if (!package.has(naming.part)) continue;
    NamingReader reader(naming, source);
    reader.read(package);
    if (!reader.found().empty()) return reader.found();
  }
  source.fail("_rels/.rels", "the archive names no part as its 3D model, so the file is not 3MF");
}

}  // namespace frontmost::threemf
