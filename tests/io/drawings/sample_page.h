// SPDX-License-Identifier: Apache-2.0
// A page with one of each kind of path, and helpers that read files back.
#pragma once

#include <zlib.h>

#include "frontmost/sheets.h"
#include "support/scratch_folder.h"

namespace frontmost::test {

/// A page of 100 x 50 mm: a dashed open line, a triangle, an arc, a circle and a dot.
inline Page sample_page() {
  Page page{100, 50, "Sample", {}};
  PageGroup dashed{"axle", {0.25, {}, {3, 0.75}}};
  dashed.add(std::vector<glm::dvec2>{{10, 10}, {20, 10}, {20.5, 12.3456}}, false);
  PageGroup solid{"wheel", {0.5, {255, 0, 0}}};
  solid.add(std::vector<glm::dvec2>{{0, 0}, {5, 0}, {0, 5}}, true);
  solid.add(std::vector<glm::dvec2>{{1, 1}, {2, 3}}, false);
  PageGroup round{"ring", {0.13, {}}};
  round.points = {{60, 20}, {50, 30}, {40, 20}, {60, 20}, {5, 5}};
  round.bulges = {0.41421356237309503, 0, 1, 1, 0};  // a quarter from +x to +y about (50, 20); two halves of a circle
  round.paths = {{0, 2, false}, {2, 2, true}, {4, 1, false}};
  page.layers = {{"1 hidden", {dashed}}, {"2 visible", {solid, round}}};
  return page;
}

/// The bytes of the page's file.
inline std::string saved(const Page& page, PageFormat format, const Execution& execution = {}) {
  const ScratchFolder folder;
  save(page, folder.file("page"), format, execution);
  return read_text(folder.file("page"));
}

/// The drawing operators of a PDF.
inline std::string operators_of(const std::string& pdf) {
  const std::size_t begin = pdf.find("stream\n") + 7, end = pdf.find("\nendstream");
  std::string operators(std::size_t(1) << 22, '\0');
  uLongf size = operators.size();
  EXPECT_EQ(::uncompress(reinterpret_cast<Bytef*>(operators.data()), &size,
                         reinterpret_cast<const Bytef*>(pdf.data() + begin), end - begin),
            Z_OK);
  operators.resize(size);
  return operators;
}

}  // namespace frontmost::test
