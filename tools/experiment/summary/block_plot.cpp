#include "experiment/summary/block_plot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluation/svg_chart.h"
#include "experiment/summary/colour_scale.h"
#include "experiment/summary/text_table.h"
#include "util/format_text.h"

namespace ldso {
namespace {

constexpr double kTop = 84;
constexpr double kGroupGap = 6;  ///< Between variants and directions.
constexpr double kLetter = 7.0;  ///< Width of a letter of 12 px.
constexpr double kLegendWidth = 190;
constexpr double kLeastLegendHeight = 260;
constexpr const char* kFailedColour = "#D55E00";

/// The rows of one variant and direction.
struct RowGroup {
  std::string variant;
  bool reverse = false;
  int rows = 0;
};

std::vector<RowGroup> row_groups(const DatasetResults& dataset) {
  std::vector<RowGroup> groups;
  for (const std::string& variant : dataset.variants) {
    for (const bool reverse : {false, true}) {
      int rows = 0;
      for (const std::string& sequence : dataset.sequences) {
        rows = std::max(rows, static_cast<int>(select(dataset.jobs, {sequence, variant, reverse}).size()));
      }
      if (rows > 0) groups.push_back({variant, reverse, rows});
    }
  }
  return groups;
}

/// Sizes of everything [px].
struct Layout {
  double left = 0, cell_width = 0, cell_height = 0, width = 0, height = 0;
  double blocks_height = 0, labels_height = 0;
  bool upright = false;  ///< Names of sequences run upwards.
};

std::size_t longest(const std::vector<std::string>& names) {
  std::size_t length = 0;
  for (const std::string& name : names) length = std::max(length, name.size());
  return length;
}

std::string title_of(const DatasetResults& dataset, const ErrorKind& kind) {
  return std::string(kind.title) + " of each run" + (dataset.name.empty() ? "" : ", " + dataset.name);
}

Layout layout_of(const DatasetResults& dataset, const std::vector<RowGroup>& groups, std::size_t title_length) {
  Layout layout;
  int rows = 0;
  for (const RowGroup& group : groups) rows += group.rows;
  const double columns = static_cast<double>(dataset.sequences.size());
  layout.cell_height = std::clamp(640.0 / std::max(rows, 1), 10.0, 24.0);
  layout.cell_width = std::clamp(900 / std::max(columns, 1.0), 15.0, 2 * layout.cell_height);
  layout.left = 40 + kLetter * static_cast<double>(std::max(longest(dataset.variants), std::size_t{8})) + 68;
  layout.blocks_height = rows * layout.cell_height + kGroupGap * static_cast<double>(groups.size() - 1);
  const double name_width = kLetter * static_cast<double>(longest(dataset.sequences));
  layout.upright = name_width > layout.cell_width - 2;
  layout.labels_height = (layout.upright ? name_width : 14) + 34;
  layout.width =
      std::max(layout.left + columns * layout.cell_width + kLegendWidth, 48 + 10.6 * static_cast<double>(title_length));
  layout.height = kTop + std::max(layout.blocks_height + layout.labels_height, kLeastLegendHeight + 70);
  return layout;
}

std::string rectangle(const SvgBox& box, const std::string& fill, const std::string& title) {
  const std::string text = format_text("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"%s\"", box.x,
                                       box.y, box.width, box.height, fill.c_str());
  return std::string(text) + " stroke=\"#c8c8c8\" stroke-width=\"0.5\">" +
         (title.empty() ? "" : "<title>" + xml_escape(title) + "</title>") + "</rect>\n";
}

std::string cross(const SvgBox& box) {
  const double inset = 0.2 * std::min(box.width, box.height);
  return format_text(
      "<path d=\"M%.1f %.1fL%.1f %.1fM%.1f %.1fL%.1f %.1f\" stroke=\"%s\" stroke-width=\"1.8\" "
      "pointer-events=\"none\"/>\n",
      box.x + inset, box.y + inset, box.x + box.width - inset, box.y + box.height - inset, box.x + inset,
      box.y + box.height - inset, box.x + box.width - inset, box.y + inset, kFailedColour);
}

std::string question_mark(const SvgBox& box) {
  return svg_text(box.x + 0.5 * box.width, box.y + 0.5 * box.height + 4, "?", std::min(12.0, box.height), "middle",
                  "pointer-events=\"none\"");
}

std::string draw_run(const JobResult& result, const ErrorKind& kind, const ErrorColours& colours, const SvgBox& box) {
  const std::string name = result.job.id + ": ";
  const std::string reason = result.reason.empty() ? "" : " (" + result.reason + ")";
  if (result.state == RunState::kPending) return rectangle(box, "#f2f2f2", name + "pending" + reason);
  if (result.state == RunState::kFailed) return rectangle(box, "white", name + "failed" + reason) + cross(box);
  const std::optional<double> error = counted_error(result, kind);
  if (!error) return rectangle(box, "#f2f2f2", name + "not measured" + reason) + question_mark(box);
  return rectangle(box, colours.colour(*error), (name + table_number(*error)).append(" ").append(kind.unit));
}

std::string draw_blocks(const DatasetResults& dataset, const std::vector<RowGroup>& groups, const Layout& layout,
                        const ErrorKind& kind, const ErrorColours& colours) {
  std::string svg;
  double top = kTop;
  for (const RowGroup& group : groups) {
    for (std::size_t column = 0; column < dataset.sequences.size(); ++column) {
      const double x = layout.left + static_cast<double>(column) * layout.cell_width;
      double y = top;
      for (const JobResult* result : select(dataset.jobs, {dataset.sequences[column], group.variant, group.reverse})) {
        svg += draw_run(*result, kind, colours, {x, y, layout.cell_width, layout.cell_height});
        y += layout.cell_height;
      }
    }
    top += group.rows * layout.cell_height + kGroupGap;
  }
  return svg;
}

std::string draw_row_labels(const std::vector<RowGroup>& groups, const Layout& layout) {
  std::string svg;
  double top = kTop;
  for (std::size_t i = 0; i < groups.size(); ++i) {
    const double height = groups[i].rows * layout.cell_height;
    const double middle = top + 0.5 * height + 4;
    svg += svg_text(layout.left - 8, middle, groups[i].reverse ? "backward" : "forward", 12, "end");
    if (i == 0 || groups[i].variant != groups[i - 1].variant) {
      double end = top + height;
      for (std::size_t j = i + 1; j < groups.size() && groups[j].variant == groups[i].variant; ++j) {
        end += kGroupGap + groups[j].rows * layout.cell_height;
      }
      svg += svg_text(layout.left - 72, 0.5 * (top + end) + 4, groups[i].variant, 12, "end", "font-weight=\"bold\"");
    }
    top += height + kGroupGap;
  }
  return svg;
}

std::string draw_column_labels(const DatasetResults& dataset, const Layout& layout) {
  const double top = kTop + layout.blocks_height;
  std::string svg;
  for (std::size_t column = 0; column < dataset.sequences.size(); ++column) {
    const double x = layout.left + (static_cast<double>(column) + 0.5) * layout.cell_width;
    if (layout.upright) {
      const std::string turn = format_text("transform=\"rotate(-90 %.1f %.1f)\"", x + 4, top + 6);
      svg += svg_text(x + 4, top + 6, dataset.sequences[column], 12, "end", turn);
    } else {
      svg += svg_text(x, top + 17, dataset.sequences[column], 12, "middle");
    }
  }
  const double middle = layout.left + 0.5 * layout.cell_width * static_cast<double>(dataset.sequences.size());
  return svg + svg_text(middle, top + layout.labels_height - 8, "sequence", 14, "middle");
}

std::string draw_legend(const DatasetResults& dataset, const Layout& layout, const ErrorKind& kind,
                        const ErrorColours& colours) {
  const double x = layout.left + layout.cell_width * static_cast<double>(dataset.sequences.size()) + 34;
  double y = kTop + 22;
  std::string svg = colours.legend({x, y, 22, kLeastLegendHeight - 60}, label_of(kind));
  y += kLeastLegendHeight - 60 + 24;
  const GroupErrors errors = collect_errors(dataset.jobs, kind);
  const auto add = [&](const std::string& fill, const std::string& text) {
    const SvgBox box{x, y, 18, 18};
    svg += rectangle(box, fill, "") + svg_text(x + 26, y + 13, text, 12);
    y += 26;
    return box;
  };
  if (errors.failed > 0) svg += cross(add("white", "failed: " + std::to_string(errors.failed)));
  if (errors.pending > 0) add("#f2f2f2", "pending: " + std::to_string(errors.pending));
  if (errors.unmeasured > 0) svg += question_mark(add("#f2f2f2", "not measured: " + std::to_string(errors.unmeasured)));
  return svg;
}

}  // namespace

std::string block_plot(const DatasetResults& dataset, const ErrorKind& kind) {
  const std::vector<RowGroup> groups = row_groups(dataset);
  const std::string title = title_of(dataset, kind);
  const Layout layout = layout_of(dataset, groups, title.size());
  const ErrorColours colours(collect_errors(dataset.jobs, kind).values);
  return svg_document(layout.width, layout.height,
                      svg_text(24, 30, title, 18, "start", "font-weight=\"bold\"") +
                          svg_text(24, 52, "one square a run; dark is good", 13, "start", "fill=\"#555555\"") +
                          draw_blocks(dataset, groups, layout, kind, colours) + draw_row_labels(groups, layout) +
                          draw_column_labels(dataset, layout) + draw_legend(dataset, layout, kind, colours));
}

}  // namespace ldso
