// SPDX-License-Identifier: Apache-2.0
// The stream of a page's operators in a PDF file: compressed by zlib, or plain in builds without it.
#pragma once

#include <memory>
#include <string_view>

#include "pages/page_text.h"

namespace frontmost::detail {

/// The filter entry in the dictionary of such a stream, with a space at the end; empty if it is not compressed.
extern const std::string_view pdf_stream_filter;

class PdfStream final : public ByteSink {
 public:
  /// Keeps a reference to `out`.
  explicit PdfStream(PageText& out);
  ~PdfStream() override;
  PdfStream(const PdfStream&) = delete;
  PdfStream& operator=(const PdfStream&) = delete;

  void write(std::string_view bytes) override;
  /// Ends the stream; nothing may be written after it.
  void finish();

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace frontmost::detail
