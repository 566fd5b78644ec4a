#pragma once
// A plan as YAML (docs/experiments.md lists the keys).

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiment/plan/experiment_plan.h"

namespace ldso {

/// Where the datasets lie on this machine.
struct PlanRoots {
  std::optional<std::filesystem::path> only;  ///< Of the plan's only dataset.
  std::map<std::string, std::filesystem::path> by_dataset;
};

/// From `DIR` or `NAME=DIR`, each once. Throws Error.
PlanRoots parse_roots(const std::vector<std::string>& texts);

/// Relative paths in the plan start at the folder of the file; roots given here at the current folder.
/// Throws Error naming file, line and what to do: unknown keys (with the nearest one), missing ones, wrong types,
/// settings that do not exist or are out of range.
ExperimentPlan read_plan(const std::filesystem::path& file, const PlanRoots& roots = {});

/// The same for a text; relative paths start at `folder`, messages begin with `origin`.
ExperimentPlan parse_plan(const std::string& text, const std::string& origin, const std::filesystem::path& folder,
                          const PlanRoots& roots = {});

}  // namespace ldso
