#include "doctor/diagnosis.h"

#include <algorithm>
#include <cmath>

#include "doctor/image_findings.h"
#include "doctor/image_survey.h"
#include "doctor/time_findings.h"
#include "doctor/trial_run.h"
#include "ldso/io/calibration_file.h"
#include "util/format_text.h"
#include "util/median.h"

namespace ldso {
namespace {

/// What reading the sequence said already. Times that do not grow are counted with the times.
Findings input_findings(const Dataset& dataset) {
  const std::vector<std::string>& doubts = dataset.calibration().warnings;
  Findings findings;
  for (const std::string& warning : dataset.warnings()) {
    if (warning.find("timestamps are not later") != std::string::npos) continue;
    const bool is_doubt = std::find(doubts.begin(), doubts.end(), warning) != doubts.end();
    findings.push_back({is_doubt ? "calibration.implausible" : "input", is_doubt ? Severity::kWarning : Severity::kNote,
                        is_doubt ? 85.0 : 10.0, warning, ""});
  }
  return findings;
}

std::vector<double> times_of(const Dataset& dataset) {
  std::vector<double> times;
  for (int i = 0; i < dataset.size(); ++i) times.push_back(dataset.timestamp(i));
  return times;
}

double rate_of(const std::vector<double>& times) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(std::abs(times[i] - times[i - 1]));
  const double step = steps.empty() ? 0 : median_of(steps);
  return step > 0 ? 1 / step : 0;
}

std::string summarize(const Dataset& dataset, const std::vector<double>& times) {
  const Calibration& calibration = dataset.calibration();
  return format_text("%s, %d frames, %.2f frames/s, ", dataset.format_name().c_str(), dataset.size(), rate_of(times)) +
         describe(calibration.camera, calibration.rectification) + " (" + calibration.description + ")" +
         (calibration.photometric.inverse_response ? ", response known" : "") +
         (calibration.photometric.vignette.empty() ? "" : ", vignette known");
}

void append(Findings& all, Findings more) { all.insert(all.end(), more.begin(), more.end()); }

void sort_by_weight(Findings& findings) {
  std::stable_sort(findings.begin(), findings.end(), [](const Finding& a, const Finding& b) {
    return a.severity != b.severity ? a.severity > b.severity : a.weight > b.weight;
  });
}

const char* name_of(Severity severity) {
  if (severity == Severity::kError) return "error";
  return severity == Severity::kWarning ? "warning" : "note";
}

void add_trial(const Dataset& dataset, int frames, const DoctorProgress& progress, Diagnosis& diagnosis) {
  const TrialRun trial = try_sequence(dataset, frames, [&](int done, int count) {
    if (progress) progress("a run of the first frames", done, count);
  });
  append(diagnosis.findings, trial_findings(trial, dataset));
  diagnosis.figures.insert(
      diagnosis.figures.end(),
      {{"trial_frames", trial.frames}, {"trial_poses", static_cast<double>(trial.run.result.trajectory().size())}});
}

}  // namespace

Diagnosis examine(const Dataset& dataset, const std::string& name, int trial_frames, const DoctorProgress& progress) {
  Diagnosis diagnosis;
  const std::vector<double> times = times_of(dataset);
  diagnosis.sequence = name;
  diagnosis.summary = summarize(dataset, times);
  append(diagnosis.findings, input_findings(dataset));
  append(diagnosis.findings, time_findings(times));
  const ImageSurvey survey = survey_images(dataset, [&](int done, int count) {
    if (progress) progress("images", done, count);
  });
  append(diagnosis.findings, image_findings(survey, dataset.size()));
  diagnosis.figures = image_figures(survey);
  diagnosis.mask = proposed_mask(survey);
  if (trial_frames > 0) add_trial(dataset, trial_frames, progress, diagnosis);
  sort_by_weight(diagnosis.findings);
  return diagnosis;
}

Diagnosis unopened(const std::string& name, const std::string& problem) {
  Diagnosis diagnosis;
  diagnosis.sequence = name;
  diagnosis.findings.push_back({"input.unusable", Severity::kError, 100, problem, ""});
  return diagnosis;
}

int exit_code_of(const Diagnosis& diagnosis) {
  if (diagnosis.findings.empty()) return 0;
  const Severity worst = diagnosis.findings.front().severity;
  if (worst == Severity::kError) return 1;
  return worst == Severity::kWarning ? 2 : 0;
}

std::string diagnosis_text(const Diagnosis& diagnosis) {
  std::string text = diagnosis.sequence + "\n";
  if (!diagnosis.summary.empty()) text += "  " + diagnosis.summary + "\n";
  if (diagnosis.findings.empty()) text += "Nothing was found.\n";
  for (const Finding& finding : diagnosis.findings) {
    text += format_text("\n%s [%s]\n  ", name_of(finding.severity), finding.id.c_str()) + finding.what + "\n";
    if (!finding.remedy.empty()) text += "  -> " + finding.remedy + "\n";
  }
  return text;
}

nlohmann::ordered_json diagnosis_json(const Diagnosis& diagnosis) {
  using Json = nlohmann::ordered_json;
  Json findings = Json::array(), figures = Json::object();
  for (const Finding& finding : diagnosis.findings) {
    findings.push_back({{"id", finding.id},
                        {"severity", name_of(finding.severity)},
                        {"what", finding.what},
                        {"remedy", finding.remedy}});
  }
  for (const auto& [name, value] : diagnosis.figures) figures[name] = std::isfinite(value) ? Json(value) : Json();
  return {{"sequence", diagnosis.sequence},
          {"summary", diagnosis.summary},
          {"findings", std::move(findings)},
          {"figures", std::move(figures)},
          {"exit_code", exit_code_of(diagnosis)}};
}

}  // namespace ldso
