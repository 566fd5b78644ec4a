#include "experiment/summary/result_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "util/median.h"

namespace ldso {
namespace {

/// A column of figures; nothing where there is none.
struct Column {
  std::string title;
  std::vector<std::optional<double>> values;
  std::vector<std::string> texts;

  bool is_empty() const {
    return std::none_of(values.begin(), values.end(), [](const auto& value) { return value.has_value(); });
  }
  void add(const std::optional<double>& value, const std::string& text) {
    values.push_back(value);
    texts.push_back(text);
  }
};

/// "12.3", "12.3 (2/10 failed)", "failed" if half of the runs did.
std::string median_text(const GroupErrors& errors) {
  std::string text = table_number(errors.median());
  if (errors.failed > 0 && errors.values.size() > 1) {
    text += " (" + std::to_string(errors.failed) + "/" + std::to_string(errors.values.size()) + " failed)";
  }
  return text;
}

Column our_column(const DatasetResults& dataset, const ErrorKind& kind, const JobFilter& filter, Trajectories which) {
  Column column;
  for (const std::string& sequence : dataset.sequences) {
    JobFilter of_sequence = filter;
    of_sequence.sequence = sequence;
    const GroupErrors errors = collect_errors(select(dataset.jobs, of_sequence), kind, which);
    column.add(errors.median(), median_text(errors));
  }
  return column;
}

bool has_both_directions(const std::vector<const JobResult*>& jobs) {
  const auto reverse = [](const JobResult* result) { return result->job.reverse; };
  return std::any_of(jobs.begin(), jobs.end(), reverse) && !std::all_of(jobs.begin(), jobs.end(), reverse);
}

std::vector<Column> our_columns(const DatasetResults& dataset, const ErrorKind& kind) {
  std::vector<Column> columns;
  for (const std::string& variant : dataset.variants) {
    for (const bool reverse : {false, true}) {
      const JobFilter filter{std::nullopt, variant, reverse};
      const auto jobs = select(dataset.jobs, filter);
      if (jobs.empty()) continue;
      const std::string title = variant + (has_both_directions(dataset.jobs) && reverse ? ", backward" : "");
      if (any_changed_by_loops(jobs, kind)) {
        columns.push_back(our_column(dataset, kind, filter, Trajectories::kBeforeLoops));
        columns.back().title = title + ", before loops";
      }
      columns.push_back(our_column(dataset, kind, filter, Trajectories::kFinal));
      columns.back().title = title;
    }
  }
  return columns;
}

std::optional<double> median_figure(const std::vector<const JobResult*>& jobs,
                                    std::optional<double> RunFigures::*figure) {
  std::vector<double> values;
  for (const JobResult* result : jobs) {
    if (result->run.*figure) values.push_back(*(result->run.*figure));
  }
  if (values.empty()) return std::nullopt;
  return median_of(std::move(values));
}

std::vector<Column> published_columns(const DatasetResults& dataset, const ErrorKind& kind,
                                      const std::vector<PublishedResults>& published) {
  std::vector<Column> columns;
  for (const PublishedResults& results : published) {
    if (results.dataset != dataset.name || results.figure != kind.name) continue;
    Column column{results.system + " (published)", {}, {}};
    for (const std::string& sequence : dataset.sequences) {
      const auto jobs = select(dataset.jobs, {sequence, std::nullopt, std::nullopt});
      const std::optional<double> value = results.value_of(sequence, median_figure(jobs, &RunFigures::frames));
      column.add(value, table_number(value));
    }
    if (!column.is_empty()) columns.push_back(std::move(column));
  }
  return columns;
}

/// A row for each name, with the smallest value in bold.
void add_rows(TextTable& table, const std::vector<std::string>& names, const std::vector<Column>& columns) {
  for (const Column& column : columns) table.head.push_back(column.title);
  for (std::size_t row = 0; row < names.size(); ++row) {
    double best = std::numeric_limits<double>::infinity();
    for (const Column& column : columns) best = std::min(best, column.values[row].value_or(best));
    table.rows.push_back({{names[row], false}});
    for (const Column& column : columns) {
      const bool is_best = columns.size() > 1 && std::isfinite(best) && column.values[row] == best;
      table.rows.back().push_back({column.texts[row], is_best});
    }
  }
}

/// The main error first; others only if there are any.
std::vector<const ErrorKind*> summary_kinds(const DatasetResults& dataset) {
  std::vector<const ErrorKind*> kinds = error_kinds(dataset.metric);
  kinds.erase(std::remove_if(kinds.begin() + 1, kinds.end(),
                             [&](const ErrorKind* kind) { return !has_any_error(dataset.jobs, *kind); }),
              kinds.end());
  return kinds;
}

TableRow summary_row(const std::string& title, const std::vector<const JobResult*>& jobs,
                     const std::vector<const ErrorKind*>& kinds, Trajectories which) {
  const GroupErrors main = collect_errors(jobs, *kinds.front(), which);
  TableRow row = {{title, false},
                  {std::to_string(jobs.size()), false},
                  {std::to_string(main.failed), false},
                  {std::to_string(main.pending), false}};
  for (const ErrorKind* kind : kinds) row.push_back({table_number(collect_errors(jobs, *kind, which).median()), false});
  return row;
}

/// Calls and time of a stage over all runs.
std::optional<double> mean_ms(const std::vector<const JobResult*>& jobs, const std::string& stage) {
  double total_ms = 0;
  std::int64_t calls = 0;
  for (const JobResult* result : jobs) {
    const auto found = result->stages.find(stage);
    if (found == result->stages.end()) continue;
    total_ms += found->second.total_ms;
    calls += found->second.calls;
  }
  if (calls == 0) return std::nullopt;
  return total_ms / static_cast<double>(calls);
}

TableRow runtime_row(const std::string& variant, const std::vector<const JobResult*>& jobs) {
  TableRow row = {{variant, false}, {std::to_string(jobs.size()), false}};
  const auto add = [&](const std::optional<double>& value) { row.push_back({table_number(value), false}); };
  add(mean_ms(jobs, "keyframe/select"));
  add(mean_ms(jobs, "keyframe"));
  add(mean_ms(jobs, "track"));
  add(median_figure(jobs, &RunFigures::frames_per_s));
  add(median_figure(jobs, &RunFigures::peak_memory_mb));
  return row;
}

}  // namespace

std::optional<TextTable> error_table(const DatasetResults& dataset, const ErrorKind& kind,
                                     const std::vector<PublishedResults>& published) {
  if (!has_any_error(dataset.jobs, kind)) return std::nullopt;
  std::vector<Column> columns = our_columns(dataset, kind);
  for (Column& column : published_columns(dataset, kind, published)) columns.push_back(std::move(column));
  TextTable table;
  table.name = std::string(kind.name) + "_" + dataset.file_name;
  table.caption = std::string(kind.title) + ", " + label_of(kind) + ", " + dataset.name + ": median over the runs";
  table.head = {"sequence"};
  add_rows(table, dataset.sequences, columns);
  return table;
}

TextTable summary_table(const DatasetResults& dataset) {
  const std::vector<const ErrorKind*> kinds = summary_kinds(dataset);
  TextTable table;
  table.name = "summary_" + dataset.file_name;
  table.caption = "Medians over all runs of all sequences, " + dataset.name;
  table.head = {"variant", "runs", "failed", "pending"};
  for (const ErrorKind* kind : kinds) table.head.push_back(label_of(*kind));
  for (const std::string& variant : dataset.variants) {
    for (const bool reverse : {false, true}) {
      const auto jobs = select(dataset.jobs, {std::nullopt, variant, reverse});
      if (jobs.empty()) continue;
      const std::string title = variant + (reverse ? ", backward" : ", forward");
      if (any_changed_by_loops(jobs, *kinds.front())) {
        table.rows.push_back(summary_row(title + ", before loops", jobs, kinds, Trajectories::kBeforeLoops));
      }
      table.rows.push_back(summary_row(title, jobs, kinds, Trajectories::kFinal));
    }
  }
  return table;
}

TextTable runtime_table(const std::vector<JobResult>& results, const std::vector<PublishedResults>& published) {
  std::map<std::string, std::vector<const JobResult*>> variants;
  std::set<std::string> strategies;
  for (const JobResult& result : results) {
    if (result.stages.empty()) continue;
    variants[result.job.variant].push_back(&result);
    strategies.insert(result.job.strategy);
  }
  TextTable table;
  table.name = "runtime";
  table.caption = "Runtime: means over keyframes and frames, frames/s and memory as medians over runs";
  table.head = {"variant",       "runs",     "selection [ms/keyframe]", "keyframe [ms]",
                "tracking [ms]", "frames/s", "peak memory [MB]"};
  for (const auto& [variant, jobs] : variants) table.rows.push_back(runtime_row(variant, jobs));
  for (const PublishedResults& others : published) {
    if (others.figure != "selection") continue;
    for (const auto& [strategy, value] : others.values) {
      if (!strategies.contains(strategy)) continue;
      const std::string title = others.system + ", " + strategy + " (published)";
      table.rows.push_back({{title}, {"-"}, {table_number(value)}, {"-"}, {"-"}, {"-"}, {"-"}});
    }
  }
  return table;
}

TextTable problem_table(const std::vector<JobResult>& results) {
  TextTable table;
  table.name = "problems";
  table.caption = "Runs without a result";
  table.head = {"job", "state", "reason"};
  for (const JobResult& result : results) {
    if (result.reason.empty()) continue;
    const std::string state = result.state == RunState::kFinished ? "not measured" : to_string(result.state);
    table.rows.push_back({{result.job.id}, {state}, {result.reason}});
  }
  return table;
}

}  // namespace ldso
