#include "doctor/image_findings.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "io/images/dark_border.h"
#include "util/format_text.h"
#include "util/median.h"

namespace ldso {
namespace {

// What healthy sequences keep clear of; docs/doctor.md has the figures that these were chosen by.
constexpr int kSmallSide = 100;           // of an image [px]
constexpr double kDark = 45;              // grey level that 2 % of the pixels exceed
constexpr double kWhiteShare = 0.2;       // of saturated pixels
constexpr double kLowContrast = 35;       // between dark and bright [grey levels]
constexpr double kLevelsShare = 0.45;     // of grey levels that occur
constexpr double kSoft = 2.6;             // softness of all images
constexpr double kBlurred = 0.45;         // edges of an image beside those of its neighbours
constexpr double kSameLight = 0.15;       // by which neighbours may differ to be compared
constexpr double kLeastEdges = 0.02;      // share of pixels in images whose sharpness can be compared
constexpr double kBlack = 16;             // grey level that 2 % of the pixels of an image exceed that shows nothing
constexpr double kBlackShare = 0.02;      // of images
constexpr double kBlurredShare = 0.1;     // of images
constexpr double kWeakEdges = 0.012;      // share of pixels
constexpr double kRepeatedShare = 0.02;   // of images
constexpr double kBrightnessStep = 0.12;  // log of the factor from one image to the next
constexpr double kStepShare = 0.03;       // of images
constexpr double kFast = 0.06;            // displacement between two images, in image widths

template <class Facts, class Value>
std::vector<double> values_of(const std::vector<Facts>& facts, const Value& value) {
  std::vector<double> values;
  for (const Facts& f : facts) values.push_back(value(f));
  return values;
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0;
  std::sort(values.begin(), values.end());
  return values[std::min(values.size() - 1, static_cast<std::size_t>(share * static_cast<double>(values.size())))];
}

template <class Value>
double median_frame(const ImageSurvey& survey, const Value& value) {
  return quantile(values_of(survey.frames, value), 0.5);
}

/// Frames that are much less sharp than those before and after them.
double blurred_share(const ImageSurvey& survey) {
  const auto& frames = survey.frames;
  // With few edges their number is that of the noise.
  const double usual = median_frame(survey, [](const FrameFacts& f) { return f.edge_share; });
  if (frames.size() < 8 || usual < kLeastEdges) return 0;
  int blurred = 0;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::size_t from = i < 4 ? 0 : i - 4, to = std::min(frames.size(), i + 5);
    double sharpest = 0;
    for (std::size_t k = from; k < to; ++k) {
      const bool is_near = std::abs(frames[k].index - frames[i].index) <= 4;
      if (is_near && std::abs(frames[k].mean - frames[i].mean) < kSameLight * frames[i].mean)
        sharpest = std::max(sharpest, frames[k].edge_share);
    }
    if (frames[i].edge_share < kBlurred * sharpest) ++blurred;
  }
  return blurred / static_cast<double>(frames.size());
}

/// Of the pairs that are the same image while the camera moves.
double repeated_share(const ImageSurvey& survey) {
  int repeated = 0, standing = 0;
  for (const PairFacts& pair : survey.pairs) {
    repeated += pair.is_repeated ? 1 : 0;
    standing += !pair.is_repeated && pair.flow < 1e-3 ? 1 : 0;
  }
  const auto n = static_cast<double>(survey.pairs.size());
  if (n < 10 || repeated + standing > 0.7 * n) return 0;
  return repeated / n;
}

/// Of the images that are brighter or darker than both the one before and the one after: automatic exposure goes one
/// way.
double step_share(const ImageSurvey& survey) {
  const std::vector<PairFacts>& pairs = survey.pairs;
  int steps = 0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const double before = pairs[i - 1].brightness_step, after = pairs[i].brightness_step;
    const bool is_row = pairs[i].index == pairs[i - 1].index + 1;
    if (is_row && before * after < 0 && std::min(std::abs(before), std::abs(after)) > kBrightnessStep) ++steps;
  }
  return pairs.empty() ? 0 : steps / static_cast<double>(pairs.size());
}

double black_share(const ImageSurvey& survey) {
  const auto black = std::count_if(survey.frames.begin(), survey.frames.end(),
                                   [](const FrameFacts& f) { return f.bright_level < kBlack; });
  return survey.frames.empty() ? 0 : static_cast<double>(black) / static_cast<double>(survey.frames.size());
}

double fast_flow(const ImageSurvey& survey) {
  std::vector<double> flows;
  for (const PairFacts& pair : survey.pairs) {
    if (pair.tracked_share > 0.2) flows.push_back(pair.flow);
  }
  return quantile(std::move(flows), 0.9);
}

void add(Findings& findings, bool holds, Finding finding) {
  if (holds) findings.push_back(std::move(finding));
}

void add_light(const ImageSurvey& survey, Findings& findings) {
  const double bright = median_frame(survey, [](const FrameFacts& f) { return f.bright_level; });
  const double contrast = median_frame(survey, [](const FrameFacts& f) { return f.bright_level - f.dark_level; });
  const double white = median_frame(survey, [](const FrameFacts& f) { return f.white_share; });
  const double levels = median_frame(survey, [](const FrameFacts& f) { return f.levels_share; });
  add(findings, bright < kDark,
      {"images.dark", Severity::kWarning, 55,
       format_text("the images are dark: 98 %% of the pixels are below grey level %.0f of 255", bright),
       "more light, or a longer exposure if the camera moves slowly; of images of more than 8 bits give those, not a "
       "copy of 8 bits"});
  add(findings, bright >= kDark && black_share(survey) > kBlackShare,
      {"images.black", Severity::kWarning, 48,
       format_text("%.0f %% of the images are black", 100 * black_share(survey)),
       "leave them out (--start, --end): nothing can be tracked there"});
  add(findings, white > kWhiteShare,
      {"images.overexposed", Severity::kWarning, 50, format_text("%.0f %% of the pixels are white", 100 * white),
       "a shorter exposure: white pixels carry nothing"});
  add(findings, contrast < kLowContrast && bright >= kDark,
      {"images.contrast", Severity::kWarning, 45,
       format_text("there is little contrast: from dark to bright only %.0f grey levels", contrast),
       "clean the lens, avoid light that shines into it; give images of more than 8 bits if there are"});
  add(findings, levels < kLevelsShare && contrast >= 20,
      {"images.levels", Severity::kWarning, 40,
       format_text("only %.0f %% of the grey levels between dark and bright occur: the images have fewer bits than "
                   "their files",
                   100 * levels),
       "do not stretch dark images afterwards; export them with all bits that the camera has (16-bit PNG)"});
  add(findings, step_share(survey) > kStepShare,
      {"images.brightness", Severity::kWarning, 35,
       format_text("the brightness jumps from image to image (%.0f %% of them)", 100 * step_share(survey)),
       "fix the exposure; under lamps choose one that is a multiple of their period (20 or 16.7 ms)"});
}

void add_sharpness(const ImageSurvey& survey, Findings& findings) {
  const double soft = median_frame(survey, [](const FrameFacts& f) { return f.softness; });
  const double edges = median_frame(survey, [](const FrameFacts& f) { return f.edge_share; });
  const double blurred = blurred_share(survey);
  add(findings, soft > kSoft,
      {"images.soft", Severity::kWarning, 55,
       format_text("all images are soft: edges that are %.1f times as steep at a quarter of the size", soft),
       "focus the lens and fix the focus; if the images were enlarged, give them as they were"});
  add(findings, blurred > kBlurredShare,
      {"images.blurred", Severity::kWarning, 45,
       format_text("%.0f %% of the images are blurred beside their neighbours", 100 * blurred),
       "a shorter exposure with more light, calmer motion"});
  add(findings, edges < kWeakEdges,
      {"images.texture", Severity::kWarning, 40,
       format_text("there is little to see: %.2f %% of the pixels have an edge", 100 * edges),
       "show things with texture and light them; bare walls cannot be tracked"});
}

void add_pairs(const ImageSurvey& survey, Findings& findings) {
  const double repeated = repeated_share(survey), fast = fast_flow(survey);
  add(findings, repeated > kRepeatedShare,
      {"images.repeated", Severity::kWarning, 42,
       format_text("%.0f %% of the images are the same as the one before", 100 * repeated),
       "record at the rate of the camera; a video that was converted to another rate should be given as it was"});
  add(findings, fast > kFast,
      {"motion.fast", Severity::kWarning, 58,
       format_text("the image moves fast: in a tenth of the steps by more than %.0f %% of its width", 100 * fast),
       "turn more slowly, or record more frames a second"});
}

std::string describe(const std::vector<StillRegion>& regions) {
  std::string text;
  for (std::size_t i = 0; i < std::min<std::size_t>(regions.size(), 4); ++i) {
    const StillRegion& r = regions[i];
    text += format_text("%s%dx%d at (%d, %d)", i == 0 ? "" : ", ", r.width, r.height, r.left, r.top);
  }
  return text + (regions.size() > 4 ? format_text(" and %zu more", regions.size() - 4) : "");
}

void add_still(const ImageSurvey& survey, Findings& findings) {
  const DarkBorder border = find_dark_border(survey.still.brightest().view());
  add(findings, border.kind == DarkBorderKind::kBars,
      {"images.bars", Severity::kNote, 20, format_text("black bars fill %.0f %% of the image", 100 * border.share),
       "nothing: they are masked by themselves. The calibration has to be that of the images with their bars"});
  add(findings, border.kind == DarkBorderKind::kRound,
      {"images.round", Severity::kNote, 20,
       format_text("the image is round: %.0f %% of the pixels show nothing", 100 * border.share),
       "nothing: they are masked by themselves"});
  const std::vector<StillRegion> regions = still_regions(survey.still.still_edges(), border.mask);
  add(findings, !regions.empty(),
      {"images.overlay", Severity::kWarning, 65,
       "something stays where it is while the image moves (text, a logo, a part of the vehicle): " + describe(regions),
       "mask it: `ldso doctor SEQUENCE -o DIR` writes DIR/mask.png, a first one for `ldso run --mask`"});
}

}  // namespace

Findings image_findings(const ImageSurvey& survey, int size) {
  Findings findings;
  add(findings, survey.unreadable > 0,
      {"images.unreadable", Severity::kWarning, 70,
       format_text("%d of %zu images that were looked at (of %d) cannot be used; the first: ", survey.unreadable,
                   survey.frames.size() + static_cast<std::size_t>(survey.unreadable), size) +
           survey.first_problem,
       "copy the sequence again"});
  add(findings, std::min(survey.width, survey.height) < kSmallSide,
      {"images.small", Severity::kWarning, 40,
       format_text("the images have only %dx%d pixels", survey.width, survey.height),
       "record with 640x480 pixels or more"});
  if (survey.frames.empty()) return findings;
  add_light(survey, findings);
  add_sharpness(survey, findings);
  add_pairs(survey, findings);
  add_still(survey, findings);
  return findings;
}

std::vector<std::pair<std::string, double>> image_figures(const ImageSurvey& survey) {
  return {{"frames_looked_at", static_cast<double>(survey.frames.size())},
          {"bright_level", median_frame(survey, [](const FrameFacts& f) { return f.bright_level; })},
          {"dark_level", median_frame(survey, [](const FrameFacts& f) { return f.dark_level; })},
          {"white_share", median_frame(survey, [](const FrameFacts& f) { return f.white_share; })},
          {"levels_share", median_frame(survey, [](const FrameFacts& f) { return f.levels_share; })},
          {"edge_share", median_frame(survey, [](const FrameFacts& f) { return f.edge_share; })},
          {"softness", median_frame(survey, [](const FrameFacts& f) { return f.softness; })},
          {"blurred_share", blurred_share(survey)},
          {"black_share", black_share(survey)},
          {"repeated_share", repeated_share(survey)},
          {"brightness_step_share", step_share(survey)},
          {"fast_flow", fast_flow(survey)},
          {"scene_change", survey.still.change()}};
}

Image<std::uint8_t> proposed_mask(const ImageSurvey& survey) {
  if (survey.frames.empty()) return {};
  const DarkBorder border = find_dark_border(survey.still.brightest().view());
  const std::vector<StillRegion> regions = still_regions(survey.still.still_edges(), border.mask);
  if (border.mask.empty() && regions.empty()) return {};
  Image<std::uint8_t> mask = border.mask.empty() ? Image<std::uint8_t>(survey.width, survey.height, 0) : border.mask;
  for (const StillRegion& r : regions) {
    for (int y = r.top; y < r.top + r.height; ++y) std::fill_n(mask.row(y) + r.left, r.width, std::uint8_t{255});
  }
  return mask;
}

}  // namespace ldso
