#include "experiment/results/results_file.h"

#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>
#include <type_traits>
#include <utility>

#include "experiment/jobs/job_file.h"
#include "experiment/results/csv.h"
#include "io/text/json_text.h"
#include "io/text/text_file.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kBeforeLoops = "before_loops_";  ///< Prefix of the errors of the odometry.

/// The shortest text that reads back as the same number.
std::string text_of(double value) {
  char text[64];
  const auto [end, error] = std::to_chars(text, text + sizeof(text), value);
  return error == std::errc() ? std::string(text, end) : std::string();
}

/// visit(name, member) for all figures of a result, which may be const.
template <class Result, class Visitor>
void visit_figures(Result& result, Visitor visit) {
  const auto visit_text = [&](const std::string& name, auto& value) { visit(name, value); };
  visit_errors(result.errors, visit_text);
  visit_errors(result.odometry_errors,
               [&](const std::string& name, auto& value) { visit(kBeforeLoops + name, value); });
  visit_run_figures(result.run, visit_text);
}

Json json_of(const JobResult& result) {
  const ExperimentJob& job = result.job;
  Json json;
  visit_identity(job, [&](const char* name, const auto& value) { json[name] = value; });
  json["metric"] = to_string(job.metric);
  json["state"] = to_string(result.state);
  json["reason"] = result.reason;
  visit_figures(result, [&](const std::string& name, const std::optional<double>& value) {
    if (value) json[name] = *value;
  });
  for (const auto& [name, stage] : result.stages) {
    json["stages"][name] = {{"calls", stage.calls}, {"total_ms", stage.total_ms}};
  }
  return json;
}

JobResult result_of(const Json& json) {
  JobResult result;
  ExperimentJob& job = result.job;
  visit_identity(job, [&](const char* name, auto& value) {
    value = json_value<std::remove_cvref_t<decltype(value)>>(json.at(name));
  });
  job.metric = parse_job_metric(json.at("metric").get<std::string>());
  result.state = parse_run_state(json.at("state").get<std::string>());
  json.at("reason").get_to(result.reason);
  visit_figures(result, [&](const std::string& name, std::optional<double>& value) {
    if (json.contains(name)) value = json.at(name).get<double>();
  });
  if (!json.contains("stages")) return result;
  for (const auto& [name, stage] : json.at("stages").items()) {
    result.stages[name] = {json_value<std::int64_t>(stage.at("calls")), stage.at("total_ms").get<double>()};
  }
  return result;
}

std::vector<JobResult> read_json(const fs::path& path) {
  std::vector<JobResult> jobs;
  try {
    for (const Json& json : parse_json<Json>(read_file(path), path.string())) jobs.push_back(result_of(json));
  } catch (const Json::exception& error) {
    throw Error(path.string() + ", job " + std::to_string(jobs.size() + 1), std::string("is damaged: ") + error.what(),
                "a results.json of `ldso experiment summarize` is expected");
  }
  return jobs;
}

/// A row as JSON, so that both kinds of files are read in one way.
Json json_of(const CsvRow& head, const CsvRow& row) {
  static const std::set<std::string_view> kTexts = {"id",       "dataset", "sequence", "variant",
                                                    "strategy", "metric",  "state",    "reason"};
  if (row.size() != head.size()) {
    throw Error("has " + std::to_string(row.size()) + " fields, the head line " + std::to_string(head.size()));
  }
  Json json = Json::object();
  for (std::size_t i = 0; i < head.size(); ++i) {
    double value = 0;
    if (kTexts.contains(head[i])) {
      json[head[i]] = row[i];
    } else if (head[i] == "loops" || head[i] == "reverse") {
      json[head[i]] = row[i] == "yes";
    } else if (parse_number(row[i], value) && std::isfinite(value)) {
      json[head[i]] = value;
    } else if (!row[i].empty()) {
      throw Error("column " + head[i] + ": '" + row[i] + "' is not a finite number");
    }
  }
  return json;
}

std::vector<JobResult> read_csv(const fs::path& path) {
  const std::vector<CsvRow> rows = parse_csv(read_file(path));
  std::vector<JobResult> jobs;
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const std::string place = path.string() + ", row " + std::to_string(i + 1);
    try {
      jobs.push_back(result_of(json_of(rows.front(), rows[i])));
    } catch (const Json::exception& error) {
      throw Error(place, error.what(), "a results.csv of `ldso experiment summarize` is expected");
    } catch (const Error& error) {
      throw Error(place, error.what(), "a results.csv of `ldso experiment summarize` is expected");
    }
  }
  return jobs;
}

}  // namespace

std::string results_json(const std::vector<JobResult>& jobs) {
  // A line a job: small, and a change of one shows as one.
  std::string text = "[";
  for (const JobResult& job : jobs) text.append(text.size() > 1 ? ",\n" : "\n").append(json_text(json_of(job)));
  return text + "\n]\n";
}

std::string results_csv(const std::vector<JobResult>& jobs) {
  std::set<std::string> stages;
  for (const JobResult& job : jobs) {
    for (const auto& [name, stage] : job.stages) stages.insert(name);
  }
  CsvRow head = {"id",      "dataset",    "sequence", "variant", "strategy", "loops",
                 "reverse", "repetition", "metric",   "state",   "reason"};
  const JobResult none;
  visit_figures(none, [&](const std::string& name, const auto&) { head.push_back(name); });
  for (const std::string& stage : stages) head.push_back(stage + "_ms");
  std::string text = csv_line(head);
  for (const JobResult& result : jobs) {
    const ExperimentJob& job = result.job;
    CsvRow row = {job.id,
                  job.dataset,
                  job.sequence,
                  job.variant,
                  job.strategy,
                  job.loops ? "yes" : "no",
                  job.reverse ? "yes" : "no",
                  std::to_string(job.repetition),
                  to_string(job.metric),
                  to_string(result.state),
                  result.reason};
    visit_figures(result, [&](const std::string&, const auto& value) { row.push_back(value ? text_of(*value) : ""); });
    for (const std::string& stage : stages) {
      const auto found = result.stages.find(stage);
      const bool any = found != result.stages.end() && found->second.calls > 0;
      row.push_back(any ? text_of(found->second.total_ms / static_cast<double>(found->second.calls)) : "");
    }
    text += csv_line(row);
  }
  return text;
}

std::vector<JobResult> read_results(const fs::path& path) {
  const std::string extension = to_lower(path.extension().string());
  if (extension == ".json") return read_json(path);
  if (extension == ".csv") return read_csv(path);
  throw Error(path.string(), "is no file of results", "results.json or results.csv is expected");
}

}  // namespace ldso
