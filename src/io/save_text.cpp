// SPDX-License-Identifier: Apache-2.0
#include "frontmost/io.h"
#include "io/output_file.h"

namespace frontmost {

void save_text(std::string_view text, const std::string& path) {
  OutputFile file(path);
  file.write(std::as_bytes(std::span(text.data(), text.size())));
  file.commit();
}

}  // namespace frontmost
