#pragma once
// What is wrong with the images of a sequence.

#include "doctor/finding.h"
#include "doctor/image_survey.h"

namespace ldso {

/// Light, sharpness, texture, repeated images, speed, and what stays in the image. `size`: frames of the sequence.
Findings image_findings(const ImageSurvey& survey, int size);

/// The figures that they are made of, by name, for programs and for those who doubt a finding.
std::vector<std::pair<std::string, double>> image_figures(const ImageSurvey& survey);

/// What `--mask` should be given: 255 where something is drawn over the image or nothing is shown; empty if there is
/// nothing of the kind.
Image<std::uint8_t> proposed_mask(const ImageSurvey& survey);

}  // namespace ldso
