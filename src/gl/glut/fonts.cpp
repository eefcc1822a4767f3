// SPDX-License-Identifier: Apache-2.0
// GLUT's fonts, from the letters of drawings (frontmost/sheets.h): strokes as they are, and bitmaps of these strokes in
// the heights of GLUT's fonts. The shapes of letters and the widths of proportional fonts differ from GLUT's.

#include <frontmost/sheets.h>

#include <cmath>
#include <map>

#include "glut/glut.h"

extern "C" {
/// Programs name fonts by the addresses of these.
__attribute__((visibility("default"))) void *glutStrokeRoman = nullptr, *glutStrokeMonoRoman = nullptr,
                                            *glutBitmap9By15 = nullptr, *glutBitmap8By13 = nullptr,
                                            *glutBitmapTimesRoman10 = nullptr, *glutBitmapTimesRoman24 = nullptr,
                                            *glutBitmapHelvetica10 = nullptr, *glutBitmapHelvetica12 = nullptr,
                                            *glutBitmapHelvetica18 = nullptr;
}

namespace frontmost::glut {
namespace {

/// A letter in tenths of the lettering's height: capitals reach from 0 to 9, gaps between letters are 3 wide.
struct StrokeLetter {
  std::vector<std::vector<glm::dvec2>> strokes;
  double width = 1;
};

/// Appends the points of an arc from a stroke's last point to `to`, see PageGroup::bulges.
void add_arc(std::vector<glm::dvec2>& stroke, const glm::dvec2& to, double bulge, int halvings) {
  if (bulge == 0 || halvings == 0) return stroke.push_back(to);
  const glm::dvec2 from = stroke.back(), along = to - from;
  const double half = bulge / (1 + std::sqrt(1 + bulge * bulge));
  add_arc(stroke, from + 0.5 * along + 0.5 * bulge * glm::dvec2(along.y, -along.x), half, halvings - 1);
  add_arc(stroke, to, half, halvings - 1);
}

StrokeLetter make_letter(int character) {
  StrokeLetter letter;
  if (character < 32 || character > 255 || (character > 126 && character < 160)) return letter;
  PageGroup group{"", text_pen(10)};
  const std::string utf8{char(0xC0 | character >> 6), char(0x80 | (character & 63))};
  const std::string text = character < 127 ? std::string(1, char(character)) : utf8;
  add_text(group, text, glm::dvec2(0), {10});
  letter.width = text_width(text, 10) - 1;
  for (const PagePath& path : group.paths) {
    std::vector<glm::dvec2> stroke{group.points[path.first]};
    for (std::uint32_t i = path.first + 1; i < path.first + path.count; ++i)
      add_arc(stroke, group.points[i], group.bulges[i - 1], 3);
    // Pages count y downwards, and from the pen's edge. Rounding removes what machines may compute differently.
    for (glm::dvec2& p : stroke) p = glm::floor(glm::dvec2(p.x - 0.5, -p.y - 0.5) * 1024.0 + 0.5) / 1024.0;
    letter.strokes.push_back(stroke);
  }
  return letter;
}

const StrokeLetter& letter_of(int character) {
  static std::map<int, StrokeLetter> letters;
  const auto found = letters.find(character);
  return found != letters.end() ? found->second : letters.emplace(character, make_letter(character)).first->second;
}

int rounded(double v) { return int(std::floor(v + 0.5)); }

struct BitmapFont {
  const void* name;
  int height, below, capital, advance;  ///< pixels; below the baseline, of capitals; advance 0: proportional
};
constexpr BitmapFont kBitmapFonts[] = {{&glutBitmap8By13, 13, 3, 9, 8},        {&glutBitmap9By15, 15, 4, 10, 9},
                                       {&glutBitmapTimesRoman10, 13, 3, 7, 0}, {&glutBitmapTimesRoman24, 28, 7, 17, 0},
                                       {&glutBitmapHelvetica10, 13, 3, 8, 0},  {&glutBitmapHelvetica12, 16, 4, 9, 0},
                                       {&glutBitmapHelvetica18, 23, 5, 14, 0}};

const BitmapFont& bitmap_font(const void* name) {
  for (const BitmapFont& font : kBitmapFonts)
    if (font.name == name) return font;
  return kBitmapFonts[0];
}

struct BitmapLetter {
  int advance = 0, stride = 0;  ///< pixels, bytes
  std::vector<GLubyte> bits;
};

BitmapLetter make_bitmap(const BitmapFont& font, int character) {
  const StrokeLetter& letter = letter_of(character);
  const double up = (font.capital - 1) / 9.0, most = font.advance - 2;
  const double across = font.advance ? std::min(up, most / std::max(letter.width, 1.0)) : up;
  const int advance = font.advance ? font.advance : rounded(letter.width * across) + rounded(3 * up);
  const int stride = advance / 8 + 1, pen = font.capital < 14 ? 1 : 2;
  BitmapLetter bitmap{advance, stride, std::vector<GLubyte>(std::size_t(stride * font.height))};
  const glm::dvec2 scale(across, up), low((advance - 1 - letter.width * across) / 2, font.below);
  for (const auto& stroke : letter.strokes)
    for (std::size_t i = 0; i + 1 < stroke.size(); ++i)
      for (int k = 0; k < 64 * pen * pen; ++k) {
        const glm::dvec2 at = low + scale * glm::mix(stroke[i], stroke[i + 1], (k / (pen * pen)) / 63.0);
        const int x = rounded(at.x) + k % pen, y = rounded(at.y) + k / pen % pen;
        if (x >= 0 && x < 8 * stride && y >= 0 && y < font.height)
          bitmap.bits[std::size_t(y * stride + x / 8)] |= GLubyte(128 >> x % 8);
      }
  return bitmap;
}

const BitmapLetter& bitmap_of(const void* name, int character) {
  static std::map<std::pair<const void*, int>, BitmapLetter> bitmaps;
  BitmapLetter& bitmap = bitmaps[{name, character}];
  if (bitmap.advance == 0) bitmap = make_bitmap(bitmap_font(name), character);
  return bitmap;
}

/// The width of the longest line of a text.
float longest_line(const unsigned char* text, void* font, float (*width)(void*, int)) {
  float longest = 0, length = 0;
  for (; text && *text; ++text) longest = std::max(longest, length = *text == '\n' ? 0 : length + width(font, *text));
  return longest;
}

/// Draws a text by a function for letters and one that goes from a line's end to the next line.
void draw_lines(const unsigned char* text, void* font, float (*width)(void*, int), void (*draw)(void*, int),
                void (*go)(float, float), float height) {
  for (float length = 0; text && *text; ++text) {
    if (*text == '\n') {
      go(-std::exchange(length, 0.0f), -height);
    } else {
      draw(font, *text);
      length += width(font, *text);
    }
  }
}

constexpr double kStrokeUp = 100.0 / 9, kStrokeAcross = 0.85 * kStrokeUp;  // capitals of GLUT are 100 high
float bitmap_width(void* font, int character) { return float(bitmap_of(font, character).advance); }

}  // namespace

FRONTMOST_GLUT int glutBitmapWidth(void* font, int character) { return bitmap_of(font, character).advance; }
FRONTMOST_GLUT int glutBitmapHeight(void* font) { return bitmap_font(font).height; }
FRONTMOST_GLUT int glutBitmapLength(void* font, const unsigned char* text) {
  return int(longest_line(text, font, bitmap_width));
}
FRONTMOST_GLUT void glutBitmapCharacter(void* font, int character) {
  const BitmapFont& of = bitmap_font(font);
  const BitmapLetter& letter = bitmap_of(font, character);
  glPushClientAttrib(GL_CLIENT_PIXEL_STORE_BIT);
  for (GLenum name = GL_UNPACK_SWAP_BYTES; name <= GL_UNPACK_SKIP_PIXELS; ++name) glPixelStorei(name, 0);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glBitmap(8 * letter.stride, of.height, 0, float(of.below), float(letter.advance), 0, letter.bits.data());
  glPopClientAttrib();
}
FRONTMOST_GLUT void glutBitmapString(void* font, const unsigned char* text) {
  const auto go = [](float x, float y) { glBitmap(0, 0, 0, 0, x, y, nullptr); };
  draw_lines(text, font, bitmap_width, glutBitmapCharacter, go, float(bitmap_font(font).height));
}

FRONTMOST_GLUT float glutStrokeHeight(void*) { return 152.38f; }
FRONTMOST_GLUT float glutStrokeWidthf(void* font, int character) {
  return font == &glutStrokeMonoRoman ? 104.76f : float((letter_of(character).width + 3) * kStrokeAcross);
}
FRONTMOST_GLUT int glutStrokeWidth(void* font, int character) { return rounded(glutStrokeWidthf(font, character)); }
FRONTMOST_GLUT float glutStrokeLengthf(void* font, const unsigned char* text) {
  return longest_line(text, font, glutStrokeWidthf);
}
FRONTMOST_GLUT int glutStrokeLength(void* font, const unsigned char* text) {
  return rounded(glutStrokeLengthf(font, text));
}
FRONTMOST_GLUT void glutStrokeCharacter(void* font, int character) {
  const StrokeLetter& letter = letter_of(character);
  const double left = (glutStrokeWidthf(font, character) - letter.width * kStrokeAcross) / 2;
  for (const auto& stroke : letter.strokes) {
    glBegin(GL_LINE_STRIP);
    for (const glm::dvec2& p : stroke) glVertex2d(left + p.x * kStrokeAcross, p.y * kStrokeUp);
    glEnd();
  }
  glTranslatef(glutStrokeWidthf(font, character), 0, 0);
}
FRONTMOST_GLUT void glutStrokeString(void* font, const unsigned char* text) {
  const auto go = [](float x, float y) { glTranslatef(x, y, 0); };
  draw_lines(text, font, glutStrokeWidthf, glutStrokeCharacter, go, glutStrokeHeight(font));
}

}  // namespace frontmost::glut
