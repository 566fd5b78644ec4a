#pragma once
// What a doctor says of a sequence.

#include <string>
#include <vector>

namespace ldso {

enum class Severity {
  kNote,     ///< Worth knowing; results do not suffer.
  kWarning,  ///< Results will suffer, or there will be none.
  kError,    ///< The sequence cannot be run.
};

struct Finding {
  std::string id;  ///< "times.gaps": the same in all versions, for programs.
  Severity severity = Severity::kNote;
  double weight = 0;   ///< Among findings of one severity the largest comes first.
  std::string what;    ///< What is wrong, with the figure it was seen by.
  std::string remedy;  ///< What to do about it.
};

using Findings = std::vector<Finding>;

}  // namespace ldso
