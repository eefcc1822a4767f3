// SPDX-License-Identifier: Apache-2.0
// The parser is C code and calls back into this class. Exceptions must not pass through it, so one is kept until it
// returns.
//
// Memory is bounded for any text. Document types are refused, and with them all entities that would grow on use. Tags,
// levels and different names have limits, because the parser keeps data about them.
#include "io/models/threemf/xml_part.h"

#include <expat.h>

#include "io/models/model_source.h"

namespace frontmost::threemf {
namespace {

constexpr std::size_t longest_tag = std::size_t(1) << 20, most_names = 4096;
constexpr int most_tag_levels = 256;

}  // namespace

/// The parser's callbacks, each with its XmlPart as user data. Exceptions are kept, because C code lies between.
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
      part.note_names(name, attributes);
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

void XmlPart::note_names(std::string_view element, const char** attributes) {
  note(element);
  for (const char** p = attributes; *p != nullptr; p += 2) note(*p);
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
  if (since_event_ > longest_tag) source_.fail_limit(place(), "a tag of more than a megabyte");
}

}  // namespace frontmost::threemf
