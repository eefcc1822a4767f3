// SPDX-License-Identifier: Apache-2.0
// Advice on which method suits this scene and machine. Each sentence gives the figure that it is based on.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cli/compare/compare_report.h"
#include "cli/console.h"

namespace frontmost::cli {
namespace {

/// The time from surfaces to answer for the first view (`once`), and for each further view of the same surfaces
/// (`again`).
struct Cost {
  const Compared* method;
  double once, again;
};

Cost cost_of(const Compared& compared) {
  const double index = compared.run.median_of("index").value_or(0), visible = *compared.run.median_of("visible");
  return {&compared, index + visible, visible};
}

std::string_view title(const Cost& cost) { return cost.method->run.method->title; }

std::string times(double ratio) { return ratio < 10 ? fmt::format("{:.1f}", ratio) : fmt::format("{:.0f}", ratio); }

/// Returns the number of views after which a method with preparation overtakes one without, or 0 if it never does.
double views_to_catch_up(const Cost& prepared, const Cost& plain) {
  const double gain = plain.again - prepared.again, lead = prepared.once - plain.once;
  return gain > 0 && lead > 0 ? std::ceil(lead / gain) + 1 : 0;
}

std::string single_view(const std::vector<Cost>& costs) {
  const auto by_once = [](const Cost& a, const Cost& b) { return a.once < b.once; };
  std::vector<Cost> sorted = costs;
  std::sort(sorted.begin(), sorted.end(), by_once);
  std::string text =
      fmt::format("One view: {} is quickest, {:.2f} ms from surfaces to answer", title(sorted[0]), sorted[0].once);
  for (std::size_t i = 1; i < sorted.size(); ++i)
    text += fmt::format("{} {} takes {} times as long", i == 1 ? ";" : ",", title(sorted[i]),
                        times(sorted[i].once / sorted[0].once));
  return text + ".";
}

std::string many_views(const std::vector<Cost>& costs) {
  const Cost& best =
      *std::min_element(costs.begin(), costs.end(), [](const Cost& a, const Cost& b) { return a.again < b.again; });
  const Cost& first =
      *std::min_element(costs.begin(), costs.end(), [](const Cost& a, const Cost& b) { return a.once < b.once; });
  if (best.method == first.method)
    return fmt::format("Many views of the same model: {} again, {:.2f} ms each.", title(best), best.again);
  const double views = views_to_catch_up(best, first);
  return fmt::format("Many views of the same model: {}, {:.2f} ms each; its preparation pays off after {:.0f} views.",
                     title(best), best.again, views);
}

std::string memory(const std::vector<Cost>& costs) {
  const auto bytes = [](const Cost& cost) { return cost.method->run.peak_bytes; };
  const auto [least, most] = std::minmax_element(costs.begin(), costs.end(),
                                                 [&](const Cost& a, const Cost& b) { return bytes(a) < bytes(b); });
  return fmt::format("Memory beside the model: {} takes least, {}; {} most, {}.", title(*least),
                     mebibytes(bytes(*least)), title(*most), mebibytes(bytes(*most)));
}

std::string transparency(const Comparisons& all) {
  std::uint64_t seen_through = 0;
  for (const Compared& compared : all.methods)
    seen_through = std::max(seen_through, compared.agreement.count(Difference::translucent));
  if (seen_through == 0)
    return "Nothing is seen through a translucent surface, so the front-most surfaces are the whole picture.";
  return fmt::format(
      "In {} {} something is seen through a translucent surface: there only the A-buffer shows what lies behind.",
      grouped(seen_through), spots(all.view));
}

/// Returns a sentence about a method's mistakes, or nothing if it makes none by design.
std::optional<std::string> mistakes(const Compared& compared, const Comparisons& all) {
  if (compared.wrong_by_design() == 0) return std::nullopt;
  return fmt::format("{}: wrong in {} of {} {}, by design.", compared.run.method->title,
                     grouped(compared.wrong_by_design()), grouped(all.view.sample_count()), spots(all.view));
}

std::string trust(const Comparisons& all) {
  std::uint64_t differing = 0, unexplained = 0;
  for (const Compared& compared : all.methods) {
    if (compared.run.method->is_naive) continue;
    differing =
        std::max(differing, compared.agreement.count(Difference::edge) + compared.agreement.count(Difference::depth));
    unexplained += compared.unexplained();
  }
  if (unexplained > 0)
    return fmt::format("{} {} are unexplained, which is a bug in a method. Please report this model.", unexplained,
                       spots(all.view));
  if (differing == 0) return "All methods find the same front-most surface everywhere.";
  return fmt::format(
      "Front-most surfaces differ in {} of {} {} at most. Exact arithmetic allows both answers in each of them: "
      "neither is wrong.",
      grouped(differing), grouped(all.view.sample_count()), spots(all.view));
}

}  // namespace

std::vector<std::string> advice(const Comparisons& all) {
  std::vector<Cost> costs;
  for (const Compared& compared : all.methods)
    if (!compared.run.method->is_naive) costs.push_back(cost_of(compared));
  std::vector<std::string> lines{single_view(costs),
                                 many_views(costs),
                                 memory(costs),
                                 transparency(all),
                                 "Lines of sight and other single rays: ray casting; one index serves all rays.",
                                 trust(all)};
  for (const Compared& compared : all.methods)
    if (std::optional<std::string> line = mistakes(compared, all)) lines.push_back(std::move(*line));
  return lines;
}

}  // namespace frontmost::cli
