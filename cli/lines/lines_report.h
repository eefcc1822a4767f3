// SPDX-License-Identifier: Apache-2.0
// What frontmost lines says about a drawing.
#pragma once

#include <frontmost/section.h>
#include <frontmost/sheet_view.h>
#include <frontmost/surfaces.h>

#include <memory>
#include <string>
#include <vector>

#include "cli/json_numbers.h"
#include "cli/settings.h"

namespace frontmost::cli {

/// A section, and where it was cut.
struct CutView {
  Section section;
  CuttingPlane plane;
  std::string letter;  ///< "A"
};

/// One view, from its camera to its strokes.
struct DrawnView {
  std::string name;
  std::unique_ptr<const Scene> tessellated;  ///< where curved surfaces were for this view
  std::unique_ptr<const CutView> cut;        ///< where it is a section
  std::unique_ptr<const Surfaces> own;
  const Surfaces* surfaces = nullptr;  ///< what the drawing's ids mean
  Drawing drawing;
  double millimetres_per_unit = 1;       ///< of the model
  double millimetres_per_pixel = 1;      ///< at scale 1:1; in perspective of no meaning by itself
  std::shared_ptr<const Rounds> rounds;  ///< of the surfaces; null where they are not asked for
  bool keeps_frame = false;              ///< the camera was placed: the picture's rectangle counts, not what is in it
  bool shows_hidden = true;              ///< where hidden edges are drawn at all
  std::optional<NamedView> named;        ///< of sheets
  SheetView sheet{};
  glm::dvec2 taken{0};  ///< millimetres of paper on its left and below it that marks of sections take
};

struct LinesTimings {
  double lines = 0, rounds = 0, strokes = 0, tones = 0, write = 0;
};

/// `scale` is null in perspective.
[[nodiscard]] Json lines_json(const Settings& settings, const std::vector<DrawnView>& views, const Page& page,
                              std::optional<double> scale, const LinesTimings& timings);

}  // namespace frontmost::cli
