// SPDX-License-Identifier: Apache-2.0
// Letters of one stroke width, upright, in the proportions of ISO 3098-1 type B. They were drawn for this library, from
// lines and circular arcs that join without corners, as on lettering templates.
//
//     9 |      /.        capitals     "A" is  0,0 3,9 6,0;1,3 5,3  : up and down again, and the bar
//     6 |     /  .       small
//     3 |    /----.                   An arc is given by its two ends and the number of eighths of a circle that it
//     0 |   /      .     baseline     turns between them.
//
// A text is set letter by letter: strokes are scaled and rotated. Letters with marks are composed of a base and a mark.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "frontmost/sheets.h"
#include "pages/formats.h"

namespace frontmost {
namespace {

/// Strokes are the path of the pen's centre in tenths of the lettering's height, x to the right from the letter's left,
/// y up from the baseline. Points "x,y" are joined in order; ";" separates strokes. Before a point, each ( turns the
/// way to it by an eighth of a circle to the left, and each ) to the right.
struct Glyph {
  char32_t code;
  double width;  ///< width of the glyph; its strokes stay within [0, width]
  const char* strokes;
};

/// Sorted by code.
constexpr Glyph glyphs[] = {
    {U' ', 1, ""},
    {U'!', 0, "0,9 0,3;0,0.4 0,0"},
    {U'"', 2, "0,9 0,6.5;2,9 2,6.5"},
    {U'#', 6.5, "1.25,0 2.75,9;3.75,0 5.25,9;0,3 6,3;0.5,6 6.5,6"},
    {U'$', 5, "5,7 ((3,9 2,9 ((((2,5 2.5,5 ))))))0,2.5;2.5,-1.2 2.5,10.2"},
    {U'%', 7, "0.5,0 6.5,9;2.5,7.75 ((((0,7.75 ((((2.5,7.75;7,1.25 ((((4.5,1.25 ((((7,1.25"},
    {U'&', 6.4, "6.4,0 1.54,5.77 )))2.9,9 )))4.31,5.96 1.5,4.17 ((((2.9,0 ((6.4,3.5"},
    {U'\'', 0, "0,9 0,6.5"},
    {U'(', 2.5, "2.5,10.5 ((2.5,-1.5"},
    {U')', 2.5, "0,10.5 ))0,-1.5"},
    {U'*', 4.3, "2.15,9 2.15,4;0,7.75 4.3,5.25;0,5.25 4.3,7.75"},
    {U'+', 6, "0,4 6,4;3,1 3,7"},
    {U',', 0.6, "0.6,0.4 0.6,0 0,-1.5"},
    {U'-', 3.5, "0,4 3.5,4"},
    {U'.', 0, "0,0.4 0,0"},
    {U'/', 4.5, "0,0 4.5,9"},
    {U'0', 5, "5,6.5 ((((0,6.5 0,2.5 ((((5,2.5 5,6.5"},
    {U'1', 2.5, "0,6.5 2.5,9 2.5,0"},
    {U'2', 5, "0,6.5 )))))4.27,4.73 0,0 5,0"},
    {U'3', 4.8, "0.3,6.9 ))))))2.4,4.8;2.4,4.8 ))))))0,2.4"},
    {U'4', 5, "3,9 0,2.5 5,2.5;3.75,5 3.75,0"},
    {U'5', 5, "4.5,9 0,9 0,5.5 2.25,5.5 ))))2.25,0 2,0 ))0,2"},
    {U'6', 5, "4.27,8.27 (((0,6.5 0,2.5 ((((5,2.5 5,3 ((((0,3"},
    {U'7', 5, "0,9 5,9 1.5,0"},
    {U'8', 4.8, "2.4,4.8 ((((2.4,9 ((((2.4,4.8 ))))2.4,0 ))))2.4,4.8"},
    {U'9', 5, "0.73,0.73 (((5,2.5 5,6.5 ((((0,6.5 0,6 ((((5,6"},
    {U':', 0, "0,0.4 0,0;0,5.4 0,5"},
    {U';', 0.6, "0.6,0.4 0.6,0 0,-1.5;0.6,5.4 0.6,5"},
    {U'<', 5, "5,7 0,4 5,1"},
    {U'=', 5.5, "0,5.25 5.5,5.25;0,2.75 5.5,2.75"},
    {U'>', 5, "0,7 5,4 0,1"},
    {U'?', 4.5, "0,6.75 )))))3.84,5.16 (2.8,2.65;2.8,0.4 2.8,0"},
    {U'@', 8, "5.75,4 ((((2.25,4 ((((5.75,4;5.75,5.75 5.75,3.4 ((((8,3.4 8,4 ((((0,4 (((6.83,1.17"},
    {U'A', 6, "0,0 3,9 6,0;1,3 5,3"},
    {U'B', 5, "2.5,5 0,5 0,9 3,9 ))))3,5 2.5,5 ))))2.5,0 0,0 0,5"},
    {U'C', 5, "5,6.5 ((((0,6.5 0,2.5 ((((5,2.5"},
    {U'D', 5.25, "0,0 0,9 2,9 ))5.25,5.75 5.25,3.25 ))2,0 0,0"},
    {U'E', 4.75, "4.75,9 0,9 0,0 4.75,0;0,5 4,5"},
    {U'F', 4.75, "4.75,9 0,9 0,0;0,5 4,5"},
    {U'G', 5, "5,6.5 ((((0,6.5 0,2.5 ((((5,2.5 5,4 3,4"},
    {U'H', 5, "0,0 0,9;5,0 5,9;0,5 5,5"},
    {U'I', 0, "0,0 0,9"},
    {U'J', 4, "4,9 4,2 ))))0,2"},
    {U'K', 5.25, "0,0 0,9;5.25,9 0,3;1.97,5.25 5.25,0"},
    {U'L', 4.5, "0,9 0,0 4.5,0"},
    {U'M', 7, "0,0 0,9 3.5,2.5 7,9 7,0"},
    {U'N', 5.5, "0,0 0,9 5.5,0 5.5,9"},
    {U'O', 5.5, "5.5,6.25 ((((0,6.25 0,2.75 ((((5.5,2.75 5.5,6.25"},
    {U'P', 5, "0,0 0,9 2.75,9 ))))2.75,4.5 0,4.5"},
    {U'Q', 5.5, "5.5,6.25 ((((0,6.25 0,2.75 ((((5.5,2.75 5.5,6.25;3.25,2.25 5.5,0"},
    {U'R', 5, "0,0 0,9 2.75,9 ))))2.75,4.5 0,4.5;2.75,4.5 5,0"},
    {U'S', 5, "5,7 ((3,9 2,9 ((((2,5 2.5,5 ))))))0,2.5"},
    {U'T', 5.5, "0,9 5.5,9;2.75,9 2.75,0"},
    {U'U', 5, "0,9 0,2.5 ((((5,2.5 5,9"},
    {U'V', 6, "0,9 3,0 6,9"},
    {U'W', 8, "0,9 2,0 4,7.5 6,0 8,9"},
    {U'X', 5.5, "0,0 5.5,9;0,9 5.5,0"},
    {U'Y', 6, "0,9 3,4.5 6,9;3,4.5 3,0"},
    {U'Z', 5, "0,9 5,9 0,0 5,0"},
    {U'[', 2, "2,10.5 0,10.5 0,-1.5 2,-1.5"},
    {U'\\', 4.5, "0,9 4.5,0"},
    {U']', 2, "0,10.5 2,10.5 2,-1.5 0,-1.5"},
    {U'^', 4, "0,6.5 2,9 4,6.5"},
    {U'_', 5, "0,-1.5 5,-1.5"},
    {U'`', 1.6, "0,9 1.6,7.5"},
    {U'a', 4.5, "4.5,6 4.5,0;4.5,3.75 ((((0,3.75 0,2.25 ((((4.5,2.25"},
    {U'b', 4.5, "0,9 0,0;0,3.75 ))))4.5,3.75 4.5,2.25 ))))0,2.25"},
    {U'c', 4, "3.84,5.34 (((0,3.75 0,2.25 (((3.84,0.66"},
    {U'd', 4.5, "4.5,9 4.5,0;4.5,3.75 ((((0,3.75 0,2.25 ((((4.5,2.25"},
    {U'e', 4.5, "0,3 4.5,3 4.5,3.75 ((((0,3.75 0,2.25 (((3.84,0.66"},
    {U'f', 3.25, "3.25,9 3,9 ((1.5,7.5 1.5,0;0,6 3.25,6"},
    {U'g', 4.5, "4.5,6 4.5,-0.75 )))0.66,-2.34;4.5,3.75 ((((0,3.75 0,2.25 ((((4.5,2.25"},
    {U'h', 4.5, "0,9 0,0;0,3.75 ))))4.5,3.75 4.5,0"},
    {U'i', 0, "0,0 0,6;0,8.6 0,9"},
    {U'j', 1.5, "1.5,6 1.5,-1.5 ))0,-3;1.5,8.6 1.5,9"},
    {U'k', 4.25, "0,9 0,0;4,6 0,2;1.5,3.5 4.25,0"},
    {U'l', 1.25, "0,9 0,1.25 ((1.25,0"},
    {U'm', 7, "0,0 0,6;0,4.25 ))))3.5,4.25 3.5,0;3.5,4.25 ))))7,4.25 7,0"},
    {U'n', 4.5, "0,0 0,6;0,3.75 ))))4.5,3.75 4.5,0"},
    {U'o', 4.5, "4.5,3.75 ((((0,3.75 0,2.25 ((((4.5,2.25 4.5,3.75"},
    {U'p', 4.5, "0,6 0,-3;0,3.75 ))))4.5,3.75 4.5,2.25 ))))0,2.25"},
    {U'q', 4.5, "4.5,6 4.5,-3;4.5,3.75 ((((0,3.75 0,2.25 ((((4.5,2.25"},
    {U'r', 3, "0,0 0,6;0,3.75 ))2.25,6 3,6"},
    {U's', 4, "4,4.6 ((2.6,6 1.4,6 ((((1.4,3.2 2.4,3.2 ))))2.4,0 1.6,0 ))0,1.6"},
    {U't', 3.25, "1.5,8.5 1.5,1.5 ((3,0 3.25,0;0,6 3.25,6"},
    {U'u', 4.5, "0,6 0,2.25 ((((4.5,2.25;4.5,6 4.5,0"},
    {U'v', 4.5, "0,6 2.25,0 4.5,6"},
    {U'w', 6.5, "0,6 1.6,0 3.25,5 4.9,0 6.5,6"},
    {U'x', 4.5, "0,0 4.5,6;0,6 4.5,0"},
    {U'y', 4.5, "0,6 2.25,0;4.5,6 1.125,-3"},
    {U'z', 4, "0,6 4,6 0,0 4,0"},
    {U'{', 2.5, "2.5,10.5 ((1.25,9.25 1.25,5.75 ))0,4.5 ))1.25,3.25 1.25,-0.25 ((2.5,-1.5"},
    {U'|', 0, "0,10.5 0,-1.5"},
    {U'}', 2.5, "0,10.5 ))1.25,9.25 1.25,5.75 ((2.5,4.5 ((1.25,3.25 1.25,-0.25 ))0,-1.5"},
    {U'~', 6, "0,3.5 ))3,4 ((6,4.5"},
    {U'\u00A0', 1, ""},
    {U'¡', 0, "0,-3 0,3;0,5.6 0,6"},
    {U'¢', 4, "3.84,5.34 (((0,3.75 0,2.25 (((3.84,0.66;2.25,7.5 2.25,-1.5"},
    {U'£', 5, "4.41,8.41 (((1,7 1,0;0,0 5,0;0,4.5 4,4.5"},
    {U'¤', 5, "4.5,4.5 ((((0.5,4.5 ((((4.5,4.5;0,7 1.1,5.9;5,7 3.9,5.9;0,2 1.1,3.1;5,2 3.9,3.1"},
    {U'¥', 6, "0,9 3,4.5 6,9;3,4.5 3,0;0.75,4 5.25,4;0.75,2 5.25,2"},
    {U'¦', 0, "0,10.5 0,5.5;0,3.5 0,-1.5"},
    {U'§', 4, "4,7.6 ((2.6,9 1.4,9 ((((1.4,6.2 2,6.2 ))))2,2.6;2,6.2 ((((2,2.6 2.6,2.6 ))))2.6,-0.2 1.4,-0.2 ))0,1.2"},
    {U'¨', 2.4, "0,8.4 0,8;2.4,8.4 2.4,8"},
    {U'©', 9, "9,4.5 ((((0,4.5 ((((9,4.5;5.91,5.91 (((2.5,4.5 (((5.91,3.09"},
    {U'ª', 2.5, "2.5,9 2.5,6;2.5,7.75 ((((0,7.75 0,7.25 ((((2.5,7.25;0,4.5 2.5,4.5"},
    {U'«', 4.5, "2,6 0,3.5 2,1;4.5,6 2.5,3.5 4.5,1"},
    {U'¬', 5.5, "0,5 5.5,5 5.5,2.5"},
    {U'\u00AD', 3.5, "0,4 3.5,4"},
    {U'®', 9, "9,4.5 ((((0,4.5 ((((9,4.5;3.25,2.25 3.25,6.75 4.75,6.75 ))))4.75,4.5 3.25,4.5;4.75,4.5 5.75,2.25"},
    {U'¯', 3, "0,8.2 3,8.2"},
    {U'°', 3, "3,7.5 ((((0,7.5 ((((3,7.5"},
    {U'±', 6, "0,5 6,5;3,2 3,8;0,0 6,0"},
    {U'²', 2.5, "0,7.75 )))))2.13,6.87 0,4.5 2.5,4.5"},
    {U'³', 2.4, "0.15,7.95 ))))))1.2,6.9;1.2,6.9 ))))))0,5.7"},
    {U'´', 1.6, "0,7.5 1.6,9"},
    {U'µ', 4.5, "0,6 0,-3;0,2.25 ((((4.5,2.25;4.5,6 4.5,0"},
    {U'¶', 5, "5,0 5,9 2.25,9 ((((2.25,4.5;3,9 3,0"},
    {U'·', 0, "0,4.2 0,3.8"},
    {U'¸', 1.7, "0.8,0 0.8,-0.7 ))))0.8,-2.5 0,-2.5"},
    {U'¹', 1.25, "0,7.75 1.25,9 1.25,4.5"},
    {U'º', 2.5, "2.5,7.75 ((((0,7.75 0,7.25 ((((2.5,7.25 2.5,7.75;0,4.5 2.5,4.5"},
    {U'»', 4.5, "0,6 2,3.5 0,1;2.5,6 4.5,3.5 2.5,1"},
    {U'¼', 7.5, "0,7.75 1.25,9 1.25,4.5;0.75,0 6.75,9;6.5,4.5 5,1.25 7.5,1.25;6.9,2.5 6.9,0"},
    {U'½', 7.5, "0,7.75 1.25,9 1.25,4.5;0.75,0 6.75,9;5,3.25 )))))7.13,2.37 5,0 7.5,0"},
    {U'¾', 8.5, "0.15,7.95 ))))))1.2,6.9;1.2,6.9 ))))))0,5.7;1.75,0 7.75,9;7.5,4.5 6,1.25 8.5,1.25;7.9,2.5 7.9,0"},
    {U'¿', 4.5, "4.5,-0.75 )))))0.66,0.84 (1.7,3.35;1.7,5.6 1.7,6"},
    {U'Æ', 8, "8,0 4,0 4,9 8,9;4,9 0,0;1.33,3 4,3;4,5 7.25,5"},
    {U'Ð', 6.25, "1,0 1,9 3,9 ))6.25,5.75 6.25,3.25 ))3,0 1,0;0,5 3.5,5"},
    {U'×', 5, "0,1.5 5,6.5;0,6.5 5,1.5"},
    {U'Ø', 5.5, "5.5,6.25 ((((0,6.25 0,2.75 ((((5.5,2.75 5.5,6.25;0,-0.3 5.5,9.3"},
    {U'Þ', 5, "0,0 0,9;0,7 2.75,7 ))))2.75,2.5 0,2.5"},
    {U'ß', 4.5, "0,0 0,6.9 ))))4.2,6.9 ))2.1,4.8 ))))2.1,0 1.2,0"},
    {U'æ', 9,
     "4.5,6 4.5,0;4.5,3.75 ((((0,3.75 0,2.25 ((((4.5,2.25;4.5,3 9,3 9,3.75 ((((4.5,3.75 4.5,2.25 (((8.34,0.66"},
    {U'ð', 4.5, "4.5,3.75 ((((0,3.75 0,2.25 ((((4.5,2.25 4.5,4.5 (1,9;1.1,6.9 4.1,8.7"},
    {U'÷', 6, "0,4 6,4;3,6.7 3,6.3;3,1.7 3,1.3"},
    {U'ø', 4.5, "4.5,3.75 ((((0,3.75 0,2.25 ((((4.5,2.25 4.5,3.75;0,-0.5 4.5,6.5"},
    {U'þ', 4.5, "0,9 0,-3;0,3.75 ))))4.5,3.75 4.5,2.25 ))))0,2.25"},
    {U'Đ', 6.25, "1,0 1,9 3,9 ))6.25,5.75 6.25,3.25 ))3,0 1,0;0,5 3.5,5"},
    {U'đ', 5.5, "4.5,9 4.5,0;4.5,3.75 ((((0,3.75 0,2.25 ((((4.5,2.25;2.5,7.5 5.5,7.5"},
    {U'ı', 0, "0,0 0,6"},
    {U'ľ', 2.75, "0,9 0,1.25 ((1.25,0;2.75,9 2.25,7.25"},
    {U'Ł', 5.5, "1,9 1,0 5.5,0;0,3.5 3.5,6"},
    {U'ł', 2.6, "1.1,9 1.1,1.25 ((2.35,0;0,3.75 2.4,5.5"},
    {U'Œ', 8.75, "8.75,0 2.75,0 ))0,2.75 0,6.25 ))2.75,9 8.75,9;5,9 5,0;5,5 8,5"},
    {U'œ', 9, "4.5,3.75 ((((0,3.75 0,2.25 ((((4.5,2.25;4.5,3 9,3 9,3.75 ((((4.5,3.75 4.5,2.25 (((8.34,0.66"},
    {U'ȷ', 1.5, "1.5,6 1.5,-1.5 ))0,-3"},
    {U'Δ', 6, "0,0 3,9 6,0 0,0"},
    {U'Ω', 6, "0,0 1.85,0 1.85,3.23 )))))))4.15,3.23 4.15,0 6,0"},
    {U'α', 5.5, "5.5,6 4.4,2.25 ))2.25,0 ))0,2.25 0,3.75 ))2.25,6 ))4.4,3.75 (5.5,0"},
    {U'μ', 4.5, "0,6 0,-3;0,2.25 ((((4.5,2.25;4.5,6 4.5,0"},
    {U'–', 5, "0,4 5,4"},
    {U'—', 8, "0,4 8,4"},
    {U'‘', 0.6, "0.6,9 0,7.5 0,7.1"},
    {U'’', 0.6, "0.6,9 0.6,8.6 0,7.1"},
    {U'‚', 0.6, "0.6,0.4 0.6,0 0,-1.5"},
    {U'“', 2.4, "0.6,9 0,7.5 0,7.1;2.4,9 1.8,7.5 1.8,7.1"},
    {U'”', 2.4, "0.6,9 0.6,8.6 0,7.1;2.4,9 2.4,8.6 1.8,7.1"},
    {U'„', 2.4, "0.6,0.4 0.6,0 0,-1.5;2.4,0.4 2.4,0 1.8,-1.5"},
    {U'•', 1, "1,4 ((((0,4 ((((1,4"},
    {U'…', 6, "0,0.4 0,0;3,0.4 3,0;6,0.4 6,0"},
    {U'€', 5.3, "5.27,8.27 (((1,6.5 1,2.5 (((5.27,0.73;0,5.4 4.5,5.4;0,3.6 4.5,3.6"},
    {U'→', 7, "0,4 7,4;4.75,6 7,4 4.75,2"},
    {U'↧', 5, "0,9 5,9;2.5,9 2.5,0;0.75,3.5 2.5,0 4.25,3.5"},
    {U'∅', 7, "6.5,4.5 ((((0.5,4.5 ((((6.5,4.5;0,-0.2 7,9.2"},
    {U'−', 6, "0,4 6,4"},
    {U'∠', 6.5, "5,9 0,0 6.5,0"},
    {U'≈', 6, "0,2.25 ))3,2.75 ((6,3.25;0,4.75 ))3,5.25 ((6,5.75"},
    {U'≠', 5.5, "0,5.25 5.5,5.25;0,2.75 5.5,2.75;1,0.5 4.5,7.5"},
    {U'≤', 5, "5,8 0,5.25 5,2.5;0,0.5 5,0.5"},
    {U'≥', 5, "0,8 5,5.25 0,2.5;0,0.5 5,0.5"},
    {U'⌀', 7, "6.5,4.5 ((((0.5,4.5 ((((6.5,4.5;0,-0.2 7,9.2"},
    {U'□', 7, "0,1 0,8 7,8 7,1 0,1"},
};

constexpr Glyph missing{0, 5, "0,0 0,9 5,9 5,0 0,0"};

struct Mark {
  const char* strokes;  ///< about x = 0, above a small letter or below the baseline
  bool is_below;
  std::u32string_view letters;  ///< base and composite, one after the other
};

/// Lower-case i and j lose their dot under a mark.
constexpr Mark marks[] = {
    {"-0.9,9 0.7,7.5", false, U"AÀEÈIÌOÒUÙaàeèıìoòuùNǸnǹ"},
    {"-0.7,7.5 0.9,9", false, U"AÁEÉIÍOÓUÚYÝaáeéıíoóuúyýCĆcćLĹlĺNŃnńRŔrŕSŚsśZŹzź"},
    {"-1.5,7.5 0,9 1.5,7.5", false, U"AÂEÊIÎOÔUÛaâeêıîoôuûCĈcĉGĜgĝHĤhĥJĴȷĵSŜsŝWŴwŵYŶyŷ"},
    {"-1.75,7.7 ))0,8.1 ((1.75,8.5", false, U"AÃNÑOÕaãnñoõIĨıĩUŨuũ"},
    {"-1.2,8.4 -1.2,8;1.2,8.4 1.2,8", false, U"AÄEËIÏOÖUÜaäeëıïoöuüyÿYŸ"},
    {"0.95,8.5 ((((-0.95,8.5 ((((0.95,8.5", false, U"AÅaåUŮuů"},
    {"-1.5,9 0,7.5 1.5,9", false, U"CČcčDĎdďEĚeěNŇnňRŘrřSŠsšTŤtťZŽzž"},
    {"-1.5,8.2 1.5,8.2", false, U"AĀaāEĒeēIĪıīOŌoōUŪuū"},
    {"-1.5,8.7 ((((1.5,8.7", false, U"AĂaăEĔeĕGĞgğIĬıĭOŎoŏUŬuŭ"},
    {"0,8.4 0,8", false, U"CĊcċEĖeėGĠgġIİZŻzż"},
    {"-1.6,7.5 -0.4,9;0.4,7.5 1.6,9", false, U"OŐoőUŰuű"},
    {"0,0 0,-0.7 ))))0,-2.5 -0.8,-2.5", true, U"CÇcçSŞsşTŢtţ"},
    {"0.6,0 ((((0.6,-2 1.2,-2", true, U"AĄaąEĘeęIĮiįUŲuų"},
    {"0.3,-0.9 0.3,-1.3 -0.3,-2.6", true, U"SȘsșTȚtțGĢKĶkķLĻlļNŅnņRŖrŗ"},
};

constexpr double gap = 3;       // between the middles of strokes, which leaves two pen widths, as in ISO 3098-1
constexpr double rise = 3;      // height by which a mark is raised above a tall letter
constexpr double tall = 6.5;    // letters that reach higher are tall
constexpr double edge = 0.5;    // half of the pen width
constexpr double capital = 10;  // height of capitals, from edge to edge
constexpr double eighth = 0.7853981633974483;

/// Visits the points of strokes: visit(point, bulge of the arc that leads to it, whether a stroke begins at it).
template <class Visit>
void for_each_point(const char* strokes, const Visit& visit) {
  bool begins = true;
  for (const char* at = strokes; *at != '\0';) {
    int turns = 0;
    for (; *at == '(' || *at == ')' || *at == ' ' || *at == ';'; ++at) {
      begins |= *at == ';';
      turns += *at == ')' ? 1 : *at == '(' ? -1 : 0;
    }
    const auto number = [&at] {
      const bool is_negative = *at == '-';
      double value = 0, unit = 1;
      for (at += is_negative; *at >= '0' && *at <= '9'; ++at) value = value * 10 + (*at - '0');
      if (*at == '.')
        for (++at; *at >= '0' && *at <= '9'; ++at) value += (*at - '0') * (unit /= 10);
      return is_negative ? -value : value;
    };
    const double x = number();
    ++at;  // the comma
    const double y = number();
    visit(glm::dvec2(x, y), std::tan(turns * eighth / 4), begins);
    begins = false;
  }
}

/// A character to be drawn: a letter (a box if there is none), possibly with a mark.
struct Character {
  const Glyph* glyph;
  const char* mark;  ///< null if there is none
  glm::dvec2 mark_at;
  double indent, width;  ///< `indent`: the letter's offset within the common width
};

Character character_of(char32_t code) {
  const Mark* mark = nullptr;
  char32_t base = code;
  for (const Mark& each : marks)
    for (std::size_t i = 1; i < each.letters.size() && !mark; i += 2)
      if (each.letters[i] == code) mark = &each, base = each.letters[i - 1];
  const Glyph* const found = std::lower_bound(std::begin(glyphs), std::end(glyphs), base,
                                              [](const Glyph& g, char32_t c) { return g.code < c; });
  const Glyph* const glyph = found != std::end(glyphs) && found->code == base ? found : &missing;
  if (!mark) return {glyph, nullptr, {}, 0, glyph->width};
  double half = 0, top = base < U'a' ? capital : 0;
  for_each_point(mark->strokes, [&](const glm::dvec2& p, double, bool) { half = std::max(half, std::abs(p.x)); });
  for_each_point(glyph->strokes, [&](const glm::dvec2& p, double, bool) { top = std::max(top, p.y); });
  const double width = std::max(glyph->width, 2 * half);
  const glm::dvec2 mark_at(width / 2, !mark->is_below && top > tall ? rise : 0);
  return {glyph, mark->strokes, mark_at, (width - glyph->width) / 2, width};
}

/// Calls visit(character, left side) for every character of a text. \returns the end of the last character; negative if
/// there is none.
template <class Visit>
double for_each_character(std::string_view text, const Visit& visit) {
  double left = 0;
  while (!text.empty()) {
    const Character character = character_of(detail::take_character(text));
    visit(character, left);
    left += character.width + gap;
  }
  return left - gap;
}

double width_in_tenths(std::string_view text) {
  const double end = for_each_character(text, [](const Character&, double) {});
  return text.empty() ? 0 : end + 2 * edge;
}

}  // namespace

Pen text_pen(double height) { return {height / capital, {}}; }

void add_text(PageGroup& group, std::string_view text, const glm::dvec2& at, const TextStyle& style,
              Lettering lettering) {
  if (text.empty()) return;
  if (lettering == Lettering::text) {
    group.texts.push_back({std::string(text), at, style});
    return;
  }
  const double before = detail::share_before(style.align);
  const double below = detail::share_below(style.line);
  const glm::dvec2 shift(edge - before * width_in_tenths(text), edge - below * capital);
  const glm::dvec2 along = glm::dvec2(std::cos(style.angle), -std::sin(style.angle)) * (style.height / capital);
  group.bulges.resize(group.points.size());
  const auto draw = [&](const char* strokes, const glm::dvec2& place) {
    for_each_point(strokes, [&](const glm::dvec2& p, double bulge, bool begins) {
      if (begins)
        group.paths.push_back({std::uint32_t(group.points.size()), 0, false});
      else
        group.bulges.back() = bulge;
      const glm::dvec2 q = p + place + shift;
      group.points.push_back(at + along * q.x + glm::dvec2(along.y, -along.x) * q.y);
      group.bulges.push_back(0);
      ++group.paths.back().count;
    });
  };
  for_each_character(text, [&](const Character& character, double left) {
    draw(character.glyph->strokes, {left + character.indent, 0});
    if (character.mark) draw(character.mark, glm::dvec2(left, 0) + character.mark_at);
  });
}

double text_width(std::string_view text, double height) { return width_in_tenths(text) * height / capital; }

}  // namespace frontmost
