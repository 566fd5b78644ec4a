#pragma once
// What `ldso eval` says: the result as a table for people and as JSON for programs.

#include <string>

#include "evaluation/trajectory_evaluation.h"

namespace ldso {

/// Several lines, each ending in a newline; every figure on a line of its own that begins with its name.
std::string result_table(const EvaluationResult& result);

/// A JSON object, indented; figures that do not exist for this pair of trajectories are null.
std::string result_json(const EvaluationResult& result);

}  // namespace ldso
