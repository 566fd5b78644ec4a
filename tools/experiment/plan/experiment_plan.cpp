#include "experiment/plan/experiment_plan.h"

#include <fnmatch.h>

#include <algorithm>
#include <system_error>
#include <utility>

#include "experiment/jobs/job_folder.h"
#include "io/text/nearest_name.h"
#include "ldso/error.h"

namespace ldso {
namespace {

namespace fs = std::filesystem;

/// The shortest decimal that reads back as the same number would be enough; frame rates have few digits.
std::string text_of(double number) {
  std::string text = std::to_string(number);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

void add_playback(const DatasetOptions& playback, std::vector<std::string>& arguments) {
  if (playback.start > 0) arguments.insert(arguments.end(), {"--start", std::to_string(playback.start)});
  if (playback.end) arguments.push_back("--end=" + std::to_string(*playback.end));  // It may begin with '-'.
  if (playback.stride > 1) arguments.insert(arguments.end(), {"--stride", std::to_string(playback.stride)});
  if (playback.reverse) arguments.emplace_back("--reverse");
  if (playback.calibration_file) arguments.insert(arguments.end(), {"--calib", playback.calibration_file->string()});
  if (playback.fps) arguments.insert(arguments.end(), {"--fps", text_of(*playback.fps)});
}

DatasetOptions playback_of(const PlanSequence& sequence, Vary vary, bool reverse, int repetition) {
  DatasetOptions playback = sequence.playback;
  playback.reverse = reverse;
  if (vary != Vary::kStart || repetition == 0) return playback;
  if (reverse) {
    // An end counted from the start must not turn into one counted from the end.
    const int end = playback.end.value_or(0);
    playback.end = end > 0 ? std::max(end - repetition, 1) : end - repetition;
  } else {
    playback.start += repetition;
  }
  return playback;
}

std::vector<std::string> arguments_of(const ExperimentPlan& plan, const PlanSequence& sequence,
                                      const PlanVariant& variant, const ExperimentJob& job, const fs::path& folder) {
  std::vector<std::string> arguments{"run", sequence.path.string(), "-o", folder.string()};
  add_playback(playback_of(sequence, plan.vary, job.reverse, job.repetition), arguments);
  if (!variant.loops) arguments.emplace_back("--no-loops");
  arguments.insert(arguments.end(), {"--threads", std::to_string(plan.threads)});
  if (sequence.config) arguments.insert(arguments.end(), {"--config", sequence.config->string()});
  std::vector<std::string> settings{"selection.strategy=" + variant.strategy};
  settings.insert(settings.end(), sequence.settings.begin(), sequence.settings.end());
  settings.insert(settings.end(), variant.settings.begin(), variant.settings.end());
  if (plan.vary == Vary::kSeed) settings.push_back("selection.seed=" + std::to_string(1 + job.repetition));
  for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
  return arguments;
}

ExperimentJob make_job(const ExperimentPlan& plan, const PlanSequence& sequence, const PlanVariant& variant,
                       bool reverse, int repetition, const fs::path& experiment) {
  ExperimentJob job;
  job.id = sequence.name + "/" + variant.name + "/" + (reverse ? "backward_" : "forward_") + std::to_string(repetition);
  job.sequence = sequence.name;
  job.dataset = sequence.dataset;
  job.path = sequence.path;
  job.variant = variant.name;
  job.strategy = variant.strategy;
  job.loops = variant.loops;
  job.reverse = reverse;
  job.repetition = repetition;
  job.metric = sequence.metric;
  job.ground_truth = sequence.ground_truth;
  job.arguments = arguments_of(plan, sequence, variant, job, job_folder(experiment, job.id));
  return job;
}

bool matches(const std::string& id, const std::string& pattern) {
  if (pattern.find_first_of("*?[") == std::string::npos) return id.find(pattern) != std::string::npos;
  return fnmatch(pattern.c_str(), id.c_str(), 0) == 0;
}

bool is_there(const fs::path& path) {
  std::error_code error;
  return fs::exists(path, error);
}

/// Of "a|b|c": whether one is there.
bool any_is_there(const fs::path& folder, const std::string& alternatives) {
  for (std::size_t begin = 0; begin <= alternatives.size();) {
    const std::size_t end = std::min(alternatives.find('|', begin), alternatives.size());
    if (is_there(folder / alternatives.substr(begin, end - begin))) return true;
    begin = end + 1;
  }
  return false;
}

std::string readable(std::string alternatives) {
  for (std::size_t at = 0; (at = alternatives.find('|', at)) != std::string::npos; at += 4)
    alternatives.replace(at, 1, " or ");
  return alternatives;
}

std::vector<std::string> missing_parts(const PlanSequence& sequence) {
  if (sequence.path.empty()) return {};
  if (!is_there(sequence.path)) return {sequence.path.string() + " (there is no such folder)"};
  std::vector<std::string> missing;
  for (const std::string& need : sequence.needs) {
    if (!any_is_there(sequence.path, need))
      missing.push_back((sequence.path / readable(need)).lexically_normal().string());
  }
  for (const auto& file : {sequence.playback.calibration_file, sequence.ground_truth}) {
    if (file && !is_there(*file)) missing.push_back(file->string());
  }
  return missing;
}

}  // namespace

std::vector<ExperimentJob> plan_jobs(const ExperimentPlan& plan, const fs::path& experiment) {
  const fs::path folder = fs::absolute(experiment).lexically_normal();
  std::vector<ExperimentJob> jobs;
  for (int repetition = 0; repetition < plan.repetitions; ++repetition) {
    for (const PlanSequence& sequence : plan.sequences) {
      for (const PlanVariant& variant : plan.variants) {
        for (const bool reverse : plan.directions)
          jobs.push_back(make_job(plan, sequence, variant, reverse, repetition, folder));
      }
    }
  }
  return jobs;
}

std::vector<ExperimentJob> select_jobs(const std::vector<ExperimentJob>& jobs,
                                       const std::vector<std::string>& patterns) {
  if (patterns.empty()) return jobs;
  std::vector<ExperimentJob> selected;
  std::vector<bool> used(patterns.size(), false);
  for (const ExperimentJob& job : jobs) {
    bool wanted = false;
    for (std::size_t i = 0; i < patterns.size(); ++i) {
      if (!matches(job.id, patterns[i])) continue;
      wanted = used[i] = true;
    }
    if (wanted) selected.push_back(job);
  }
  const auto unused = std::find(used.begin(), used.end(), false);
  if (unused != used.end()) {
    throw Error("--only " + patterns[static_cast<std::size_t>(unused - used.begin())],
                "no job of the plan is called so",
                jobs.empty() ? "" : "a job is called, for instance, " + jobs.front().id);
  }
  return selected;
}

std::vector<IncompleteSequence> find_incomplete(const ExperimentPlan& plan) {
  std::vector<IncompleteSequence> incomplete;
  for (const PlanSequence& sequence : plan.sequences) {
    std::vector<std::string> missing = missing_parts(sequence);
    if (!missing.empty() || sequence.path.empty())
      incomplete.push_back({sequence.name, sequence.dataset, std::move(missing), sequence.download});
  }
  return incomplete;
}

std::string describe_incomplete(const std::vector<IncompleteSequence>& sequences, std::size_t planned) {
  std::string text = std::to_string(sequences.size()) + " of " + std::to_string(planned) +
                     " sequences of the plan cannot be run. Missing:";
  std::vector<std::string> said;
  const auto say_once = [&](const std::string& line) {
    if (std::find(said.begin(), said.end(), line) != said.end()) return;
    said.push_back(line);
    text.append("\n  ").append(line);
  };
  for (const IncompleteSequence& sequence : sequences) {
    if (sequence.missing.empty())
      say_once(sequence.dataset + ": nothing says where it lies; give --root " + sequence.dataset + "=FOLDER");
    for (const std::string& part : sequence.missing)
      text.append("\n  ").append(sequence.name).append(": ").append(part);
  }
  for (const IncompleteSequence& sequence : sequences) {
    if (!sequence.download.empty()) say_once(sequence.dataset + " can be had here: " + sequence.download);
  }
  return text;
}

void remove_sequences(ExperimentPlan& plan, const std::vector<IncompleteSequence>& sequences) {
  std::erase_if(plan.sequences, [&](const PlanSequence& sequence) {
    return std::any_of(sequences.begin(), sequences.end(),
                       [&](const IncompleteSequence& other) { return other.name == sequence.name; });
  });
}

}  // namespace ldso
