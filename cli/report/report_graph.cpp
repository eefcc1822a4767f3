// SPDX-License-Identifier: Apache-2.0
// The graph of hiding: objects that nothing hides are at the top, and each object is below those that hide it.
//
// A row is a rank of that order, or a part of a rank that is too long. Objects that hide each other in a cycle share a
// rank, and lines between them are dashed.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "cli/console.h"
#include "cli/html.h"
#include "cli/report/report_page.h"

namespace frontmost::cli {
namespace {

constexpr std::size_t most_nodes = 30, most_in_row = 6;
constexpr double node_width = 140, node_height = 34, across = 164, down = 92;

struct GraphNode {
  std::uint32_t object = 0, rank = 0;
  double x = 0, y = 0;  ///< the centre
};

class HidingGraph {
 public:
  explicit HidingGraph(const ReportRun& run) : run_(run) {
    choose_pairs();
    rank_nodes();
    place_nodes();
  }

  [[nodiscard]] std::string svg() const {
    std::string text = fmt::format(
        "<svg class=\"graph\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" role=\"img\" "
        "aria-label=\"Who hides whom\"><defs><marker id=\"tip\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" "
        "markerWidth=\"8\" markerHeight=\"8\" markerUnits=\"userSpaceOnUse\" orient=\"auto\"><path d=\"M0 0L8 4L0 "
        "8z\"/>"
        "</marker></defs>\n",
        width_, height_);
    for (const HiddenSamples& pair : pairs_) text += line_of(pair);
    for (const GraphNode& node : nodes_) text += box_of(node);
    return text + "</svg>\n";
  }

 private:
  /// Chooses the pairs with the most hidden samples, with as many objects as fit.
  void choose_pairs() {
    std::vector<HiddenSamples> all = run_.accounts.hidden_by_front;
    std::stable_sort(all.begin(), all.end(),
                     [](const HiddenSamples& a, const HiddenSamples& b) { return a.count > b.count; });
    for (const HiddenSamples& pair : all) {
      const std::size_t added = (places_.count(pair.object) ? 0u : 1u) + (places_.count(pair.hider) ? 0u : 1u);
      if (nodes_.size() + added > most_nodes) continue;
      pairs_.push_back({place_of(pair.object), place_of(pair.hider), pair.count});
    }
  }

  [[nodiscard]] std::uint32_t place_of(std::uint32_t object) {
    const auto [found, is_new] = places_.insert({object, std::uint32_t(nodes_.size())});
    if (is_new) nodes_.push_back({.object = object});
    return found->second;
  }

  void rank_nodes() {
    const HidingOrder order = find_hiding_order(nodes_.size(), pairs_);
    for (std::size_t i = 0; i < nodes_.size(); ++i) nodes_[i].rank = order.ranks[i];
  }

  /// Places nodes row by row, each near the mean position of the objects that hide it.
  void place_nodes() {
    std::vector<std::vector<std::uint32_t>> rows;
    for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
      if (nodes_[i].rank >= rows.size()) rows.resize(nodes_[i].rank + 1);
      rows[nodes_[i].rank].push_back(i);
    }
    std::size_t longest = 0;
    for (const auto& row : rows) longest = std::max(longest, std::min(row.size(), most_in_row));
    width_ = double(longest) * across;
    height_ = down / 4;
    for (std::vector<std::uint32_t>& row : rows) {
      std::vector<double> wanted(nodes_.size(), 0);
      for (const std::uint32_t i : row) wanted[i] = mean_above(i);
      std::stable_sort(row.begin(), row.end(), [&](std::uint32_t a, std::uint32_t b) { return wanted[a] < wanted[b]; });
      for (std::size_t begin = 0; begin < row.size(); begin += most_in_row) {
        const std::size_t count = std::min(row.size() - begin, most_in_row);
        for (std::size_t k = 0; k < count; ++k) {
          GraphNode& node = nodes_[row[begin + k]];
          node.x = width_ / 2 + (double(k) - double(count - 1) / 2) * across;
          // Alternate nodes of a row are shifted, so that lines between neighbours do not coincide.
          node.y = height_ + node_height / 2 + (k % 2 == 1 ? 14 : 0);
        }
        height_ += down;
      }
    }
    height_ -= down / 4;
  }

  [[nodiscard]] double mean_above(std::uint32_t node) const {
    double sum = 0;
    int count = 0;
    for (const HiddenSamples& pair : pairs_)
      if (pair.object == node && nodes_[pair.hider].rank < nodes_[node].rank) sum += nodes_[pair.hider].x, ++count;
    return count == 0 ? width_ / 2 : sum / count;
  }

  [[nodiscard]] std::string line_of(const HiddenSamples& pair) const {
    const GraphNode &from = nodes_[pair.hider], &to = nodes_[pair.object];
    const bool is_down = from.rank < to.rank;
    const double y0 = from.y + (is_down ? 0.5 : from.y < to.y ? 0.5 : -0.5) * node_height;
    const double y1 = to.y - (is_down ? 0.5 : -0.5) * node_height;
    const double bend = is_down ? (y1 - y0) / 2 : 40;
    return fmt::format(
        "<path{} data-hider=\"{}\" data-hidden=\"{}\" stroke-width=\"{:.1f}\" "
        "d=\"M{:.0f} {:.0f}C{:.0f} {:.0f} {:.0f} {:.0f} {:.0f} {:.0f}\"><title>{} hides {} samples of {}</title>"
        "</path>\n",
        is_down ? "" : " class=\"ring\"", from.object, to.object, 1 + std::log10(double(pair.count)), from.x, y0,
        from.x, y0 + bend, to.x, y1 + (is_down ? -bend : bend), to.x, y1, name_of(from), grouped(pair.count),
        name_of(to));
  }

  [[nodiscard]] std::string box_of(const GraphNode& node) const {
    return fmt::format(
        "<g class=\"node\" data-object=\"{}\"><rect x=\"{:.0f}\" y=\"{:.0f}\" width=\"{:.0f}\" height=\"{:.0f}\" "
        "rx=\"8\"/><text x=\"{:.0f}\" y=\"{:.0f}\">{}</text><title>{}</title></g>\n",
        node.object, node.x - node_width / 2, node.y - node_height / 2, node_width, node_height, node.x, node.y + 5,
        html_text(shortened(run_.names[node.object], 18)), name_of(node));
  }

  [[nodiscard]] std::string name_of(const GraphNode& node) const { return html_text(run_.names[node.object]); }

  const ReportRun& run_;
  std::vector<GraphNode> nodes_;
  std::map<std::uint32_t, std::uint32_t> places_;  // index in `nodes_`, by object
  std::vector<HiddenSamples> pairs_;               // indices in `nodes_`
  double width_ = 0, height_ = 0;
};

}  // namespace

std::string report_graph(const ReportRun& run) {
  return run.accounts.hidden_by_front.empty() ? "" : HidingGraph(run).svg();
}

}  // namespace frontmost::cli
