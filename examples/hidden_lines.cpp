// SPDX-License-Identifier: Apache-2.0
// A hidden-line drawing in millimetres, hidden edges dashed: hidden_lines part.stl part.svg
#include <frontmost/frontmost.h>

#include <cstdio>

using namespace frontmost;

int main(int count, char** arguments) try {
  if (count != 3) throw Error(ErrorCode::bad_argument, "give MODEL DRAWING");
  const Scene scene = load(arguments[1]);
  const Surfaces surfaces(scene);
  const View view = frame(surfaces, 3840, 2160, {.direction = NamedView::iso, .orthographic = true});
  const Sheet sheet = draw_view(surfaces, view, {.hidden = HiddenLines::dashed, .standard_scale = true});
  save(sheet.page, arguments[2]);
  std::printf("%s on %g x %g mm\n", scale_text(*sheet.scale).c_str(), sheet.page.width, sheet.page.height);
} catch (const Error& error) {
  std::fprintf(stderr, "hidden_lines: %s\n", error.what());
  return 1;
}
