// SPDX-License-Identifier: Apache-2.0
// A scene of three squares whose report can be computed by hand.
#pragma once

#include <glm/glm.hpp>

#include "program.h"

namespace frontmost::test {

class ReportTest : public ProgramTest {
 protected:
  /// Three squares over a picture of ten by ten pixels, one unit a pixel. The far one covers 6 x 6 pixels. The near one
  /// covers 4 x 4: three of these hide the far one, and one column is beyond the frame. The last one is far away.
  ReportTest() { write("squares.obj", squares(0)); }

  /// The squares, moved by `by` along every axis.
  static std::string squares(double by) {
    return square("far", {-3, -3}, 3, 0, by) + square("near", {2, 0}, 2, 1, by) + square("away", {40, 0}, 1, 0, by);
  }

  static constexpr const char* view =
      " --camera-position 0,0,10 --camera-focal-point 0,0,0 --camera-view-up +y --intrinsics 100,100,5,5 "
      "--pixel-center half --resolution 10,10 --near 1 --far 200 ";

 private:
  static std::string square(const std::string& name, const glm::dvec2& low, double half, double z, double by) {
    // Scaled by depth, so that nearer squares look no larger.
    const double scale = (10 - z) / 100;
    std::string text = "o " + name + "\n";
    for (const glm::dvec2& corner : {glm::dvec2(0, 0), {1, 0}, {1, 1}, {0, 1}}) {
      const glm::dvec2 at = (low + 2 * half * corner) * scale;
      text += "v " + std::to_string(by + at.x) + " " + std::to_string(by + at.y) + " " + std::to_string(by + z) + "\n";
    }
    return text + "f -4 -3 -2 -1\n";
  }
};

}  // namespace frontmost::test
