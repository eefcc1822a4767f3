// SPDX-License-Identifier: Apache-2.0
// A sheet of four views with dimensions and a title block: four_views part.stl part.pdf
#include <frontmost/frontmost.h>

#include <cstdio>

using namespace frontmost;

int main(int count, char** arguments) try {
  if (count != 3) throw Error(ErrorCode::bad_argument, "give MODEL DRAWING");
  const Scene scene = load(arguments[1]);
  const Surfaces surfaces(scene);
  const Sheet sheet =
      draw_sheet(surfaces, {.views = {NamedView::front, NamedView::top, NamedView::left, NamedView::iso},
                            .dimensions = frontmost::Dimensioning::diameters,
                            .hidden = HiddenLines::dashed,
                            .page = named_paper("a3"),
                            .title_block = TitleBlock{.title = scene.name, .author = "E. Example"}});
  save(sheet.page, arguments[2]);
  std::printf("%zu views at %s\n", sheet.views.size(), scale_text(*sheet.scale).c_str());
} catch (const Error& error) {
  std::fprintf(stderr, "four_views: %s\n", error.what());
  return 1;
}
