// SPDX-License-Identifier: Apache-2.0
// Strokes over pictures: shares of ink worked out by hand, no seams, and the same bytes on any number of threads.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "frontmost/sheets.h"
#include "frontmost/zbuffer.h"
#include "support/random_scene.h"

namespace frontmost::test {
namespace {

Image blank_picture(int width, int height, float color, std::optional<float> alpha = 1.0f) {
  Image picture{width, height, {}};
  for (const char* const name : {"R", "G", "B"})
    picture.channels.push_back({name, Buffer<float>(std::size_t(width * height), color)});
  if (alpha) picture.channels.push_back({"A", Buffer<float>(std::size_t(width * height), *alpha)});
  return picture;
}

Strokes strokes_through(const std::vector<std::vector<glm::dvec2>>& lines) {
  Strokes all;
  for (const std::vector<glm::dvec2>& line : lines) {
    Stroke stroke;
    stroke.first = std::uint32_t(all.points.size());
    stroke.count = std::uint32_t(line.size());
    all.points.insert(all.points.end(), line.begin(), line.end());
    all.strokes.push_back(stroke);
  }
  return all;
}

float value_at(const Image& picture, const char* channel, int x, int y) {
  return picture.find(channel)->floats()[std::size_t(y * picture.width + x)];
}

const PicturePen black_pen{.width = 1, .color = glm::vec3(0)};

TEST(DrawStrokes, CoverPixelsByTheirShare) {
  struct Case {
    double y, width;
    float shares[4];  // of the rows 9 to 12
  };
  const Case cases[] = {{10.5, 1, {0, 1, 0, 0}},       {11, 1, {0, 0.5f, 0.5f, 0}},
                        {10.5, 2, {0.5f, 1, 0.5f, 0}}, {10.75, 1, {0, 0.75f, 0.25f, 0}},
                        {10.5, 0.4, {0, 0.4f, 0, 0}},  {11, 0.5, {0, 0.25f, 0.25f, 0}}};
  for (const Case& c : cases) {
    Image picture = blank_picture(40, 40, 1);
    PicturePen pen = black_pen;
    pen.width = c.width;
    draw_strokes(picture, strokes_through({{{5, c.y}, {35, c.y}}}), pen);
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(value_at(picture, "G", 20, 9 + i), 1 - c.shares[i], 1e-6) << c.y << " " << i;
    EXPECT_EQ(value_at(picture, "R", 2, 10), 1) << "nothing beyond its end";
    EXPECT_EQ(value_at(picture, "A", 20, 10), 1);
  }
}

TEST(DrawStrokes, LeaveAsMuchInkAtEveryAngle) {
  for (int degrees = 0; degrees < 180; degrees += 7) {
    const double angle = glm::radians(double(degrees));
    const glm::dvec2 along(std::cos(angle), std::sin(angle));
    Image picture = blank_picture(100, 100, 1);
    draw_strokes(picture, strokes_through({{glm::dvec2(50) - 40.0 * along, glm::dvec2(50) + 40.0 * along}}),
                 {.width = 1.5, .color = glm::vec3(0)});
    double ink = 0;
    for (const float value : picture.find("B")->floats()) ink += 1 - double(value);
    // Its length times its width, and the half discs at its ends.
    EXPECT_NEAR(ink, 80 * 1.5 + 1.77, 1.5) << degrees;
  }
}

TEST(DrawStrokes, HaveNoSeamsWhereTheyMeetOrCross) {
  Image one = blank_picture(60, 60, 1), two = one, reversed = one;
  const std::vector<glm::dvec2> corner = {{5.3, 7.1}, {40.2, 11.9}, {20.7, 50.3}};
  draw_strokes(one, strokes_through({corner}), black_pen);
  draw_strokes(two, strokes_through({{corner[1], corner[2]}, {corner[0], corner[1]}}), black_pen);
  EXPECT_EQ(content_hash(one), content_hash(two));
  // Half of the pixel is ink, however many strokes say so.
  draw_strokes(reversed, strokes_through({{{10, 20}, {50, 20}}, {{10, 20}, {50, 20}}, {{30, 20}, {20, 20}}}),
               black_pen);
  EXPECT_FLOAT_EQ(value_at(reversed, "R", 25, 19), 0.5f);
}

TEST(DrawStrokes, AreInkOnTransparentPictures) {
  Image picture = blank_picture(20, 20, 0, 0.0f);
  draw_strokes(picture, strokes_through({{{0, 10}, {20, 10}}}), {.width = 1, .color = {1, 1, 1}});
  EXPECT_FLOAT_EQ(value_at(picture, "A", 10, 10), 0.5f);
  EXPECT_FLOAT_EQ(value_at(picture, "R", 10, 10), 0.5f);  // premultiplied
  EXPECT_EQ(value_at(picture, "A", 10, 12), 0);
  Image opaque = blank_picture(20, 20, 1, std::nullopt);
  draw_strokes(opaque, strokes_through({{{0, 10.5}, {20, 10.5}}}), black_pen);
  EXPECT_EQ(value_at(opaque, "R", 10, 10), 0);
}

TEST(DrawStrokes, BlendInSrgbOnRequest) {
  for (const float alpha : {1.0f, 0.5f}) {
    Image picture = blank_picture(20, 20, alpha, alpha);  // white
    draw_strokes(picture, strokes_through({{{0, 10}, {20, 10}}}),
                 {.width = 1, .color = glm::vec3(0.2f), .blend = Blend::srgb});
    // Half of the ink's 0.2, and the white that shows beside it.
    const double after = 0.5 + 0.5 * double(alpha), expected = (0.5 * 0.2 + 0.5 * double(alpha)) / after;
    EXPECT_FLOAT_EQ(value_at(picture, "A", 10, 10), float(after));
    EXPECT_NEAR(bitmap_of(picture).rgba[(10 * 20 + 10) * 4], 255 * expected, 0.6);
  }
}

TEST(DrawStrokes, OfAViewLieOnItsEdgesAlone) {
  const Scene scene = builtin("cubes");
  const Surfaces surfaces(scene);
  for (const bool is_parallel : {false, true}) {
    const View view = frame(surfaces, 201, 150, {.direction = NamedView::iso, .orthographic = is_parallel});
    const Image plain = shade(surfaces, zbuffer(surfaces, view));
    const Drawing drawing = draw_lines(surfaces, view);
    const Strokes strokes = chain_strokes(surfaces, drawing, {.with_hidden = false});
    Image edged = plain;
    draw_strokes(edged, strokes, {.width = 2, .color = glm::vec3(0)}, {.threads = 1});
    for (const int threads : {2, 5}) {
      Image other = plain;
      draw_strokes(other, strokes, {.width = 2, .color = glm::vec3(0)}, {.threads = threads});
      EXPECT_EQ(content_hash(other), content_hash(edged));
    }
    std::size_t dark = 0;
    for (int y = 0; y < view.height; ++y)
      for (int x = 0; x < view.width; ++x) {
        const glm::dvec2 p(x + 0.5, y + 0.5);
        double nearest = 1e9;
        for (const DrawnPart& part : drawing.parts) {
          if (part.hidden_by != 0) continue;
          const glm::dvec2 along = part.to - part.from;
          const double square = glm::dot(along, along),
                       t = square > 0 ? std::clamp(glm::dot(p - part.from, along) / square, 0.0, 1.0) : 0;
          nearest = std::min(nearest, glm::distance(p, part.from + t * along));
        }
        if (nearest > 1.52) {
          EXPECT_EQ(value_at(edged, "R", x, y), value_at(plain, "R", x, y)) << x << " " << y;
        } else if (nearest < 0.48) {
          EXPECT_NEAR(value_at(edged, "R", x, y), 0, 1e-6) << x << " " << y;
          ++dark;
        }
      }
    EXPECT_GT(dark, 300u);
  }
}

TEST(DrawStrokes, RefuseWhatTheyCannotDraw) {
  Image picture = blank_picture(20, 20, 1), depths{20, 20, {{"Z", Buffer<float>(400, 1.0f)}}};
  Strokes strokes = strokes_through({{{0, 10}, {20, 10}}});
  EXPECT_THROW(draw_strokes(depths, strokes), Error);
  for (const double bad : {0.0, -1.0, 2000.0, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_THROW(draw_strokes(picture, strokes, {.width = bad}), Error);
  for (const float bad : {-0.1f, 1.1f, std::numeric_limits<float>::quiet_NaN()})
    EXPECT_THROW(draw_strokes(picture, strokes, {.color = {0.1f, bad, 0.1f}}), Error);
  for (const double bad :
       {2e9, -2e9, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    for (const glm::dvec2& point : {glm::dvec2(bad, 10), glm::dvec2(10, bad)})
      EXPECT_THROW(draw_strokes(picture, strokes_through({{{0, 10}, point}})), Error);
  strokes.bulges = {0.4, 0};
  EXPECT_THROW(draw_strokes(picture, strokes), Error);
  // Lines far outside leave no ink, and take no time.
  draw_strokes(picture, strokes_through({{{-1e9, -1e9}, {1e9, -9e8}}, {{-1e9, 5}, {-1e8, 5}}}));
  EXPECT_EQ(content_hash(picture), content_hash(blank_picture(20, 20, 1)));
  draw_strokes(picture, strokes_through({{{-1e9, 10.5}, {1e9, 10.5}}}), black_pen);
  EXPECT_EQ(value_at(picture, "R", 10, 10), 0);
}

}  // namespace
}  // namespace frontmost::test
