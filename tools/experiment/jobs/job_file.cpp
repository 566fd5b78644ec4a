#include "experiment/jobs/job_file.h"

#include <nlohmann/json.hpp>
#include <type_traits>

#include "io/text/json_text.h"
#include "io/text/output_folder.h"
#include "ldso/error.h"
#include "util/whole_file.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kFileName = "job.json";

Json json_of(const ExperimentJob& job) {
  Json json;
  visit_identity(job, [&](const char* name, const auto& value) { json[name] = value; });
  json["metric"] = to_string(job.metric);
  json["path"] = job.path.string();
  json["ground_truth"] = job.ground_truth ? Json(job.ground_truth->string()) : Json();
  json["arguments"] = job.arguments;
  return json;
}

ExperimentJob job_of(const Json& json) {
  ExperimentJob job;
  visit_identity(job, [&](const char* name, auto& value) {
    value = json_value<std::remove_cvref_t<decltype(value)>>(json.at(name));
  });
  job.path = json.at("path").get<std::string>();
  job.metric = parse_job_metric(json.at("metric").get<std::string>());
  if (const Json& truth = json.at("ground_truth"); !truth.is_null()) job.ground_truth = truth.get<std::string>();
  json.at("arguments").get_to(job.arguments);
  return job;
}

}  // namespace

std::string to_string(JobMetric metric) { return metric == JobMetric::kTumMono ? "tum_mono" : "ate"; }

JobMetric parse_job_metric(const std::string& name) {
  for (const JobMetric metric : {JobMetric::kAte, JobMetric::kTumMono}) {
    if (name == to_string(metric)) return metric;
  }
  throw Error("metric " + name, "there is no such metric", "allowed are ate and tum_mono");
}

void write_job(const fs::path& folder, const ExperimentJob& job) {
  create_folder(folder);
  write_file(folder / kFileName, json_text(json_of(job), 2) + "\n");
}

bool has_job(const fs::path& folder) {
  try {
    read_job(folder);
    return true;
  } catch (const Error&) {
    return false;
  }
}

ExperimentJob read_job(const fs::path& folder) {
  const fs::path path = folder / kFileName;
  const std::string text = read_file(path);
  try {
    return job_of(parse_json<Json>(text, path.string()));
  } catch (const Json::exception& error) {
    throw Error(path.string(), std::string("is not the description of a job (") + error.what() + ")",
                "remove the folder of the job; the experiment makes it again");
  }
}

}  // namespace ldso
