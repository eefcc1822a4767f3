// SPDX-License-Identifier: Apache-2.0
// Replaces pdf_stream.cpp in builds without zlib: streams are not compressed.
#include "pages/pdf_stream.h"

namespace frontmost::detail {

const std::string_view pdf_stream_filter = "";

struct PdfStream::State {
  PageText& out;
};

PdfStream::PdfStream(PageText& out) : state_(new State{out}) {}
PdfStream::~PdfStream() = default;
void PdfStream::write(std::string_view bytes) { state_->out << bytes; }
void PdfStream::finish() {}

}  // namespace frontmost::detail
