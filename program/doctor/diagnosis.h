#pragma once
// All that is wrong with a sequence, in order of weight.

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "doctor/finding.h"
#include "ldso/image.h"
#include "ldso/io/dataset.h"

namespace ldso {

struct Diagnosis {
  std::string sequence;
  std::string summary;  ///< Format, frames, rate, camera.
  Findings findings;    ///< The gravest first.
  std::vector<std::pair<std::string, double>> figures;
  Image<std::uint8_t> mask;  ///< That is proposed: 255 where nothing is to be used. Empty: none.
};

/// `stage` names what is being done, with how much of it is.
using DoctorProgress = std::function<void(const std::string& stage, int done, int count)>;

/// `trial_frames`: frames that are run; 0: none, then nothing is said of motion and shutter.
Diagnosis examine(const Dataset& dataset, const std::string& name, int trial_frames,
                  const DoctorProgress& progress = {});

/// Of a sequence that cannot be opened: what the error says.
Diagnosis unopened(const std::string& name, const std::string& problem);

/// 0: nothing but notes; 2: warnings; 1: it cannot be run.
int exit_code_of(const Diagnosis& diagnosis);

/// For people.
std::string diagnosis_text(const Diagnosis& diagnosis);
nlohmann::ordered_json diagnosis_json(const Diagnosis& diagnosis);

}  // namespace ldso
