// SPDX-License-Identifier: Apache-2.0
// Files of the last view, made by the library's own writers in the module's memory, from which the page takes them.
#include <frontmost/sheets.h>

#include "web/exr.h"
#include "web/workbench.h"

namespace frontmost::web {
namespace {

Sheet drawing_of(const Surfaces& surfaces, const View& view, const PlainJson& question) {
  SheetOptions options;
  options.hidden = question.value("hidden", false) ? HiddenLines::dashed : HiddenLines::none;
  return draw_view(surfaces, view, options);
}

Image map_of(const Surfaces& surfaces, const Visible& visible, const std::string& map) {
  if (map == "depth") return depth_image(visible);
  if (map == "normals") return normal_image(surfaces, visible);
  if (map == "primitives") return id_image(surfaces, visible, IdKind::primitive);
  if (map == "objects") return id_image(surfaces, visible, IdKind::object);
  if (map == "materials") return id_image(surfaces, visible, IdKind::material);
  throw Error(ErrorCode::bad_argument, "map", "there is no '" + map + "'");
}

}  // namespace

PlainJson Workbench::write(const PlainJson& question) {
  const Surfaces& surfaces = model().surfaces;
  const Visible& visible = seen();
  const std::string what = question.at("what"), format = question.at("format"), path = "/file." + format;
  if (format == "exr") {
    file_ = exr_bytes(map_of(surfaces, visible, what));
    return {{"file", place_of(file_.data(), file_.size())}};
  }
  View view = view_;
  view.samples = 1;
  if (what == "lines") {
    save(drawing_of(surfaces, view, question).page, path);
  } else if (what == "figure") {
    FigureOptions options;
    options.shade.background.reset();
    save(draw_figure(surfaces, view, options), path);
  } else {
    save(map_of(surfaces, visible, what), path);
  }
  constexpr std::uint64_t most_bytes = std::uint64_t(1) << 30;
  file_ = load_text(path, most_bytes);
  std::remove(path.c_str());
  return {{"file", place_of(file_.data(), file_.size())}};
}

}  // namespace frontmost::web
