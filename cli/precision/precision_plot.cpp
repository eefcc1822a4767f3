// SPDX-License-Identifier: Apache-2.0
// Both axes are logarithmic: a gap that grows with the square of the distance is a line of slope two.
//
//   gap |            .'      fixed point: distance^2
//       |         .'
//       |      .'   __.--    reversed floats: distance
//       |   _.--''''
//       +-----------------> distance
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "cli/precision/precision_report.h"

namespace frontmost::cli {
namespace {

constexpr double width = 920, height = 580, left = 92, right = 780, top = 84, bottom = 510;
constexpr int line_points = 480;

struct PlotLine {
  DepthSetup setup;
  const char* color;
  const char* dashes;              ///< dash pattern, which distinguishes lines that nearly coincide
  std::vector<glm::dvec2> points;  ///< distance and gap
};

/// Maps distances and gaps to positions on the drawing.
struct Axes {
  double x_low, x_high, y_low, y_high;  // decimal logarithms

  [[nodiscard]] double x(double distance) const {
    return left + (right - left) * (std::log10(distance) - x_low) / (x_high - x_low);
  }
  [[nodiscard]] double y(double gap) const {
    return bottom - (bottom - top) * (std::log10(gap) - y_low) / (y_high - y_low);
  }
};

std::vector<PlotLine> lines_of(const ClipDistances& clip, bool orthographic, const std::optional<DepthSetup>& chosen) {
  std::vector<PlotLine> lines;
  const auto add = [&](DepthFormat format, bool reversed, const char* color, const char* dashes) {
    lines.push_back({{clip, format, reversed, orthographic}, color, dashes, {}});
  };
  if (chosen && chosen->format == DepthFormat::d8) add(DepthFormat::d8, false, "#7a5195", "");
  add(DepthFormat::d16, false, "#d1495b", "");
  add(DepthFormat::d24, false, "#2e6f95", "");
  add(DepthFormat::f32, false, "#e0882f", "7 5");
  add(DepthFormat::f32, true, "#2a8f5c", "");
  const double far = std::isfinite(clip.far) ? clip.far : clip.near * 1e6;
  const double near = clip.near > 0 ? clip.near : far * 1e-6;
  for (PlotLine& line : lines) {
    for (int i = 0; i < line_points; ++i) {
      const double distance = std::clamp(near * std::pow(far / near, i / (line_points - 1.0)), clip.near, far);
      const double gap = certain_gap(line.setup, distance);
      if (std::isfinite(gap) && gap > 0) line.points.emplace_back(distance, gap);
    }
  }
  return lines;
}

Axes axes_of(const std::vector<PlotLine>& lines, const std::optional<glm::dvec2>& wanted) {
  double x_low = 1e300, x_high = 0, y_low = 1e300, y_high = 0;
  for (const PlotLine& line : lines)
    for (const glm::dvec2& p : line.points) {
      x_low = std::min(x_low, p.x);
      x_high = std::max(x_high, p.x);
      // Gaps finer than those between float vertices are not worth plotting.
      if (p.y >= p.x * 3e-8) y_low = std::min(y_low, p.y);
      y_high = std::max(y_high, p.y);
    }
  if (wanted) {
    y_low = std::min(y_low, wanted->x);
    y_high = std::max(y_high, wanted->x);
  }
  Axes axes{std::log10(x_low), std::log10(x_high), std::floor(std::log10(y_low)), std::ceil(std::log10(y_high))};
  if (axes.x_high - axes.x_low < 0.1) axes.x_high = axes.x_low + 0.1;
  if (axes.y_high - axes.y_low < 1) axes.y_high = axes.y_low + 1;
  return axes;
}

std::string power(int exponent) {
  if (exponent >= -2 && exponent <= 4) return fmt::format("{:g}", std::pow(10.0, exponent));
  return fmt::format("10<tspan dy=\"-5\" font-size=\"10\">{}{}</tspan>", exponent < 0 ? "−" : "", std::abs(exponent));
}

std::string grid(const Axes& axes) {
  std::string minor, major, labels;
  const auto vertical = [](double x) { return fmt::format("M{:.1f} {}V{}", x, top, bottom); };
  const auto horizontal = [](double y) { return fmt::format("M{} {:.1f}H{}", left, y, right); };
  // If there are many decades, only some of them get lines and labels.
  const int skip = std::max(1, int((axes.y_high - axes.y_low) / 9)),
            x_skip = std::max(1, int((axes.x_high - axes.x_low) / 9));
  for (int e = int(std::ceil(axes.x_low - 1e-9)); e <= axes.x_high + 1e-9; ++e) {
    major += vertical(axes.x(std::pow(10.0, e)));
    if (e % x_skip == 0)
      labels += fmt::format("<text x=\"{:.1f}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n", axes.x(std::pow(10.0, e)),
                            bottom + 20, power(e));
  }
  for (int e = int(std::floor(axes.x_low)); e <= axes.x_high && x_skip == 1; ++e)
    for (int digit = 2; digit < 10; ++digit) {
      const double distance = digit * std::pow(10.0, e), at = std::log10(distance);
      if (at > axes.x_low && at < axes.x_high) minor += vertical(axes.x(distance));
    }
  for (int e = int(axes.y_low); e <= int(axes.y_high); e += skip) {
    major += horizontal(axes.y(std::pow(10.0, e)));
    labels += fmt::format("<text x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>\n", left - 10,
                          axes.y(std::pow(10.0, e)) + 4, power(e));
  }
  return fmt::format(
      "<path d=\"{}\" stroke=\"#f0f0ee\"/>\n<path d=\"{}\" stroke=\"#dcdcd8\"/>\n<g fill=\"#555\">\n{}</g>\n", minor,
      major, labels);
}

std::string path_of(const PlotLine& line, const Axes& axes, bool stands_back) {
  std::string path;
  for (const glm::dvec2& p : line.points)
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", axes.x(p.x), axes.y(p.y));
  return fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{}\" stroke-linejoin=\"round\"{}{}/>\n",
                     path, line.color, stands_back ? 1.6 : 2.6,
                     *line.dashes ? fmt::format(" stroke-dasharray=\"{}\"", line.dashes) : "",
                     stands_back ? " opacity=\"0.45\"" : "");
}

/// Returns the labels beside the ends of the lines, in the same order, and far enough apart to be legible.
std::string names_of(const std::vector<PlotLine>& lines, const Axes& axes) {
  struct Name {
    double y;
    const PlotLine* line;
  };
  std::vector<Name> names;
  for (const PlotLine& line : lines)
    if (!line.points.empty()) names.push_back({std::clamp(axes.y(line.points.back().y), top, bottom), &line});
  std::stable_sort(names.begin(), names.end(), [](const Name& a, const Name& b) { return a.y < b.y; });
  double lowest = top - 18;
  std::string text;
  for (Name& name : names) {
    name.y = std::max(name.y, lowest + 18);
    lowest = name.y;
    text += fmt::format("<text x=\"{}\" y=\"{:.1f}\" fill=\"{}\" font-weight=\"600\">{}</text>\n", right + 10,
                        name.y + 4, name.line->color, setup_name(name.line->setup));
  }
  return text;
}

std::string mark(const glm::dvec2& wanted, const Axes& axes) {
  const double x = axes.x(wanted.y), y = axes.y(wanted.x);
  if (!(x >= left && x <= right && y >= top && y <= bottom)) return {};
  const bool is_right = x > (left + right) / 2;
  return fmt::format(
      "<path d=\"M{0} {1:.1f}H{2:.1f}V{3}\" fill=\"none\" stroke=\"#222\" stroke-dasharray=\"2 4\"/>\n"
      "<circle cx=\"{2:.1f}\" cy=\"{1:.1f}\" r=\"4.5\" fill=\"#222\"/>\n"
      "<text x=\"{4:.1f}\" y=\"{5:.1f}\" text-anchor=\"{6}\" fill=\"#222\" stroke=\"#fff\" stroke-width=\"4\" "
      "paint-order=\"stroke\">wanted: {7:g} at {8:g}</text>\n",
      left, y, x, bottom, is_right ? x - 10 : x + 10, y - 9, is_right ? "end" : "start", wanted.x, wanted.y);
}

}  // namespace

std::string precision_plot(const ClipDistances& clip, bool orthographic, const std::optional<DepthSetup>& chosen,
                           const std::optional<glm::dvec2>& wanted) {
  std::vector<PlotLine> lines = lines_of(clip, orthographic, chosen);
  const auto is_chosen = [&](const PlotLine& line) {
    return chosen && line.setup.format == chosen->format && line.setup.reversed == chosen->reversed;
  };
  // A reversed integer buffer has the same resolution as the ordinary one, so it uses that line.
  if (chosen && std::none_of(lines.begin(), lines.end(), is_chosen))
    for (PlotLine& line : lines)
      line.setup.reversed = line.setup.format == chosen->format ? chosen->reversed : line.setup.reversed;
  const Axes axes = axes_of(lines, wanted);
  std::string paths;
  for (const PlotLine& line : lines)
    if (!is_chosen(line)) paths += path_of(line, axes, chosen.has_value());
  for (const PlotLine& line : lines)
    if (is_chosen(line)) paths += path_of(line, axes, false);
  const std::string far = std::isfinite(clip.far) ? fmt::format("{:g}", clip.far) : "infinite";
  std::string svg = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" "
      "font-family=\"Helvetica, Arial, sans-serif\" font-size=\"13\">\n<rect width=\"{0}\" height=\"{1}\" "
      "fill=\"#fff\"/>\n"
      "<clipPath id=\"plot\"><rect x=\"{2}\" y=\"{3}\" width=\"{4}\" height=\"{5}\"/></clipPath>\n",
      width, height, left, top, right - left, bottom - top);
  svg += fmt::format(
      "<text x=\"{0}\" y=\"36\" font-size=\"19\" font-weight=\"600\" fill=\"#222\">What a depth buffer can tell "
      "apart</text>\n"
      "<text x=\"{0}\" y=\"58\" fill=\"#555\">The smallest gap that is always resolved. Near {1:g}, far {2}.</text>\n",
      left, clip.near, far);
  svg += grid(axes);
  svg += fmt::format("<g clip-path=\"url(#plot)\">\n{}</g>\n", paths);
  svg += fmt::format("<path d=\"M{} {}V{}H{}\" fill=\"none\" stroke=\"#777\"/>\n", left, top, bottom, right);
  svg += names_of(lines, axes);
  if (wanted) svg += mark(*wanted, axes);
  svg += fmt::format(
      "<text x=\"{:.0f}\" y=\"{}\" text-anchor=\"middle\" fill=\"#222\">distance</text>\n"
      "<text transform=\"translate(28 {:.0f}) rotate(-90)\" text-anchor=\"middle\" fill=\"#222\">gap</text>\n</svg>\n",
      (left + right) / 2, bottom + 46, (top + bottom) / 2);
  return svg;
}

}  // namespace frontmost::cli
