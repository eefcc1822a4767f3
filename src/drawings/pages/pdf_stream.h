// SPDX-License-Identifier: Apache-2.0
// The operators of a page on their way into a PDF file: compressed by zlib, or as they are in builds without it.
#pragma once

#include <memory>
#include <string_view>

#include "pages/page_text.h"

namespace frontmost::detail {

/// What the dictionary of such a stream says of it, with a space at the end; nothing where it is not compressed.
extern const std::string_view pdf_stream_filter;

class PdfStream final : public ByteSink {
 public:
  /// Keeps a reference to what it writes to.
  explicit PdfStream(PageText& out);
  ~PdfStream() override;
  PdfStream(const PdfStream&) = delete;
  PdfStream& operator=(const PdfStream&) = delete;

  void write(std::string_view bytes) override;
  /// Nothing is written after it.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frontmost::detail
